#include "dem/restitution.h"

#include "core/errors.h"
#include "core/find_root.h"
#include "core/quiet_gsl.h"

#include <gsl/gsl_odeiv2.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace sandflow {

namespace {

constexpr double kStepTolerance = 1e-12;
constexpr double kCreep = 1e-9;  ///< in L and V: a pair this close and slow never rebounds
constexpr int kMaxSteps = 200000;

/// Right-hand side of the collision, y = {x, x'}.
struct Motion {
    NormalLaw law;
    double damping;

    /// Force out of the contact, unclipped. Continued oddly to x < 0 so that trial steps across
    /// the end of contact stay smooth.
    double force(double x, double speed) const
    {
        const double root = std::sqrt(std::abs(x));
        switch (law) {
        case NormalLaw::linear:
            return x + 2.0 * damping * speed;
        case NormalLaw::hertz:
            return x * root + damping * std::sqrt(1.5 * root) * speed;
        case NormalLaw::bellYuMucha:
            return x * root + damping * root * speed;
        }
        return 0.0;
    }
};

using State = std::array<double, 2>;

/// An rk8pd integrator of one Motion.
class Stepper {
public:
    explicit Stepper(const Motion& motion)
        : motion_(motion),
          step_(gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, 2), &gsl_odeiv2_step_free),
          control_(gsl_odeiv2_control_y_new(kStepTolerance, kStepTolerance),
                   &gsl_odeiv2_control_free),
          evolve_(gsl_odeiv2_evolve_alloc(2), &gsl_odeiv2_evolve_free)
    {
        SAND_CHECK(step_ && control_ && evolve_, "no memory for an integrator");
        system_.function = [](double, const double y[], double dydt[], void* context) {
            dydt[0] = y[1];
            dydt[1] = -static_cast<const Motion*>(context)->force(y[0], y[1]);
            return static_cast<int>(GSL_SUCCESS);
        };
        system_.jacobian = nullptr;
        system_.dimension = 2;
        system_.params = &motion_;
    }
    Stepper(const Stepper&) = delete;
    Stepper& operator=(const Stepper&) = delete;

    /// One step of the size that meets the tolerance; returns it.
    double advance(State& y)
    {
        double t = 0.0;
        const int status = gsl_odeiv2_evolve_apply(evolve_.get(), control_.get(), step_.get(),
                                                   &system_, &t, 1e6, &trial_, y.data());
        SAND_CHECK(status == GSL_SUCCESS, "collision not integrated: {}", gsl_strerror(status));
        return t;
    }

    /// y a time h on, in one step.
    State leap(const State& from, double h)
    {
        State y = from;
        State error{};
        gsl_odeiv2_step_reset(step_.get());
        const int status = gsl_odeiv2_step_apply(step_.get(), 0.0, h, y.data(), error.data(),
                                                 nullptr, nullptr, &system_);
        SAND_CHECK(status == GSL_SUCCESS, "collision not integrated: {}", gsl_strerror(status));
        return y;
    }

private:
    Motion motion_;
    gsl_odeiv2_system system_{};
    std::unique_ptr<gsl_odeiv2_step, decltype(&gsl_odeiv2_step_free)> step_;
    std::unique_ptr<gsl_odeiv2_control, decltype(&gsl_odeiv2_control_free)> control_;
    std::unique_ptr<gsl_odeiv2_evolve, decltype(&gsl_odeiv2_evolve_free)> evolve_;
    double trial_ = 1e-6;
};

}  // namespace

