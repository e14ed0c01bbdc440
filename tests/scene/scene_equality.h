#pragma once

#include "scene_support.h"

namespace sandflow {

/// Written field by field on its own, so that a field the reader and the writer both forget shows.
inline void expectSameBits(const Vec3& a, const Vec3& b)
{
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(bitsOf(a[i]), bitsOf(b[i])) << a.transpose() << " against " << b.transpose();
    }
}

inline void expectSameBits(double a, double b)
{
    EXPECT_EQ(bitsOf(a), bitsOf(b)) << a << " against " << b;
}

template <class Value>
void expectSameBits(const std::optional<Value>& a, const std::optional<Value>& b)
{
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
        expectSameBits(*a, *b);
    }
}

inline void expectSame(const ContactSpec& a, const ContactSpec& b)
{
    EXPECT_EQ(a.law, b.law);
    expectSameBits(a.restitution, b.restitution);
    EXPECT_EQ(a.clipAttraction, b.clipAttraction);
    expectSameBits(a.friction, b.friction);
    expectSameBits(a.rollingFriction, b.rollingFriction);
    expectSameBits(a.tangentialRatio, b.tangentialRatio);
    expectSameBits(a.tangentialDamping, b.tangentialDamping);
    expectSameBits(a.stiffness, b.stiffness);
    expectSameBits(a.youngModulus, b.youngModulus);
    expectSameBits(a.poissonRatio, b.poissonRatio);
    expectSameBits(a.maxOverlap, b.maxOverlap);
}

inline void expectSame(const SurfaceFlowSpec& a, const SurfaceFlowSpec& b)
{
    expectSameBits(a.interval, b.interval);
    expectSameBits(a.cellSize, b.cellSize);
    expectSameBits(a.exchangeRate, b.exchangeRate);
    expectSameBits(a.reposeAngle, b.reposeAngle);
    expectSameBits(a.reposeMargin, b.reposeMargin);
    EXPECT_EQ(a.slopeForm, b.slopeForm);
    expectSameBits(a.saturationDepth, b.saturationDepth);
    expectSameBits(a.minFlowDepth, b.minFlowDepth);
    expectSameBits(a.interfaceThickness, b.interfaceThickness);
    expectSameBits(a.smoothing, b.smoothing);
    expectSameBits(a.maxChange, b.maxChange);
    EXPECT_EQ(a.transport, b.transport);
    expectSameBits(a.transportSpeed, b.transportSpeed);
    expectSameBits(a.freezeSpeed, b.freezeSpeed);
    expectSameBits(a.freezeTime, b.freezeTime);
    expectSameBits(a.cagedTime, b.cagedTime);
    expectSameBits(a.buryClearance, b.buryClearance);
    expectSameBits(a.creepDecay, b.creepDecay);
    expectSameBits(a.creepDepth, b.creepDepth);
    expectSameBits(a.settleDepth, b.settleDepth);
    EXPECT_EQ(a.freezeOnSmooth, b.freezeOnSmooth);
}

inline void expectSame(const SolidSpec& a, const SolidSpec& b)
{
    EXPECT_EQ(a.shape, b.shape);
    EXPECT_EQ(a.name, b.name);
    expectSameBits(a.from, b.from);
    expectSameBits(a.until, b.until);
    EXPECT_EQ(a.rough, b.rough);
    expectSameBits(a.point, b.point);
    expectSameBits(a.normal, b.normal);
    expectSameBits(a.min, b.min);
    expectSameBits(a.max, b.max);
    EXPECT_EQ(a.hollow, b.hollow);
    EXPECT_EQ(a.floor, b.floor);
    expectSameBits(a.radius, b.radius);
    expectSameBits(a.height, b.height);
    EXPECT_EQ(a.mesh, b.mesh);
    EXPECT_EQ(a.standIn, b.standIn);
    EXPECT_EQ(a.up, b.up);
    expectSameBits(a.scale, b.scale);
    expectSameBits(a.fitHeight, b.fitHeight);
    expectSameBits(a.fitLength, b.fitLength);
    expectSameBits(a.turn, b.turn);
    EXPECT_EQ(a.stand, b.stand);
    EXPECT_EQ(a.look, b.look);
}

inline void expectSame(const EmitterSpec& a, const EmitterSpec& b)
{
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.name, b.name);
    expectSameBits(a.start, b.start);
    EXPECT_EQ(a.count, b.count);
    expectSameBits(a.rate, b.rate);
    expectSameBits(a.position, b.position);
    expectSameBits(a.direction, b.direction);
    expectSameBits(a.speed, b.speed);
    expectSameBits(a.radius, b.radius);
    expectSameBits(a.size[0], b.size[0]);
    expectSameBits(a.size[1], b.size[1]);
    expectSameBits(a.min, b.min);
    expectSameBits(a.max, b.max);
    expectSameBits(a.velocity, b.velocity);
    expectSameBits(a.spin, b.spin);
    expectSameBits(a.slopeAngle, b.slopeAngle);
    expectSameBits(a.grainRadius, b.grainRadius);
}

/// Everything but where the scene was read.
inline void expectSame(const Scene& a, const Scene& b)
{
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.mode, b.mode);
    EXPECT_EQ(a.precision, b.precision);
    EXPECT_EQ(a.seed, b.seed);
    expectSameBits(a.gravity, b.gravity);
    expectSameBits(a.domain.min, b.domain.min);
    expectSameBits(a.domain.max, b.domain.max);
    expectSameBits(a.grains.radius, b.grains.radius);
    expectSameBits(a.grains.sizeSpread, b.grains.sizeSpread);
    expectSameBits(a.grains.density, b.grains.density);
    expectSame(a.contact, b.contact);
    expectSameBits(a.time.framesPerSecond, b.time.framesPerSecond);
    expectSameBits(a.time.settle, b.time.settle);
    expectSameBits(a.time.duration, b.time.duration);
    expectSameBits(a.time.step, b.time.step);
    expectSameBits(a.time.stepSafety, b.time.stepSafety);
    expectSame(a.surfaceFlow, b.surfaceFlow);
    EXPECT_EQ(a.skip.sleep, b.skip.sleep);
    expectSameBits(a.camera.position, b.camera.position);
    expectSameBits(a.camera.lookAt, b.camera.lookAt);
    expectSameBits(a.camera.angle, b.camera.angle);
    ASSERT_EQ(a.solids.size(), b.solids.size());
    for (std::size_t i = 0; i < a.solids.size(); ++i) {
        SCOPED_TRACE("solid " + std::to_string(i));
        expectSame(a.solids[i], b.solids[i]);
    }
    ASSERT_EQ(a.emitters.size(), b.emitters.size());
    for (std::size_t i = 0; i < a.emitters.size(); ++i) {
        SCOPED_TRACE("emitter " + std::to_string(i));
        expectSame(a.emitters[i], b.emitters[i]);
    }
}

}  // namespace sandflow
