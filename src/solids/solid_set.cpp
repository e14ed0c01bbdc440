#include "solids/solid_set.h"

#include "core/errors.h"
#include "core/stage_clock.h"
#include "mesh/check_mesh.h"
#include "mesh/find_mesh.h"
#include "mesh/load_mesh.h"
#include "mesh/place_mesh.h"
#include "mesh/sample_cache.h"
#include "scene/radius_range.h"
#include "solids/free_intervals.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// Gaps between solids lower than this many diameters hold no sand.
constexpr double kSmallestGap = 1.0;
/// In mean radii: solid stretches of a mesh thinner than this are folds of its surface, and a
/// surface without a back counts as a slab of this thickness.
constexpr double kSliver = 0.05;
constexpr double kSlab = 0.5;
/// Floors or ceilings on the lines of a column that differ by more than its edge (a slope of about
/// 56 degrees) belong to different levels.
constexpr double kRaggedShare = 1.0;
/// The cover of a mesh is the same in every run, so that it is made once.
constexpr std::uint64_t kCoverSeed = 1;

MeshPlacement placementOf(const SolidSpec& solid)
{
    MeshPlacement place;
    place.yUp = solid.up == UpAxis::y;
    place.scale = solid.scale;
    place.fitHeight = solid.fitHeight;
    place.fitLength = solid.fitLength;
    place.turnDegrees = solid.turn;
    place.stand = solid.stand;
    place.point = solid.point;
    return place;
}

/// In mean radii: kMeshCoverGap, or less where the smallest grain, pressed as deep as the scene allows,
/// would slip through between the particles (its distance from the three nearest is then the gap).
double meshCoverGapFor(const Scene& scene)
{
    const double smallest = radiusRange(scene).smallest / scene.grains.radius;
    return std::min(kMeshCoverGap,
                    kMeshCoverRadius + smallest * (1.0 - scene.contact.maxOverlap));
}

}  // namespace

SolidSet::SolidSet(const Scene& scene)
    : smallestGap_(kSmallestGap * scene.diameter()),
      slabThickness_(kSlab * scene.grains.radius),
      thinnestSolid_(kSliver * scene.grains.radius)
{
    for (std::size_t s = 0; s < scene.solids.size(); ++s) {
        if (scene.solids[s].shape == SolidShape::mesh) {
            addMesh(scene, s);
        } else {
            const auto parts = buildPrimitives(scene.solids[s], static_cast<int>(s));
            primitives_.insert(primitives_.end(), parts.begin(), parts.end());
        }
    }
}

void SolidSet::addMesh(const Scene& scene, std::size_t s)
{
    const SolidSpec& solid = scene.solids[s];
    const std::string name = nameSolid(solid, static_cast<int>(s));
    const std::filesystem::path folder = std::filesystem::path(scene.sourcePath).parent_path();
    std::optional<std::filesystem::path> file = findMesh(solid.mesh, folder);
    bool standsIn = false;
    if (!file && !solid.standIn.empty()) {
        file = findMesh(solid.standIn, folder);
        standsIn = file.has_value();
    }
    if (!file) {
        std::string places;
        for (const std::filesystem::path& place : listMeshPlaces(solid.mesh, folder)) {
            places += (places.empty() ? "" : ", ") + place.string();
        }
        throw InputError(fmt::format("{}: mesh \"{}\" is not there; looked for {}", name,
                                     solid.mesh, places));
    }
    if (standsIn) {
        notices_.push_back(fmt::format(
            "{}: mesh \"{}\" is not there, {} stands in for it; scripts/get_meshes.sh gets the "
            "scans",
            name, solid.mesh, file->filename().string()));
    }
    const MeshPlacement place = placementOf(solid);
    double loading = 0.0, covering = 0.0, scale = 1.0;
    LoadedMesh loaded;
    TriangleMesh placed;
    {
        StageClock clock(loading);
        loaded = loadMesh(*file);
        scale = scaleOf(loaded.mesh, place);
        placed = placeMesh(std::move(loaded.mesh), place);
    }
    const double r = scene.grains.radius;
    for (const std::string& repair : loaded.report.repairs) {
        notices_.push_back(fmt::format("{}: {}", name, repair));
    }
    for (const std::string& doubt : checkMeshAgainstGrains(loaded.report, scale, r)) {
        notices_.push_back(fmt::format("{}: {}", name, doubt));
    }
    SurfaceSamples cover;
    {
        StageClock clock(covering);
        cover = sampleSurfaceCached(placed, meshCoverGapFor(scene) * r, kCoverSeed,
                                    defaultSampleCacheFolder());
    }
    MeshColumns columns(placed, slabThickness_);
    meshes_.push_back({static_cast<int>(s), solid.from, solid.until, file->string(),
                       std::move(placed), std::move(columns), std::move(cover), loading, covering});
}

