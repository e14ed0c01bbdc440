#pragma once

#include "scene/scene.h"

#include <cmath>
#include <random>

namespace sandflow {

/// Makes scenes in which every field that a shape or kind has takes random values within its range,
/// with all digits of a double.
class RandomScene {
public:
    explicit RandomScene(std::uint64_t seed) : bits_(seed) {}

    Scene make()
    {
        Scene scene;
        scene.name = text();
        scene.mode = chance() ? Mode::dem : Mode::surfaceFlow;
        scene.precision = chance() ? Precision::real64 : Precision::single;
        scene.seed = bits_() >> 1;
        scene.gravity = Vec3(number(-9, 9), number(-9, 9), number(-900, -1));
        if (chance()) {
            scene.domain = {vector(-9, -1), vector(1, 9)};
        }
        scene.grains = {number(1e-4, 0.1), number(0, 0.6), number(1, 1e4)};
        fillContact(scene.contact);
        scene.time = {number(1, 1e3), number(0, 1e3), maybe(1, 99), maybe(1e-9, 0.1), number(0, 1)};
        fillFlow(scene.surfaceFlow);
        scene.skip.sleep = chance();
        scene.camera.angle = number(1, 170);
        if (chance()) {
            scene.camera.position = vector(-9, 9);
        }
        if (chance()) {
            scene.camera.lookAt = vector(-9, 9);
        }
        for (int shape = 0; shape < 5; ++shape) {
            scene.solids.push_back(makeSolid(static_cast<SolidShape>(shape)));
        }
        for (int kind = 0; kind < 6; ++kind) {
            scene.emitters.push_back(
                makeEmitterSpec(static_cast<EmitterKind>(kind), scene.grains.radius));
        }
        return scene;
    }

private:
    bool chance() { return (bits_() >> 40) % 2 == 0; }

    /// In (low, high], uniform, all 53 bits.
    double number(double low, double high)
    {
        const double share = static_cast<double>((bits_() >> 11) + 1) * 0x1p-53;
        return std::min(high, low + (high - low) * share);
    }

    std::optional<double> maybe(double low, double high)
    {
        return chance() ? std::optional(number(low, high)) : std::nullopt;
    }

    Vec3 vector(double low, double high)
    {
        return {number(low, high), number(low, high), chance() ? number(low, high) : low};
    }

    Vec3 direction() { return vector(-1, 1).normalized(); }

    std::string text()
    {
        static const std::string pieces[] = {"a",      "Z", "\"", "\\", " ",
                                             "\u00e9", "#", "=",  "'",  "\u7802"};
        std::string made;
        while (chance()) {
            made += pieces[(bits_() >> 20) % std::size(pieces)];
        }
        return made;
    }

    void fillContact(ContactSpec& contact)
    {
        contact.law = static_cast<NormalLaw>((bits_() >> 20) % 3);
        contact.restitution = number(0, 1);
        contact.clipAttraction = chance();
        contact.friction = number(0, 10);
        contact.rollingFriction = number(0, 10);
        contact.tangentialRatio = number(0, 1);
        contact.tangentialDamping = number(0, 1);
        (contact.law == NormalLaw::linear ? contact.stiffness : contact.youngModulus) =
            maybe(1, 1e9);
        contact.poissonRatio = number(0, 0.5);
        contact.maxOverlap = number(0, 0.5);
    }

    void fillFlow(SurfaceFlowSpec& flow)
    {
        flow.interval = number(0, 1);
        flow.cellSize = number(1, 20);
        flow.exchangeRate = number(0, 1e5);
        flow.reposeAngle = maybe(0, 44);
        flow.reposeMargin = maybe(0, 45);
        flow.slopeForm = chance() ? SlopeForm::tangent : SlopeForm::angle;
        flow.saturationDepth = maybe(0.1, 9);
        flow.minFlowDepth = number(0, 9);
        flow.interfaceThickness = number(1, 9);
        flow.smoothing = number(0, 1);
        flow.maxChange = number(0, 9);
        flow.transport = chance();
        flow.transportSpeed = number(0, 9);
        flow.freezeSpeed = number(0, 1);
        flow.freezeTime = number(0, 9);
        flow.cagedTime = number(0, 9);
        flow.buryClearance = number(0, 9);
        flow.creepDecay = number(0, 9);
        flow.creepDepth = number(0, 9);
        flow.settleDepth = number(0, 20);
        flow.freezeOnSmooth = chance();
    }

    SolidSpec makeSolid(SolidShape shape)
    {
        SolidSpec solid;
        solid.shape = shape;
        solid.name = text();
        solid.from = number(0, 5);
        solid.until = chance() ? number(5, 9) : 1e30;
        solid.look = chance() ? "glass" : "none";
        solid.rough = shape == SolidShape::plane && chance();
        if (shape == SolidShape::box) {
            solid.min = vector(-9, 0);
            solid.max = vector(0.1, 9);
        } else if (shape == SolidShape::mesh) {
            solid.mesh = text() + ".obj";
            solid.standIn = text();
            solid.up = chance() ? UpAxis::y : UpAxis::z;
            solid.fitHeight = maybe(0.1, 9);
            if (!solid.fitHeight) {
                solid.fitLength = maybe(0.1, 9);
            }
            if (!solid.fitHeight && !solid.fitLength) {
                solid.scale = number(0, 9);
            }
            solid.turn = number(-360, 360);
            solid.stand = chance();
            solid.point = vector(-9, 9);
        } else {
            solid.point = vector(-9, 9);
            solid.normal = direction();
        }
        if (shape == SolidShape::cylinder || shape == SolidShape::disc) {
            solid.radius = number(0, 9);
        }
        if (shape == SolidShape::cylinder) {
            solid.height = number(0, 9);
        }
        if (shape == SolidShape::box || shape == SolidShape::cylinder) {
            solid.hollow = chance();
            solid.floor = solid.hollow && chance();
        }
        return solid;
    }

    EmitterSpec makeEmitterSpec(EmitterKind kind, double grainRadius)
    {
        EmitterSpec emitter;
        emitter.kind = kind;
        emitter.name = text();
        emitter.start = number(0, 9);
        const bool opening = kind == EmitterKind::jet || kind == EmitterKind::slot;
        const bool box = kind == EmitterKind::block || kind == EmitterKind::fill;
        if (kind != EmitterKind::single) {
            emitter.count = 1 + static_cast<std::int64_t>(bits_() % 500'000'000);
        }
        if (opening) {
            emitter.rate = number(0, 1e6);
            emitter.direction = direction();
            emitter.speed = number(0, 99);
        }
        if (kind == EmitterKind::jet) {
            emitter.radius = number(0, 9);
        }
        if (kind == EmitterKind::slot) {
            emitter.size = {number(0, 9), number(0, 9)};
        }
        if (box) {
            emitter.min = vector(-9, 0);
            emitter.max = vector(0.1, 9);
        } else {
            emitter.position = vector(-9, 9);
        }
        if (kind == EmitterKind::block || kind == EmitterKind::single) {
            emitter.velocity = vector(-99, 99);
        }
        if (kind == EmitterKind::single) {
            emitter.spin = vector(-99, 99);
            emitter.grainRadius = maybe(grainRadius * 0.9, grainRadius * 1.1);
        }
        if (kind == EmitterKind::pile) {
            emitter.slopeAngle = number(0, 89);
        }
        return emitter;
    }

    std::mt19937_64 bits_;
};

}  // namespace sandflow
