#include "study/heap_sample.h"
#include "study/stability_cases.h"

#include <memory>
#include <optional>

namespace sandflow {
namespace {

using Change = std::function<void(Scene&, double)>;

/// Heaps of one scene over one parameter. `onReference`: the parameter is physics, so the reference
/// has it as well; else it is numerics, and one reference serves all.
struct PourFamily {
    std::string name, parameter;
    std::vector<double> values;
    Change change;
    bool onReference = false;
    std::vector<Mode> modes{Mode::dem, Mode::surfaceFlow};
    std::string more = {};  ///< told beside the mode
};

/// The stiffness that auto chooses.
double autoStiffness(const Scene& scene)
{
    return planRun(scene).law.stiffness;
}

class PourCases {
public:
    PourCases(Scene pour, int pours, std::vector<StabilityCase>& cases)
        : pour_(std::move(pour)), pours_(pours), base_(reference(pour_)), cases_(cases)
    {
    }

    void add(const PourFamily& family)
    {
        for (const double value : family.values) {
            Scene plain = pour_;
            std::shared_ptr<HeapReference> truth = base_;
            if (family.onReference) {
                family.change(plain, value);
                truth = reference(plain);
            }
            for (const Mode mode : family.modes) {
                Scene scene = pour_;
                scene.mode = mode;
                family.change(scene, value);
                cases_.push_back(makeCase(
                    family.name, family.parameter, value, labelOf(mode) + family.more,
                    [scene, truth, pours = pours_](Finding& finding) {
                        judgeHeap(sampleHeap(scene, pours), truth->get(), finding);
                    }));
            }
        }
    }

private:
    std::shared_ptr<HeapReference> reference(const Scene& scene) const
    {
        return std::make_shared<HeapReference>(scene, pours_);
    }

    Scene pour_;
    int pours_;
    std::shared_ptr<HeapReference> base_;
    std::vector<StabilityCase>& cases_;
};

/// A step given in seconds.
void setStep(Scene& scene, double share)
{
    scene.time.step = share * planRun(scene).step.bound;
}

/// A heap of thousands in the time of one of hundreds.
Scene makeLargePour(std::int64_t count)
{
    Scene scene = makeStudyPour(count, Mode::dem);
    EmitterSpec& jet = scene.emitters[0];
    jet.rate = 2500.0;
    jet.radius = 0.05;
    jet.speed = 1.5;
    jet.position.z() = 0.2;
    return scene;
}

/// Settled sand put in as a cone instead of the pour.
void startAsPile(Scene& scene, double slope)
{
    EmitterSpec pile;
    pile.kind = EmitterKind::pile;
    pile.name = "pile";
    pile.count = scene.emitters[0].count;
    pile.slopeAngle = slope;
    scene.emitters = {pile};
    scene.time.duration = 1.5;
}

}  // namespace

void addPourCases(StudySize size, std::vector<StabilityCase>& cases)
{
    const bool quick = size == StudySize::quick;
    const auto pick = [quick](std::vector<double> few, std::vector<double> all) {
        return quick ? few : all;
    };
    // Slopes of such small heaps scatter by a degree or two from pour to pour: means are compared.
    PourCases pours(makeStudyPour(500, Mode::dem), quick ? 2 : 3, cases);

    pours.add({"time step", "step / bound", pick({0.2, 1.0, 1.05}, {0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0, 1.05, 2.0}),
               setStep});
    const auto withLaw = [](NormalLaw law) {
        return [law](Scene& scene, double share) {
            scene.contact.law = law;
            scene.time.stepSafety = share;
        };
    };
    if (!quick) {
        pours.add({"time step", "step / bound", {0.4, 1.0}, withLaw(NormalLaw::hertz), false,
                   {Mode::dem, Mode::surfaceFlow}, ", Hertz"});
        pours.add({"time step", "step / bound", {0.4, 1.0}, withLaw(NormalLaw::bellYuMucha), false,
                   {Mode::dem, Mode::surfaceFlow}, ", Bell-Yu-Mucha"});
    }

    pours.add({"stiffness", "k / auto", pick({1.0, 10.0}, {0.15, 0.9, 1.0, 10.0, 100.0, 1000.0}),
               [](Scene& scene, double factor) {
                   if (factor < 0.5) {  // softer than auto only where the scene allows it
                       scene.contact.maxOverlap = 0.8;
                   }
                   scene.contact.stiffness = factor * autoStiffness(makeStudyPour(
                                                          scene.emitters[0].count, scene.mode));
               }});

    pours.add({"size ratio", "largest / smallest", pick({1.0, 5.0}, {1.0, 2.0, 3.0, 5.0, 6.0}),
               [](Scene& scene, double ratio) {
                   scene.grains.sizeSpread = (ratio - 1.0) / (ratio + 1.0);
               },
               true});
    pours.add({"friction", "mu", pick({0.0, 2.0}, {0.0, 0.1, 0.3, 0.5, 1.0, 2.0}),
               [](Scene& scene, double mu) {
                   scene.contact.friction = mu;
                   scene.contact.rollingFriction = mu == 0.0 ? 0.0 : 0.1;
               },
               true});
    pours.add({"restitution, heap", "e", pick({0.01, 0.9}, {0.01, 0.1, 0.3, 0.6, 0.9}),
               [](Scene& scene, double e) {
                   scene.contact.restitution = e;
                   scene.time.settle = e > 0.5 ? 4.0 : 1.0;  // what bounces rests later
               },
               true});
    pours.add({"start slope", "degrees", pick({20.0}, {10.0, 20.0, 25.0, 30.0, 35.0, 45.0}),
               startAsPile, true});

    // In heaps of a few hundred grains the height field has no say: all is within its flowing layer.
    PourCases large(makeLargePour(quick ? 1500 : 4000), 1, cases);
    large.add({"theta0", "degrees", pick({60.0}, {5.0, 15.0, 25.0, 30.0, 36.0, 45.0, 60.0}),
               [](Scene& scene, double degrees) { scene.surfaceFlow.reposeAngle = degrees; }, false,
               {Mode::surfaceFlow}});
}

}  // namespace sandflow
