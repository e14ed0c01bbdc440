#include "study/heap_sample.h"

#include "measure/heap.h"
#include "measure/radial_profile.h"
#include "study/soundness_watch.h"
#include "study/user_trial.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// Step over its bound, and stiffness over what auto chooses, of heaps that serve as the truth.
constexpr double kReferenceStep = 0.4;
constexpr double kReferenceStiffness = 4.0;

/// Keeps the larger error of each check; pours of one scene have the same checks.
void keepWorst(const std::vector<Check>& from, std::vector<Check>& worst)
{
    if (worst.empty()) {
        worst = from;
        return;
    }
    for (std::size_t k = 0; k < from.size(); ++k) {
        if (!(from[k].error <= worst[k].error)) {
            worst[k] = from[k];
        }
    }
}

}  // namespace

Scene makeStudyPour(std::int64_t count, Mode mode)
{
    Scene scene;
    scene.name = "study pour";
    scene.mode = mode;
    SolidSpec floor;
    floor.shape = SolidShape::plane;
    floor.name = "floor";
    floor.rough = true;
    scene.solids.push_back(floor);
    EmitterSpec jet;
    jet.kind = EmitterKind::jet;
    jet.name = "spout";
    jet.count = count;
    jet.rate = 500.0;
    jet.position = Vec3(0.0, 0.0, 0.12);
    jet.speed = 1.0;
    jet.radius = 0.03;
    scene.emitters.push_back(jet);
    return scene;
}

HeapSample sampleHeap(Scene scene, int pours)
{
    HeapSample sample;
    for (int pour = 1; pour <= pours; ++pour) {
        scene.seed = static_cast<std::uint64_t>(pour);
        SoundnessWatch watch(scene);
        const SceneTrial trial = runUserTrial(scene, [&](const Simulation& sand, const FrameReport& r) {
            watch.look(sand, r);
            return true;
        });
        sample.end = trial.end;
        sample.message = trial.message;
        if (!trial.gaveSand()) {
            return sample;
        }
        std::vector<Check> checks;
        watch.addChecks(checks);
        watch.addRestCheck(checks);
        keepWorst(checks, sample.checks);

        const HeapFigures heap = measureHeap(trial.last);
        const double share = 1.0 / pours;
        sample.profile.resize(std::max(sample.profile.size(), heap.profile.size()), 0.0);
        for (std::size_t k = 0; k < heap.profile.size(); ++k) {
            sample.profile[k] += share * heap.profile[k] / heap.diameter;
        }
        sample.apex += share * heap.apex / heap.diameter;
    }
    return sample;
}

const HeapSample& HeapReference::get()
{
    std::call_once(made_, [this] {
        try {
            scene_.mode = Mode::dem;
            scene_.time.stepSafety = kReferenceStep;
            scene_.contact.stiffness = kReferenceStiffness * planRun(scene_).law.stiffness;
            sample_ = sampleHeap(scene_, pours_);
        } catch (const InputError& error) {
            sample_.end = TrialEnd::refused;
            sample_.message = error.what();
        }
    });
    return sample_;
}

double profileDifference(const std::vector<double>& a, const std::vector<double>& b)
{
    constexpr double kComparedFrom = 1.5;  // d, as in measure/compare
    const auto at = [](const std::vector<double>& p, std::size_t k) {
        return k < p.size() ? p[k] : 0.0;
    };
    double sum = 0.0, area = 0.0;
    for (std::size_t k = 0; k < std::max(a.size(), b.size()); ++k) {
        if (std::max(at(a, k), at(b, k)) > kComparedFrom) {
            sum += annulusArea(k) * std::abs(at(a, k) - at(b, k));
            area += annulusArea(k);
        }
    }
    return area > 0.0 ? sum / area : 0.0;
}

double coneAngle(const std::vector<double>& profile)
{
    double volume = 0.0, moment = 0.0;
    for (std::size_t k = 0; k < profile.size(); ++k) {
        volume += annulusArea(k) * profile[k];
        moment += annulusArea(k) * 0.5 * profile[k] * profile[k];
    }
    if (!(volume > 0.0)) {
        return 0.0;
    }
    const double height = 4.0 * moment / volume;
    return std::atan(std::sqrt(kPi * height * height * height / (3.0 * volume))) * 180.0 / kPi;
}

std::vector<Check> checkHeap(const HeapSample& heap, const HeapSample& reference)
{
    std::vector<Check> checks = heap.checks;
    const double shape = profileDifference(heap.profile, reference.profile);
    checks.push_back({"mean |dH|", shape, kShapeLimit, "d", Verdict::wrongShape,
                      fmt::format("the heap differs from the reference by {:.2f} d on average; its "
                                  "apex is {:.1f} d, not {:.1f} d",
                                  shape, heap.apex, reference.apex)});
    const double angle = coneAngle(heap.profile), wanted = coneAngle(reference.profile);
    checks.push_back({"slope", std::abs(angle - wanted), kReposeLimit, "deg", Verdict::wrongShape,
                      fmt::format("it stands at {:.1f} degrees, not {:.1f}", angle, wanted)});
    return checks;
}

bool judgeEnd(TrialEnd end, const std::string& message, Finding& finding)
{
    if (end == TrialEnd::refused || end == TrialEnd::broke) {
        finding.verdict = end == TrialEnd::refused ? Verdict::refused : Verdict::broke;
        finding.cause = message;
        return true;
    }
    return false;
}

void judgeHeap(const HeapSample& heap, const HeapSample& reference, Finding& finding)
{
    if (!judgeEnd(reference.end, "the reference: " + reference.message, finding) &&
        !judgeEnd(heap.end, heap.message, finding)) {
        judge(checkHeap(heap, reference), finding);
    }
}

}  // namespace sandflow