Collision integrateCollision(NormalLaw law, bool clipAttraction, double damping)
{
    SAND_CHECK(damping >= 0.0 && std::isfinite(damping), "damping {}", damping);
    const QuietGsl quiet;
    const Motion motion{law, damping};
    Stepper stepper(motion);

    Collision collision;
    State y{0.0, 1.0};
    double time = 0.0;
    // What is left of the contact: its overlap, or its force where attraction is clipped. A clipped
    // contact whose force is spent stays spent: going out, the spring weakens before the dashpot.
    const auto left = [&](const State& at) {
        return clipAttraction ? motion.force(at[0], at[1]) : at[0];
    };
    for (int i = 0; i < kMaxSteps; ++i) {
        const State before = y;
        const double h = stepper.advance(y);
        if (before[1] > 0.0 && y[1] <= 0.0) {
            const double turn = findRoot([&](double s) { return stepper.leap(before, s)[1]; },
                                         0.0, h * 1.000001);
            collision.peakOverlap = stepper.leap(before, turn)[0];
        }
        if (y[1] < 0.0 && left(y) <= 0.0) {
            const double end = findRoot([&](double s) { return left(stepper.leap(before, s)); },
                                        0.0, h * 1.000001);
            const State out = stepper.leap(before, end);
            collision.restitution = -out[1];
            collision.duration = time + end;
            return collision;
        }
        time += h;
        if (y[0] < kCreep && y[1] < 0.0 && y[1] > -kCreep) {
            collision.restitution = 0.0;
            collision.duration = std::numeric_limits<double>::infinity();
            return collision;
        }
    }
    throw InternalError(fmt::format("collision with damping {} did not end", damping));
}

double clippedLinearRestitution(double beta)
{
    SAND_CHECK(beta >= 0.0, "beta {}", beta);
    // The force x + 2 beta x' vanishes after t = 2 acos(beta) / sqrt(1 - beta^2), at which speed
    // exp(-beta t) is left; acos becomes acosh beyond critical damping, and their ratio to the
    // root is 1 at beta = 1.
    const double below = 1.0 - beta * beta;
    double ratio = 1.0 + (1.0 - beta) / 3.0;
    if (below > 1e-8) {
        ratio = std::acos(beta) / std::sqrt(below);
    } else if (below < -1e-8) {
        ratio = std::acosh(beta) / std::sqrt(-below);
    }
    return std::exp(-2.0 * beta * ratio);
}

double solveDamping(NormalLaw law, bool clipAttraction, double restitution)
{
    if (!(restitution >= kLeastRestitution && restitution <= 1.0)) {
        throw InputError(fmt::format("contact.restitution = {} must lie between {} and 1",
                                     restitution, kLeastRestitution));
    }
    if (restitution == 1.0) {
        return 0.0;
    }
    if (!clipAttraction && law != NormalLaw::bellYuMucha) {
        // Linear: rebound after half a period, e = exp(-pi beta / sqrt(1 - beta^2)).
        const double decay = std::log(restitution);
        const double beta = -decay / std::sqrt(kPi * kPi + decay * decay);
        // Hertz: the collision maps onto the linear one (Antypov & Elliott 2011).
        return law == NormalLaw::linear ? beta : 2.0 * std::sqrt(5.0 / 6.0) * beta;
    }
    const auto excess = [&](double damping) {
        return (law == NormalLaw::linear
                    ? clippedLinearRestitution(damping)
                    : integrateCollision(law, clipAttraction, damping).restitution)
               - restitution;
    };
    double high = 1.0;
    while (excess(high) > 0.0) {
        high *= 2.0;
        SAND_CHECK(high < 1e6, "no damping gives restitution {}", restitution);
    }
    return findRoot(excess, 0.0, high);
}

double collisionLength(NormalLaw law, double stiffness, double effectiveMass,
                       double effectiveRadius, double speed)
{
    SAND_CHECK(stiffness > 0.0 && effectiveMass > 0.0 && effectiveRadius > 0.0 && speed > 0.0,
               "stiffness {}, m* {}, R* {}, speed {}", stiffness, effectiveMass, effectiveRadius,
               speed);
    if (law == NormalLaw::linear) {
        return speed * std::sqrt(effectiveMass / stiffness);
    }
    return std::pow(effectiveMass * speed * speed / (stiffness * std::sqrt(effectiveRadius)), 0.4);
}

}  // namespace sandflow
