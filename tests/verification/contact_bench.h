#pragma once

#include "dem/contact_coefficients.h"
#include "solids/primitive.h"
#include "verification/verdict.h"

#include <memory>
#include <vector>

/// A few spheres and planes, put through the grain solver that scenes run.
namespace sandflow::verification {

struct Ball {
    double radius = 0.005;  ///< m
    double mass = 0.001;    ///< kg
    Vec3 position = Vec3::Zero();
    Vec3 velocity = Vec3::Zero();
    Vec3 spin = Vec3::Zero();

    double inertia() const { return 0.4 * mass * radius * radius; }
    double kineticEnergy() const
    {
        return 0.5 * (mass * velocity.squaredNorm() + inertia() * spin.squaredNorm());
    }
};

Ball makeBall(double radius, double density);

/// A smooth plane through `point`; sand is on the side of `normal`.
Primitive makePlane(const Vec3& point, const Vec3& normal);

/// How a case is stepped.
struct Stepping {
    double dt = 0.0;     ///< s
    double phase = 0.0;  ///< of a step, 0 to 1: how long before first contact a collision starts
    /// The kernel of scenes, in single precision with the lanes of this processor; else the same
    /// text in double.
    bool asShipped = false;
};

class ContactBench {
public:
    /// Balls keep their order as numbers. A ball may have any mass, so one may stand for a wall.
    ContactBench(const ContactCoefficients& law, const std::vector<Ball>& balls,
                 const std::vector<Primitive>& walls, const Vec3& gravity,
                 const Stepping& stepping);
    ~ContactBench();

    void step();
    const std::vector<Ball>& balls() const { return balls_; }
    const Ball& ball(std::size_t k = 0) const { return balls_[k]; }
    double time() const { return time_; }  ///< s
    /// N, what pushed ball k in the last step, without its weight; from its change of velocity.
    Vec3 pushOn(std::size_t k) const;

    /// One of the two precisions.
    class Grains;

private:
    std::vector<Ball> balls_, before_;
    Vec3 gravity_;
    double dt_;
    double time_ = 0.0;
    std::unique_ptr<Grains> grains_;
};

/// What a collision showed.
struct Impact {
    double deepest = 0.0;    ///< m, overlap
    double strongest = 0.0;  ///< N, along the normal
    double duration = 0.0;   ///< s of overlap
    std::vector<Ball> after;
};

/// Lets a ball that touches the plane z = 0 hit it, without gravity.
Impact hitPlane(const ContactCoefficients& law, Ball ball, const Stepping& stepping);
/// Lets two balls that touch hit each other.
Impact hitEachOther(const ContactCoefficients& law, Ball a, Ball b, const Stepping& stepping);

/// Hertz without friction, elastic. K = (4/3) E* [Pa].
ContactCoefficients hertzLaw(double stiffness);
/// Linear, without friction.
ContactCoefficients linearLaw(double stiffness, double restitution, bool clip);

/// An elastic material.
struct Material {
    const char* name;
    double young;    ///< Pa
    double poisson;
    double density;  ///< kg/m3

    /// K = (4/3) E* of two bodies of it; on a rigid plane it is twice that.
    double pairStiffness() const { return 2.0 / 3.0 * young / (1.0 - poisson * poisson); }
    double planeStiffness() const { return 2.0 * pairStiffness(); }
    /// kt / kn of Mindlin: 8 G* over 2 E*.
    double tangentialRatio() const { return 2.0 * (1.0 - poisson) / (2.0 - poisson); }
};

/// Seconds that an impact at `speed` lasts; effective mass and radius of the pair.
double impactDuration(const ContactCoefficients& law, double mass, double radius, double speed);

/// The step that a scene with such grains would run with: 0.8 of the bound of packed grains whose
/// contacts are as stiff as at the peak of an impact at `speed` [m/s].
double shippingStep(const ContactCoefficients& law, const Ball& smallest, double speed);

/// What is expected of one number that a case measures.
struct Expectation {
    std::string quantity;
    double expected;
    Gate gate;
    double tolerance = 0.0;
};

/// A case as a function of how it is stepped: its numbers, in the order of its expectations.
using Measure = std::function<std::vector<double>(const Stepping&)>;

/// Measures with the fine step in double, and as shipped: of `phases` ways to enter the contact
/// that which is farthest from what is expected. Appends to `verdicts`.
void judge(const std::vector<Expectation>& expectations, const Measure& measure, double fineStep,
           double shippedStep, std::vector<Verdict>& verdicts, int phases = 8);

}  // namespace sandflow::verification
