#include "io/camera_frame.h"

#include "core/errors.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sandflow {
namespace {

/// From the target to the camera: from the front, a little to the right and 24 degrees up, so that
/// the flank's profile shows; half the picture's height is 9 degrees, so the horizon stays out.
const Vec3 kDefaultView = Vec3(0.38, -1.0, 0.475).normalized();

constexpr double kAspect = 16.0 / 9.0;
constexpr double kSandWidth = 0.63;   ///< of the picture
constexpr double kSandHeight = 0.72;
constexpr double kSolidShare = 0.93;  ///< both ways

/// Points that outline the sand: a heap is round, so the corners of its box would waste space.
std::vector<Vec3> outlineSand(const Box3& sand)
{
    std::vector<Vec3> points;
    const Vec3 centre = sand.center();
    const Vec3 half = 0.5 * sand.sizes();
    for (int k = 0; k < 24; ++k) {
        const double phi = 2.0 * kPi * k / 24.0;
        const Vec3 direction(half.x() * std::cos(phi), half.y() * std::sin(phi), 0.0);
        points.push_back(centre + direction - Vec3(0.0, 0.0, half.z()));
        points.push_back(centre + 0.3 * direction + Vec3(0.0, 0.0, half.z()));
    }
    return points;
}

void addCorners(std::vector<Vec3>& points, const Vec3& min, const Vec3& max)
{
    for (unsigned corner = 0; corner < 8; ++corner) {
        points.emplace_back((corner & 1U) != 0 ? max.x() : min.x(),
                            (corner & 2U) != 0 ? max.y() : min.y(),
                            (corner & 4U) != 0 ? max.z() : min.z());
    }
}

/// The points of a mesh that stick out most in 100 directions; no other sticks out by much more.
void addOutermost(std::vector<Vec3>& points, const TriangleMesh& mesh)
{
    constexpr int directions = 100;
    std::vector<Vec3> used;  // a point without a triangle is not seen
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            used.push_back(mesh.points[corner]);
        }
    }
    SAND_CHECK(!used.empty(), "a mesh without triangles has no outline");
    for (int k = 0; k < directions; ++k) {
        // Evenly over the sphere, by the golden angle.
        const double z = (2.0 * k + 1.0) / directions - 1.0;
        const double phi = k * kPi * (3.0 - std::sqrt(5.0));
        const double out = std::sqrt(1.0 - z * z);
        const Vec3 direction(out * std::cos(phi), out * std::sin(phi), z);
        const auto before = [&](const Vec3& a, const Vec3& b) {
            return a.dot(direction) < b.dot(direction);
        };
        points.push_back(*std::ranges::max_element(used, before));
    }
}

/// Outline points of every visible solid of limited size; those much larger than the sand are
/// ground rather than things and may leave the picture.
std::vector<Vec3> outlineSolids(const Scene& scene, const Box3& sand,
                                std::span<const SceneMesh> meshes)
{
    const double largest = 3.0 * sand.diagonal().norm();
    std::vector<Vec3> points;
    for (const SolidSpec& solid : scene.solids) {
        if (solid.look == "none") {
            continue;
        }
        std::vector<Vec3> own;
        if (solid.shape == SolidShape::box) {
            addCorners(own, solid.min, solid.max);
        } else if (solid.shape == SolidShape::disc || solid.shape == SolidShape::cylinder) {
            const Vec3 u = solid.normal.unitOrthogonal();
            const Vec3 v = solid.normal.cross(u);
            const double height = solid.shape == SolidShape::disc ? 0.0 : solid.height;
            for (int k = 0; k < 16; ++k) {
                const double phi = 2.0 * kPi * k / 16.0;
                const Vec3 rim =
                    solid.point + solid.radius * (std::cos(phi) * u + std::sin(phi) * v);
                own.push_back(rim);
                own.push_back(rim + height * solid.normal);
            }
        }
        Box3 size;
        for (const Vec3& point : own) {
            size.extend(point);
        }
        if (!own.empty() && size.diagonal().norm() <= largest) {
            points.insert(points.end(), own.begin(), own.end());
        }
    }
    for (const SceneMesh& mesh : meshes) {
        if (isThing(scene, sand, mesh)) {
            addOutermost(points, mesh.mesh);
        }
    }
    return points;
}

