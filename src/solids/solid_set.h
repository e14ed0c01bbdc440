#pragma once

#include "mesh/mesh_columns.h"
#include "mesh/sample_surface.h"
#include "solids/primitive.h"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sandflow {

/// The particles that cover a mesh, in mean grain radii. With a gap of 0.85 r and particles of half a
/// radius a grain passes only when pressed to 0.57 of the contact distance of 1.5 r, and it
/// rests a third of a radius above the surface: too little to be seen. Where the smallest grains are
/// below half the mean radius the gap is less.
inline constexpr double kMeshCoverGap = 0.85;
inline constexpr double kMeshCoverRadius = 0.5;

/// A mesh where it stands, with all that the simulation asks of it.
struct MeshSolid {
    int solid = 0;        ///< index into Scene::solids
    double from = 0.0;    ///< s
    double until = 1e30;  ///< s
    std::string file;     ///< the one that was read: the mesh's or its stand-in's
    TriangleMesh mesh;    ///< m
    MeshColumns columns;
    SurfaceSamples cover;  ///< see kMeshCoverGap
    double secondsToLoad = 0.0, secondsToCover = 0.0;

    bool existsAt(double time) const { return time >= from && time < until; }
};

/// A stretch of a column where sand can be, m.
struct FreeStretch {
    double floor;
    double ceiling;
    /// Parts of the column's area stand at quite other levels, as beside a wall or under the rim of
    /// an overhang: what is true on the column's middle line is not true all over it.
    bool ragged = false;
};

/// Everything rigid in a scene. Made once per run; all queries are const.
class SolidSet {
public:
    /// Reads, places and covers meshes. Throws InputError for solids that cannot be built, for
    /// meshes that are not found or refused.
    explicit SolidSet(const Scene& scene);

    const std::vector<Primitive>& primitives() const { return primitives_; }
    const std::vector<MeshSolid>& meshes() const { return meshes_; }
    /// What was repaired, replaced or looks odd; one sentence each.
    const std::vector<std::string>& notices() const { return notices_; }

    /// Free stretches of the square column about (x, y), ascending; replaces `out`. As
    /// freeIntervals() on its middle line. edge 0: of that line alone.
    void freeStretches(double time, double x, double y, double edge,
                       std::vector<FreeStretch>& out) const;
    /// See blocksPath() of primitive.h.
    bool partsColumns(double time, const Vec2& a, const Vec2& b, double lo, double hi) const;
    /// True for a point below a plane or inside a filled solid.
    bool contains(double time, const Vec3& p) const;
    /// True if a solid appears or vanishes in (from, to].
    bool changesBetween(double from, double to) const;
    /// A box about each mesh.
    std::vector<Eigen::AlignedBox3d> meshBounds() const;

private:
    void freeOnLine(double time, double x, double y,
                    std::vector<std::pair<double, double>>& out) const;
    void addMesh(const Scene& scene, std::size_t solid);

    std::vector<Primitive> primitives_;
    std::vector<MeshSolid> meshes_;
    std::vector<std::string> notices_;
    double smallestGap_, slabThickness_, thinnestSolid_;  ///< m
};

}  // namespace sandflow
