#pragma once

#include "study/scene_trial.h"
#include "study/stability_verdict.h"

#include <deque>

namespace sandflow {

/// Watches what must hold in every run, whatever its sand does, frame by frame: laws of nature and
/// the solids, nothing of the program's own past results.
///
///   finite     every position, velocity and spin is a number
///   speed      no grain is faster than its fall allows, v^2 <= v0^2 + 2 g H; where sizes differ, by
///              what a light grain gains in a blow of a heavy one
///   energy     motion + height + elastic overlap of grains never grows once all grains are in
///   solids     no grain inside or below one
///   ledger     no grain lost
///   overlap    none far deeper than contact.max_overlap, for which the stiffness was chosen
class SoundnessWatch {
public:
    explicit SoundnessWatch(const Scene& scene);

    /// Takes a look after a frame. To be called from a TrialWatcher.
    void look(const Simulation& sand, const FrameReport& report);

    /// The last snapshot looked at.
    const Snapshot& last() const { return now_; }

    /// Energy of motion per grain at the end, in m g d of a mean grain: the median of the last ten
    /// frames, of all but the one grain in a hundred that moves most: one that rolls by is no jitter.
    double energyAtRest() const;

    /// Mean weight of a grain times a mean diameter, J.
    double unitEnergy() const { return unitEnergy_; }

    /// The checks of everything watched.
    void addChecks(std::vector<Check>& checks) const;

    /// Sand at rest has less than this, in m g d per grain: a mean speed of 4 mm/s for 1 cm grains.
    static constexpr double kRestLimit = 1e-4;
    void addRestCheck(std::vector<Check>& checks) const;

private:
    double motionOfMost() const;
    void lookAtSpeeds(double gain);
    void lookAtEnergy(const Simulation& sand, const FrameReport& report);
    double heightEnergy(const Vec3& position) const { return -scene_.gravity.dot(position); }

    Scene scene_;
    double unitEnergy_ = 0.0;     ///< J
    double startingEnergy_ = 0.0; ///< J/kg, of the highest and fastest grain that comes in
    double lastEmission_ = 0.0;   ///< s
    Snapshot now_;

    double lowest_ = 0.0;       ///< J/kg, lowest height energy of any grain so far
    double fastestShare_ = 0.0; ///< speed over what the fall allows
    double leastEnergy_ = 0.0;  ///< J, since all grains are in
    double energyRise_ = 0.0;   ///< J, above that
    bool energyKnown_ = false;
    std::uint64_t notFinite_ = 0, inSolids_ = 0, lost_ = 0;
    double deepestOverlap_ = 0.0;  ///< in smallest radii
    std::deque<double> motion_;    ///< m g d per grain, of the last frames
};

}  // namespace sandflow