/// The free stretches of one vertical line.
void SolidSet::freeOnLine(double time, double x, double y,
                          std::vector<std::pair<double, double>>& out) const
{
    out.clear();
    appendSolidStretches(primitives_, time, x, y, out);
    std::vector<SolidInterval> inside;
    for (const MeshSolid& mesh : meshes_) {
        if (!mesh.existsAt(time)) {
            continue;
        }
        mesh.columns.solidIntervalsAt(x, y, inside);
        dropSlivers(thinnestSolid_, inside);
        for (const SolidInterval& stretch : inside) {
            out.emplace_back(stretch.lo, stretch.hi);
        }
    }
    keepGaps(smallestGap_, out);
}

void SolidSet::freeStretches(double time, double x, double y, double edge,
                             std::vector<FreeStretch>& out) const
{
    std::vector<std::pair<double, double>> middle, beside;
    freeOnLine(time, x, y, middle);
    out.clear();
    for (const auto& [floor, ceiling] : middle) {
        out.push_back({floor, ceiling, false});
    }
    // Level planes look the same from every line.
    const bool plain = meshes_.empty() &&
                       std::all_of(primitives_.begin(), primitives_.end(), [](const Primitive& p) {
                           return p.kind == Primitive::Kind::halfSpace;
                       });
    if (plain || edge <= 0.0) {
        return;
    }
    const double most = kRaggedShare * edge;
    for (const int line : {0, 1, 2, 3, 5, 6, 7, 8}) {
        const double dx = (line % 3 - 1) * edge / 3.0, dy = (line / 3 - 1) * edge / 3.0;
        freeOnLine(time, x + dx, y + dy, beside);
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k].ragged = out[k].ragged || beside.size() != out.size() ||
                            std::abs(beside[k].first - out[k].floor) > most ||
                            std::abs(beside[k].second - out[k].ceiling) > most;
        }
    }
}

bool SolidSet::partsColumns(double time, const Vec2& a, const Vec2& b, double lo, double hi) const
{
    return std::any_of(primitives_.begin(), primitives_.end(), [&](const Primitive& p) {
        return p.existsAt(time) && blocksPath(p, a, b, lo, hi);
    });
}

bool SolidSet::contains(double time, const Vec3& p) const
{
    return std::any_of(primitives_.begin(), primitives_.end(),
                       [&](const Primitive& solid) {
                           return solid.existsAt(time) && nearestSurface(solid, p).distance < 0.0;
                       }) ||
           std::any_of(meshes_.begin(), meshes_.end(), [&](const MeshSolid& mesh) {
               return mesh.existsAt(time) && mesh.columns.contains(p);
           });
}

bool SolidSet::changesBetween(double from, double to) const
{
    const auto changes = [&](const auto& solid) { return solid.existsAt(from) != solid.existsAt(to); };
    return std::any_of(primitives_.begin(), primitives_.end(), changes) ||
           std::any_of(meshes_.begin(), meshes_.end(), changes);
}

std::vector<Eigen::AlignedBox3d> SolidSet::meshBounds() const
{
    std::vector<Eigen::AlignedBox3d> bounds;
    for (const MeshSolid& mesh : meshes_) {
        bounds.push_back(boundsOf(mesh.mesh));
    }
    return bounds;
}

}  // namespace sandflow
