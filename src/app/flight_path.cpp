#include "app/flight_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandflow {
namespace {

/// Surfaces whose normal leans further than this from straight up are walls: sand slides off them.
constexpr double kLeastGround = 0.1;

/// Farther than this from every solid nothing is met any more, m.
constexpr double kLost = 1e5;

/// Enough for a grain that trickles down a wall of a thousand diameters.
constexpr int kMostSteps = 20000;

struct Nearest {
    SurfacePoint surface{std::numeric_limits<double>::infinity(), Vec3::UnitZ()};
    int solid = -1;
};

/// A mesh is known by the box about it and, in there, by what is inside: to half a radius at best.
void comeNearMesh(const MeshSolid& mesh, const Vec3& point, double radius, Nearest& nearest)
{
    const double away = std::sqrt(mesh.columns.bounds().squaredExteriorDistance(point));
    const bool touches = away == 0.0 && mesh.columns.contains(point - radius * Vec3::UnitZ());
    const double distance = touches ? 0.0 : std::max(away, 1.01 * radius);
    if (distance < nearest.surface.distance) {
        nearest = {{distance, Vec3::UnitZ()}, mesh.solid};
    }
}

Nearest findNearest(const SolidSet& solids, const Vec3& point, double time, double radius)
{
    Nearest nearest;
    for (const MeshSolid& mesh : solids.meshes()) {
        if (mesh.existsAt(time)) {
            comeNearMesh(mesh, point, radius, nearest);
        }
    }
    for (const Primitive& primitive : solids.primitives()) {
        if (!primitive.existsAt(time)) {
            continue;
        }
        const SurfacePoint surface = nearestSurface(primitive, point);
        if (surface.distance < nearest.surface.distance) {
            nearest = {surface, primitive.solid};
        }
    }
    return nearest;
}

}  // namespace

Flight followGrain(const Scene& scene, const SolidSet& solids, const Vec3& position,
                   const Vec3& velocity, double start)
{
    const double g = scene.gravity.norm();
    const Vec3 up = g > 0.0 ? Vec3(-scene.gravity / g) : Vec3::UnitZ();
    const double radius = scene.grains.radius;
    Flight flight;
    Vec3 place = position, motion = velocity;
    double time = start;
    for (int step = 0; step < kMostSteps; ++step) {
        const Nearest nearest = findNearest(solids, place, time, radius);
        if (nearest.surface.distance > kLost) {
            break;
        }
        if (nearest.surface.distance <= radius) {
            const Impact impact{place, time, motion.norm(), nearest.solid,
                                nearest.surface.normal.dot(up) >= kLeastGround};
            flight.first = flight.first ? flight.first : impact;
            if (impact.onGround) {
                flight.landing = impact;
                break;
            }
            // A wall stops it; it goes on from rest, just clear of the wall.
            motion.setZero();
            place += (1.01 * radius - nearest.surface.distance) * nearest.surface.normal;
        }
        // No solid is met within a path as long as the distance to the nearest; at least half a
        // radius, so that it gets on. Path <= v t + g t^2 / 2.
        const double path = std::max(0.5 * radius, nearest.surface.distance - radius);
        const double speed = motion.norm();
        const double dt = g > 0.0 ? 2.0 * path / (speed + std::sqrt(speed * speed + 2.0 * g * path))
                                  : path / std::max(speed, 1e-12);
        place += dt * motion + 0.5 * dt * dt * scene.gravity;
        motion += dt * scene.gravity;
        time += dt;
    }
    return flight;
}

}  // namespace sandflow