/// The part of the picture a set of points takes, in units of its half width and half height.
struct Extent {
    double left = 1e30;
    double right = -1e30;
    double bottom = 1e30;
    double top = -1e30;
    bool behind = false;  ///< a point is not in front of the camera
};

Extent project(const CameraFrame& camera, const std::vector<Vec3>& points)
{
    const Vec3 forward = (camera.lookAt - camera.position).normalized();
    Vec3 right = forward.cross(Vec3::UnitZ());
    right = right.norm() > 1e-9 ? right.normalized() : Vec3::UnitX();
    const Vec3 up = right.cross(forward);
    const double halfWidth = std::tan(0.5 * camera.angle * kPi / 180.0);
    Extent extent;
    for (const Vec3& point : points) {
        const Vec3 offset = point - camera.position;
        const double depth = offset.dot(forward);
        if (depth <= 1e-9) {
            extent.behind = true;
            continue;
        }
        const double x = offset.dot(right) / (depth * halfWidth);
        const double y = offset.dot(up) / (depth * halfWidth / kAspect);
        extent.left = std::min(extent.left, x);
        extent.right = std::max(extent.right, x);
        extent.bottom = std::min(extent.bottom, y);
        extent.top = std::max(extent.top, y);
    }
    return extent;
}

bool fits(const Extent& extent, double width, double height)
{
    return !extent.behind && extent.right <= width && extent.left >= -width &&
           extent.top <= height && extent.bottom >= -height;
}

/// Nearest distance along `direction` from which everything fits, by bisection.
double findDistance(CameraFrame camera, const Vec3& direction, const std::vector<Vec3>& sand,
                    const std::vector<Vec3>& solids)
{
    double low = 0.0;
    double high = 1e-6;
    const auto fitsFrom = [&](double distance) {
        camera.position = camera.lookAt + distance * direction;
        return fits(project(camera, sand), kSandWidth, kSandHeight) &&
               (solids.empty() || fits(project(camera, solids), kSolidShare, kSolidShare));
    };
    while (high < 1e9 && !fitsFrom(high)) {
        low = high;
        high *= 2.0;
    }
    for (int round = 0; round < 50; ++round) {
        const double middle = 0.5 * (low + high);
        (fitsFrom(middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace

CameraFrame frameCamera(const Scene& scene, const Box3& sand, std::span<const SceneMesh> meshes)
{
    CameraFrame camera;
    camera.angle = scene.camera.angle;
    camera.lookAt = scene.camera.lookAt.value_or(sand.center());
    if (scene.camera.position) {
        camera.position = *scene.camera.position;
        return camera;
    }
    const std::vector<Vec3> sandPoints = outlineSand(sand);
    const std::vector<Vec3> solidPoints = outlineSolids(scene, sand, meshes);
    std::vector<Vec3> all = sandPoints;
    all.insert(all.end(), solidPoints.begin(), solidPoints.end());
    // Perspective enlarges what is near, so the centre of the box is not the centre of the picture:
    // aim, look where the things came to lie, and aim again.
    for (int round = 0; round < 12; ++round) {
        camera.position = camera.lookAt + kDefaultView * findDistance(camera, kDefaultView,
                                                                      sandPoints, solidPoints);
        if (scene.camera.lookAt) {
            break;
        }
        const Extent extent = project(camera, all);
        const Vec3 toTarget = camera.lookAt - camera.position;
        const Vec3 forward = toTarget.normalized();
        const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
        const Vec3 up = right.cross(forward);
        const double halfWidth = std::tan(0.5 * camera.angle * kPi / 180.0) * toTarget.norm();
        camera.lookAt += 0.5 * (extent.left + extent.right) * halfWidth * right +
                         0.5 * (extent.bottom + extent.top) * halfWidth / kAspect * up;
    }
    return camera;
}

}  // namespace sandflow
