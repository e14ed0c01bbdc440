#pragma once

#include <optional>
#include <string>

#include "core/random.h"
#include "emit/emitter.h"
#include "emit/settled_packing.h"

namespace sandflow {

/// block, fill, pile and single: all grains enter at once, at `start`. Block and single grains fly
/// on until they are taken; fill and pile are at rest.
class BatchEmitter : public Emitter {
public:
    /// Throws InputError (naming scene and emitter) when the grains do not fit.
    BatchEmitter(const Scene& scene, std::size_t index);

    double nextTime() const override;
    void emit(double now, std::vector<NewGrain>& out) override;
    std::int64_t emitted() const override { return done_ ? planned() : 0; }

    /// For a fill without a count the packing is made on the first call (seconds per million
    /// grains), since only it knows. Not for several threads at once.
    std::int64_t planned() const override;

    std::vector<std::uint8_t> saveState() const override;
    void loadState(const std::vector<std::uint8_t>& bytes) override;

private:
    void checkBlock(const Scene& scene, std::size_t index) const;
    void checkFill(const Scene& scene, std::size_t index);
    void checkPile(const Scene& scene, std::size_t index);
    void pack() const;

    std::string label_;
    EmitterSpec spec_;
    GrainSpec grains_;
    Vec3 gravity_;
    std::uint64_t seed_;
    std::size_t index_;
    double floor_ = 0.0;  ///< fill, pile: where the sand rests, m
    bool done_ = false;
    mutable std::optional<std::int64_t> planned_;          ///< once known
    mutable std::optional<std::vector<NewGrain>> packed_;  ///< fill, pile: once made, until emitted
};

}  // namespace sandflow
