#pragma once

#include "dem/dem.h"
#include "scene/scene.h"

namespace sandflow {

/// When a grain counts as mechanically at rest, and when one that rests must be woken. A grain is
/// frozen because it is at rest, never because it is deep.
struct RestRules {
    double freezeDistance = 1.8e-3;  ///< m: freezeSpeed x freezeTime
    double freezeTime = 0.06;        ///< s
    double slowSpeed = 0.03;         ///< m/s, at the moment of freezing: what it has is lost
    double sleepSpeed = 0.0015;      ///< m/s, likewise of falling asleep in the flowing layer
    double cagedTime = 0.32;         ///< s
    int contacts = 3;                ///< partners that push, to be frozen after freezeTime
    double netForceShare = 0.5;      ///< |net force| < this x (weight + load)
    double wakeForceShare = 0.1;     ///< woken when the force on it changed by more than this share
    double wakeWeights = 0.5;        ///< ... plus this many of its own weights
    double impactShare = 3.0;        ///< an interface grain is struck loose by a single contact of
    double impactWeights = 500.0;    ///< this x the largest at rest + this many of its weights
};

RestRules makeRestRules(const SurfaceFlowSpec& spec);

/// Lets `interval` [s] pass for every mobile grain's rest clock. Speeds are judged from positions,
/// not velocities: a grain that rattles in its cage rests, one that creeps does not.
template <class Real>
void updateRestClocks(const RestRules& rules, double interval, Dem<Real>& dem);

/// Mobile grain k is held by its contacts and has not moved. Needs an observed step.
template <class Real>
bool isAtRest(const RestRules& rules, const Dem<Real>& dem, std::size_t k);

/// Takes the forces on newly frozen grains as their state of rest, after the lists were rebuilt.
/// Each also gets the single contact force that wakes it at once: little for a sleeper, the blow of
/// an impact for an interface grain, which otherwise only the bed's height sets free.
template <class Real>
void judgeNewlyFrozen(const RestRules& rules, Dem<Real>& dem);

/// Marks sleepers on which the sum of forces changed, or that were hit since the last rebuild.
template <class Real>
void markWoken(const RestRules& rules, Dem<Real>& dem);

}  // namespace sandflow
