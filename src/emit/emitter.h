#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace sandflow {

/// A grain about to enter the scene.
struct NewGrain {
    Vec3 position;                       ///< m
    Vec3 velocity = Vec3::Zero();        ///< m/s
    Vec3 spin = Vec3::Zero();            ///< rad/s
    double radius = 0.0;                 ///< m
    bool settled = false;                ///< true: part of a settled packing, may be buried at once
};

/// Source of grains. Random numbers depend on (scene seed, emitter index) and the order of the
/// grains only, never on threads or time steps.
class Emitter {
public:
    virtual ~Emitter() = default;

    /// When the next batch is due, s; infinity when finished.
    virtual double nextTime() const = 0;

    /// Appends the batch due at nextTime() and moves on. `now` >= nextTime() is when the solver
    /// takes it; positions are those at `now` (a jet layer that was due earlier has moved on).
    virtual void emit(double now, std::vector<NewGrain>& out) = 0;

    virtual std::int64_t emitted() const = 0;
    virtual std::int64_t planned() const = 0;

    /// Bytes that restore the emitter exactly (position in its plan, random state).
    virtual std::vector<std::uint8_t> saveState() const = 0;
    virtual void loadState(const std::vector<std::uint8_t>& bytes) = 0;
};

/// Throws InputError (naming scene file and emitter) when the emitter cannot work: a rate that does
/// not fit through the opening at that speed without overlap, a box too small for its count, ...
std::unique_ptr<Emitter> makeEmitter(const Scene& scene, std::size_t index);

/// When the last grain of the scene enters, s (blocked emission aside).
double lastEmissionTime(const Scene& scene);

/// Fastest speed at which any grain can hit something, m/s: energy from emission speed and height
/// above the lowest solid (or lowest emitter when there is none), over all emitters. The scene does
/// not know how far its meshes reach: meshBounds are boxes about them.
double fastestPossibleSpeed(const Scene& scene,
                            std::span<const Eigen::AlignedBox3d> meshBounds = {});

}  // namespace sandflow
