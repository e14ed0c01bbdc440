#include "verification/contact_bench.h"

#include "core/errors.h"
#include "dem/dem.h"
#include "dem/restitution.h"

#include <algorithm>
#include <cmath>

namespace sandflow::verification {

/// The grain solver behind either precision.
class ContactBench::Grains {
public:
    virtual ~Grains() = default;
    virtual void step(double time, double dt) = 0;
    virtual void read(std::vector<Ball>& balls) const = 0;
};

namespace {

constexpr int kMostSteps = 50'000'000;  ///< of one collision: something is wrong beyond that

DemSetup makeSetup(const ContactCoefficients& law, const std::vector<Ball>& balls,
                   const std::vector<Primitive>& walls, const Vec3& gravity)
{
    const auto [smallest, largest] =
        std::minmax_element(balls.begin(), balls.end(), [](const Ball& a, const Ball& b) {
            return a.radius < b.radius;
        });
    DemSetup setup;
    setup.law = law;
    setup.meanRadius = smallest->radius;
    setup.largestRadius = largest->radius;
    setup.gravity = gravity;
    setup.primitives = walls;
    setup.judged = false;
    return setup;
}

template <class Real>
class GrainsOf : public ContactBench::Grains {
public:
    GrainsOf(const DemSetup& setup, const std::vector<Ball>& balls) : dem_(setup)
    {
        for (std::size_t k = 0; k < balls.size(); ++k) {
            const Ball& b = balls[k];
            dem_.addMobile(b.position, b.velocity, b.spin, b.radius,
                           static_cast<std::uint32_t>(k));
            dem_.mobile().record.back().inverseMass = static_cast<Real>(1.0 / b.mass);
        }
    }

    void step(double time, double dt) override
    {
        if (!dem_.listsHold()) {
            dem_.rebuild(time, dt);
        }
        dem_.step(dt, false);
    }

