#include "mesh/clean_mesh.h"

#include "mesh/drop_faces.h"
#include "mesh/mesh_orientation.h"
#include "mesh/mesh_topology.h"
#include "mesh/refuse_mesh.h"
#include "mesh/weld_points.h"

#include <algorithm>

namespace sandflow {
namespace {

/// In diagonals of the bounding box. Single precision resolves 1e-7 of a coordinate: points this
/// near are one point that was computed twice.
constexpr double kWeldTolerance = 1e-6;
/// In diagonals: the height below which a triangle is flat, for the same reason.
constexpr double kFlatTolerance = 1e-7;

/// A sentence if anything was done.
void tell(std::size_t count, const char* verb, const char* what, std::vector<std::string>& repairs)
{
    if (count > 0) {
        repairs.push_back(fmt::format("{} {} {}", verb, count, what));
    }
}

double checkedDiagonal(const TriangleMesh& mesh, const std::string& file)
{
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (!mesh.points[i].allFinite()) {
            refuseMesh(file, "vertex {} is not finite; repair the file", i);
        }
    }
    const double diagonal = mesh.triangles.empty() ? 0.0 : boundsOf(mesh).diagonal().norm();
    // Volumes of smaller and larger ones leave the range of double.
    constexpr double kSmallest = 1e-60;
    constexpr double kLargest = 1e60;
    if (!(diagonal >= kSmallest && diagonal <= kLargest)) {
        refuseMesh(file, "all its {} triangles together span {} units; export a surface",
                   mesh.triangles.size(), diagonal);
    }
    return diagonal;
}

void fillReport(const TriangleMesh& mesh, MeshReport& report)
{
    const MeshEdges edges = findEdges(mesh);
    const MeshComponents components = findComponents(mesh);
    report.points = mesh.points.size();
    report.triangles = mesh.triangles.size();
    report.components = components.count;
    for (const MeshEdge& edge : edges.edges) {
        report.boundaryEdges += edge.sides() == 1 ? 1 : 0;
        report.nonManifoldEdges += edge.sides() > 2 ? 1 : 0;
        report.unbalancedEdges += edge.forward != edge.backward ? 1 : 0;
    }
    const std::vector<double> holes = findHoles(mesh, edges, components);
    report.largestHole = *std::max_element(holes.begin(), holes.end());
    report.signedVolume = signedVolumeOf(mesh);
    report.bounds = boundsOf(mesh);
}

}  // namespace

MeshReport cleanMesh(TriangleMesh& mesh, const std::string& file)
{
    const double diagonal = checkedDiagonal(mesh, file);
    MeshReport report;
    std::vector<std::string>& repairs = report.repairs;

    // Points that no triangle uses in the file, not those that welding and dropping leave.
    tell(dropUnusedPoints(mesh), "dropped", "points that no face uses", repairs);
    // Where no triangle shares a point with another that is the way of the format, no defect.
    const bool shares = mesh.points.size() < 3 * mesh.triangles.size();
    const std::size_t welded = weldPoints(kWeldTolerance * diagonal, mesh);
    tell(shares ? welded : 0, "welded", "points that lie on others", repairs);
    tell(dropCollapsed(mesh), "dropped", "faces with the same point at two corners", repairs);
    tell(dropRepeated(mesh), "dropped", "faces that are there twice", repairs);
    tell(dropFlat(kFlatTolerance * diagonal, mesh), "dropped", "faces without area", repairs);
    if (mesh.triangles.empty()) {
        refuseMesh(file, "no face with an area is left of it; export a surface");
    }
    tell(dropBackFaces(mesh), "dropped",
         "back faces: every face is there once each way round, so nothing would be inside",
         repairs);
    dropUnusedPoints(mesh);

    tell(alignNeighbours(mesh), "turned round",
         "faces that look the other way than their neighbours", repairs);
    const TurnedParts parts = turnInsideOut(mesh);
    tell(parts.turned, "turned round", "components that were inside out", repairs);
    if (!parts.complete) {
        repairs.push_back(
            "did not look for components that are inside out, because there are too many");
    }
    fillReport(mesh, report);
    return report;
}

}  // namespace sandflow
