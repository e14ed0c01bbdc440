#pragma once

#include <string>

#include "core/random.h"
#include "emit/emitter.h"
#include "emit/layer.h"
#include "emit/layer_clock.h"

namespace sandflow {

/// jet and slot: grains leave a flat opening in layers, each laid out by random sequential
/// addition, and fly on freely until the solver takes them.
class JetEmitter : public Emitter {
public:
    /// Throws InputError (naming scene and emitter) when the opening is smaller than a grain or the
    /// rate does not fit through it.
    JetEmitter(const Scene& scene, std::size_t index);

    double nextTime() const override;
    void emit(double now, std::vector<NewGrain>& out) override;
    std::int64_t emitted() const override { return emitted_; }
    std::int64_t planned() const override { return clock_.count; }
    std::vector<std::uint8_t> saveState() const override;
    void loadState(const std::vector<std::uint8_t>& bytes) override;

private:
    std::string label_;  ///< scene file and emitter, for messages
    GrainSpec grains_;
    LayerClock clock_;
    Opening opening_;
    Vec3 centre_;                  ///< m
    Vec3 widthAxis_, heightAxis_;  ///< of the opening's plane, unit
    Vec3 velocity_;                ///< m/s, at the opening
    Vec3 gravity_;                 ///< m/s2
    Random sizes_, places_;
    std::int64_t emitted_ = 0;
};

}  // namespace sandflow