    void read(std::vector<Ball>& balls) const override
    {
        for (const GrainRecord<Real>& g : dem_.mobile().record) {  // sorted by place, not by id
            Ball& b = balls[g.id];
            b.position = Vec3(g.x, g.y, g.z);
            b.velocity = Vec3(g.vx, g.vy, g.vz);
            b.spin = Vec3(g.wx, g.wy, g.wz);
        }
    }

private:
    Dem<Real> dem_;
};

/// Runs a collision from just before first contact to its end; overlap [m] of the two bodies and
/// the unit normal onto ball 0 as functions of the balls.
template <class Overlap, class Normal>
Impact collide(ContactBench& bench, const Stepping& stepping, const Overlap& overlapOf,
               const Normal& normalOf)
{
    Impact impact;
    double before = overlapOf(bench.balls());
    bool touched = false;
    for (int k = 0; k < kMostSteps; ++k) {
        const Vec3 normal = normalOf(bench.balls());
        bench.step();
        impact.strongest = std::max(impact.strongest, bench.pushOn(0).dot(normal));
        const double overlap = overlapOf(bench.balls());
        impact.deepest = std::max(impact.deepest, overlap);
        if (touched && overlap <= 0.0) {
            // It parted between two steps, and began `phase` steps after the start.
            const double beyond = stepping.dt * overlap / (overlap - before);
            impact.duration = bench.time() - beyond - stepping.phase * stepping.dt;
            impact.after = bench.balls();
            return impact;
        }
        touched = touched || overlap > 0.0;
        before = overlap;
    }
    throw InternalError("a collision does not end");
}

/// Where it was `phase` of a step before.
void setBack(Ball& ball, const Stepping& stepping)
{
    ball.position -= stepping.phase * stepping.dt * ball.velocity;
}

}  // namespace

Ball makeBall(double radius, double density)
{
    Ball ball;
    ball.radius = radius;
    ball.mass = 4.0 / 3.0 * kPi * radius * radius * radius * density;
    return ball;
}

Primitive makePlane(const Vec3& point, const Vec3& normal)
{
    Primitive plane;
    plane.point = point;
    plane.axis = normal;
    return plane;
}

ContactBench::ContactBench(const ContactCoefficients& law, const std::vector<Ball>& balls,
                           const std::vector<Primitive>& walls, const Vec3& gravity,
                           const Stepping& stepping)
    : balls_(balls), before_(balls), gravity_(gravity), dt_(stepping.dt)
{
    const DemSetup setup = makeSetup(law, balls, walls, gravity);
    if (stepping.asShipped) {
        grains_ = std::make_unique<GrainsOf<float>>(setup, balls);
    } else {
        grains_ = std::make_unique<GrainsOf<double>>(setup, balls);
    }
}

ContactBench::~ContactBench() = default;

void ContactBench::step()
{
    before_ = balls_;
    grains_->step(time_, dt_);
    grains_->read(balls_);
    time_ += dt_;
}

Vec3 ContactBench::pushOn(std::size_t k) const
{
    return balls_[k].mass * ((balls_[k].velocity - before_[k].velocity) / dt_ - gravity_);
}

Impact hitPlane(const ContactCoefficients& law, Ball ball, const Stepping& stepping)
{
    setBack(ball, stepping);
    ContactBench bench(law, {ball}, {makePlane(Vec3::Zero(), Vec3::UnitZ())}, Vec3::Zero(),
                       stepping);
    return collide(
        bench, stepping, [](const auto& balls) { return balls[0].radius - balls[0].position.z(); },
        [](const auto&) { return Vec3(Vec3::UnitZ()); });
}

Impact hitEachOther(const ContactCoefficients& law, Ball a, Ball b, const Stepping& stepping)
{
    setBack(a, stepping);
    setBack(b, stepping);
    ContactBench bench(law, {a, b}, {}, Vec3::Zero(), stepping);
    return collide(
        bench, stepping,
        [](const auto& balls) {
            return balls[0].radius + balls[1].radius
                   - (balls[0].position - balls[1].position).norm();
        },
        [](const auto& balls) {
            return Vec3((balls[0].position - balls[1].position).normalized());
        });
}

ContactCoefficients hertzLaw(double stiffness)
{
    ContactCoefficients law;
    law.law = NormalLaw::hertz;
    law.stiffness = stiffness;
    return law;
}

ContactCoefficients linearLaw(double stiffness, double restitution, bool clip)
{
    ContactCoefficients law;
    law.clipAttraction = clip;
    law.stiffness = stiffness;
    law.damping = solveDamping(NormalLaw::linear, clip, restitution);
    return law;
}

double impactDuration(const ContactCoefficients& law, double mass, double radius, double speed)
{
    const double scale = collisionLength(law.law, law.stiffness, mass, radius, speed);
    const double damping =
        law.law == NormalLaw::bellYuMucha ? law.damping * speed / scale : law.damping;
    return integrateCollision(law.law, law.clipAttraction, damping).duration * scale / speed;
}

double shippingStep(const ContactCoefficients& law, const Ball& smallest, double speed)
{
    LoadCase load;
    load.fastestSpeed = speed;
    load.minRadius = load.maxRadius = smallest.radius;
    load.density = smallest.mass / (4.0 / 3.0 * kPi * std::pow(smallest.radius, 3));
    // As scenes do: a grain against a fixed one of its size.
    const double overlap = integratePeakOverlap(law, smallest.mass, 0.5 * smallest.radius, speed);
    return stableStep(law, load, overlap, 0.8, std::nullopt).step;
}

void judge(const std::vector<Expectation>& expectations, const Measure& measure, double fineStep,
           double shippedStep, std::vector<Verdict>& verdicts, int phases)
{
    const std::vector<double> ours = measure({fineStep, 0.0, false});
    SAND_CHECK(ours.size() == expectations.size(), "{} numbers for {} expectations", ours.size(),
               expectations.size());
    std::vector<double> shipped(ours.size(), kNotMeasured);
    for (int p = 0; p < phases; ++p) {
        const std::vector<double> now =
            measure({shippedStep, static_cast<double>(p) / phases, true});
        for (std::size_t k = 0; k < now.size(); ++k) {
            const double expected = expectations[k].expected;
            if (p == 0 || std::abs(now[k] - expected) > std::abs(shipped[k] - expected)) {
                shipped[k] = now[k];
            }
        }
    }
    for (std::size_t k = 0; k < ours.size(); ++k) {
        const Expectation& e = expectations[k];
        verdicts.push_back({e.quantity, e.expected, ours[k], e.gate, e.tolerance, shipped[k]});
    }
}

}  // namespace sandflow::verification
