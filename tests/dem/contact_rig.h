#pragma once

#include "core/errors.h"
#include "core/small_vec.h"
#include "dem/contact_coefficients.h"
#include "dem/contact_law.h"

#include <cmath>

/// One sphere, one plane, no neighbour lists: just enough to put the functions of the contact law
/// through a collision. Symplectic Euler in double. (Published collisions go through the grain
/// solver itself, see tests/verification.)
namespace sandflow::rig {

using Real3 = Vec<double>;

struct Ball {
    double radius = 0.005;
    double mass = 0.001;
    Real3 position;
    Real3 velocity;
    Real3 spin;

    double inertia() const { return 0.4 * mass * radius * radius; }
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

/// One step of a ball on the plane z = 0, which has infinite mass and radius. No weight.
inline void stepOnPlane(const ContactCoefficients& law, Ball& ball, Touch& contact, double dt)
{
    const Real3 n{0.0, 0.0, -1.0};  // from the ball to the plane
    Real3 force;
    Real3 torque;
    contact.overlap = ball.radius - ball.position.z;
    contact.normalForce = 0.0;
    if (contact.overlap < 0.0) {
        contact.tangentialSpring = {};
        contact.rollingSpring = {};
    } else {
        const LawNumbers<double> numbers(law);
        const Real3 slip = projectOff(ball.velocity, n) + cross(ball.radius * ball.spin, n);
        const Real3 rollingVelocity = ball.radius * projectOff(ball.spin, n);
        const double inertia = ball.inertia() + ball.mass * ball.radius * ball.radius;

        const NormalForce<double> normal =
            evaluateNormalOf(law.law, numbers, contact.overlap, dot(ball.velocity, n), ball.mass,
                             ball.radius);
        const Tangential<double> tangential =
            evaluateTangential(numbers, turnInto(contact.tangentialSpring, n), slip, normal.force,
                               normal.tangentStiffness, normal.dashpot, dt);
        const Rolling<double> rolling =
            evaluateRolling(numbers, turnInto(contact.rollingSpring, n), rollingVelocity,
                            normal.force, normal.tangentStiffness, ball.radius,
                            inertia / (ball.radius * ball.radius), dt);

        contact.tangentialSpring = tangential.spring;
        contact.rollingSpring = rolling.spring;
        contact.normalForce = normal.force;
        contact.peakOverlap = std::max(contact.peakOverlap, contact.overlap);
        contact.peakForce = std::max(contact.peakForce, normal.force);
        force = tangential.force - normal.force * n;
        torque = cross(ball.radius * n, tangential.force) + rolling.torque;
    }
    ball.velocity += (dt / ball.mass) * force;
    ball.spin += (dt / ball.inertia()) * torque;
    ball.position += dt * ball.velocity;
}

/// Lets a ball that touches the plane z = 0 hit it until it has left. Returns the seconds of
/// overlap.
inline double hitPlane(const ContactCoefficients& law, Ball& ball, Touch& contact, double dt)
{
    double time = 0.0;
    do {
        stepOnPlane(law, ball, contact, dt);
        time += dt;
    } while (ball.position.z < ball.radius);
    return time;
}

}  // namespace sandflow::rig
