#pragma once

#include "core/errors.h"
#include "core/small_vec.h"
#include "dem/contact_coefficients.h"
#include "dem/contact_law.h"

#include <cmath>

/// A few spheres, one plane, no neighbour lists: just enough to put the contact law through
/// collisions with known answers. Symplectic Euler in double.
namespace sandflow::rig {

using Real3 = Vec<double>;

struct Ball {
    double radius = 0.005;
    double mass = 0.001;
    Real3 position;
    Real3 velocity;
    Real3 spin;

    double inertia() const { return 0.4 * mass * radius * radius; }
    double kineticEnergy() const
    {
        return 0.5 * (mass * dot(velocity, velocity) + inertia() * dot(spin, spin));
    }
};

inline Ball makeBall(double radius, double density)
{
    Ball ball;
    ball.radius = radius;
    ball.mass = 4.0 / 3.0 * kPi * radius * radius * radius * density;
    return ball;
}

/// What one contact remembers, and what it saw.
struct Touch {
    Real3 tangentialSpring;
    Real3 rollingSpring;
    double overlap = 0.0;      ///< m, now
    double normalForce = 0.0;  ///< N, now
    double peakOverlap = 0.0;  ///< m
    double peakForce = 0.0;    ///< N
};

struct Push {
    Real3 force;
    Real3 torque;
};

inline NormalForce<double> evaluateNormalOf(NormalLaw law, const LawNumbers<double>& numbers,
                                            double overlap, double closingSpeed, double mass,
                                            double radius)
{
    switch (law) {
    case NormalLaw::linear:
        return evaluateNormal<NormalLaw::linear>(numbers, overlap, closingSpeed, mass, radius);
    case NormalLaw::hertz:
        return evaluateNormal<NormalLaw::hertz>(numbers, overlap, closingSpeed, mass, radius);
    case NormalLaw::bellYuMucha:
        return evaluateNormal<NormalLaw::bellYuMucha>(numbers, overlap, closingSpeed, mass,
                                                      radius);
    }
    throw InternalError("unknown contact law");
}

/// Turns a stored spring into the tangent plane of n, keeping its length.
inline Real3 turnInto(const Real3& spring, const Real3& n)
{
    const Real3 flat = projectOff(spring, n);
    const double size = length(flat);
    return size > 0.0 ? (length(spring) / size) * flat : flat;
}

/// Adds the contact of a with a partner along n (from a to the partner) to both pushes. A fixed
/// partner has infinite mass and radius (plane): pass partner = nullptr.
inline void touch(const ContactCoefficients& law, double dt, const Real3& n, double overlap,
                  const Ball& a, const Ball* partner, Touch& contact, Push& onA, Push* onPartner)
{
    contact.overlap = overlap;
    contact.normalForce = 0.0;
    if (overlap < 0.0) {
        contact.tangentialSpring = {};
        contact.rollingSpring = {};
        return;
    }
    const LawNumbers<double> numbers(law);
    const auto pairOf = [](double x, double y) { return x * y / (x + y); };
    const double mass = partner ? pairOf(a.mass, partner->mass) : a.mass;
    const double radius = partner ? pairOf(a.radius, partner->radius) : a.radius;
    const double inertiaA = a.inertia() + a.mass * a.radius * a.radius;
    const double inertia =
        partner ? pairOf(inertiaA, partner->inertia()
                                       + partner->mass * partner->radius * partner->radius)
                : inertiaA;

    const Real3 relative = partner ? a.velocity - partner->velocity : a.velocity;
    const Real3 turning = a.radius * a.spin + (partner ? partner->radius * partner->spin : Real3{});
    const Real3 slip = projectOff(relative, n) + cross(turning, n);
    const Real3 rollingVelocity =
        radius * projectOff(partner ? a.spin - partner->spin : a.spin, n);

    const NormalForce<double> normal =
        evaluateNormalOf(law.law, numbers, overlap, dot(relative, n), mass, radius);
    const Tangential<double> tangential =
        evaluateTangential(numbers, turnInto(contact.tangentialSpring, n), slip, normal.force,
                           normal.tangentStiffness, normal.dashpot, dt);
    const Rolling<double> rolling =
        evaluateRolling(numbers, turnInto(contact.rollingSpring, n), rollingVelocity,
                        normal.force, normal.tangentStiffness, radius,
                        inertia / (radius * radius), dt);

    contact.tangentialSpring = tangential.spring;
    contact.rollingSpring = rolling.spring;
    contact.normalForce = normal.force;
    contact.peakOverlap = std::max(contact.peakOverlap, overlap);
    contact.peakForce = std::max(contact.peakForce, normal.force);

    onA.force += tangential.force - normal.force * n;
    onA.torque += cross(a.radius * n, tangential.force) + rolling.torque;
    if (onPartner) {
        onPartner->force += normal.force * n - tangential.force;
        onPartner->torque += cross(partner->radius * n, tangential.force) - rolling.torque;
    }
}

inline void move(Ball& ball, const Push& push, const Real3& gravity, double dt)
{
    ball.velocity += dt * (gravity + (1.0 / ball.mass) * push.force);
    ball.spin += (dt / ball.inertia()) * push.torque;
    ball.position += dt * ball.velocity;
}

/// One step of a ball on the plane through the origin with unit normal `up`.
inline void stepOnPlane(const ContactCoefficients& law, Ball& ball, Touch& contact,
                        const Real3& up, const Real3& gravity, double dt)
{
    Push push;
    touch(law, dt, -up, ball.radius - dot(ball.position, up), ball, nullptr, contact, push,
          nullptr);
    move(ball, push, gravity, dt);
}

/// One step of two balls that may touch each other.
inline void stepPair(const ContactCoefficients& law, Ball& a, Ball& b, Touch& contact, double dt)
{
    const Real3 apart = b.position - a.position;
    const double distance = length(apart);
    Push onA;
    Push onB;
    touch(law, dt, (1.0 / distance) * apart, a.radius + b.radius - distance, a, &b, contact, onA,
          &onB);
    move(a, onA, {}, dt);
    move(b, onB, {}, dt);
}

/// Lets a ball that touches the plane z = 0 hit it, without gravity, until it has left. Returns the
/// seconds of overlap.
inline double hitPlane(const ContactCoefficients& law, Ball& ball, Touch& contact, double dt)
{
    double time = 0.0;
    do {
        stepOnPlane(law, ball, contact, {0.0, 0.0, 1.0}, {}, dt);
        time += dt;
    } while (ball.position.z < ball.radius);
    return time;
}

}  // namespace sandflow::rig
