#pragma once

#include "scene/scene.h"
#include "study/scene_trial.h"
#include "study/stability_verdict.h"

#include <mutex>
#include <vector>

namespace sandflow {

/// A slow, thin jet onto a rough floor 0.12 m below: as high a heap as so few grains can make, at
/// rest at the end.
Scene makeStudyPour(std::int64_t count, Mode mode);

/// The heap that a scene makes, over several pours that differ in the seed only.
struct HeapSample {
    TrialEnd end = TrialEnd::finished;
    std::string message;               ///< of a pour that was refused or broke
    std::vector<Check> checks;         ///< of what was watched, from the worst pour of each
    std::vector<double> profile;       ///< d, mean over the pours; annuli 1 d wide
    double apex = 0.0;                 ///< d, mean
};

/// Pours seeds 1 ... `pours`. A pour that is refused or breaks ends the sample.
HeapSample sampleHeap(Scene scene, int pours);

/// The truth that heaps of a scene are judged by: in dem, at a small step, of stiff grains. Made when
/// it is first asked for, once, whoever asks.
class HeapReference {
public:
    HeapReference(Scene scene, int pours) : scene_(std::move(scene)), pours_(pours) {}
    const HeapSample& get();

private:
    Scene scene_;
    int pours_;
    std::once_flag made_;
    HeapSample sample_;
};

/// Mean |dH| [d] of two profiles, weighted with area, where either is over 1.5 d.
double profileDifference(const std::vector<double>& a, const std::vector<double>& b);

/// Slope [degrees] of the cone with a heap's volume and mean height: an angle of repose that small
/// heaps have too, for it takes in all of the heap instead of a few annuli of its flank.
///
///   V = pi h^3 / (3 tan^2),  mean height = h / 4,  both of the profile [d]; 0 for no sand
double coneAngle(const std::vector<double>& profile);

/// Limits of a heap's shape: what the program promises of its heaps (mean |dH|), and the angle by
/// which solvers with the same friction differ.
inline constexpr double kShapeLimit = 0.5;   // d
inline constexpr double kReposeLimit = 2.0;  // degrees

/// The checks of a heap against another, and of everything that was watched.
std::vector<Check> checkHeap(const HeapSample& heap, const HeapSample& reference);

/// Judges a sample against its reference; refused and broken pours get their verdict from the
/// message.
void judgeHeap(const HeapSample& heap, const HeapSample& reference, Finding& finding);

/// The verdict of a trial that gave no sand. False if it gave some.
bool judgeEnd(TrialEnd end, const std::string& message, Finding& finding);

}  // namespace sandflow
