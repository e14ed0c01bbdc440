#pragma once

#include "app/mesh_figures.h"
#include "io/frame_row.h"
#include "io/json_writer.h"
#include "solver/simulation.h"

#include <string>

namespace sandflow {

/// Folder of the hand-written POV-Ray files: SANDFLOW_POVRAY_PATH, else where the program was built
/// from. Throws InputError if it is not there.
std::string findPovrayFolder();

/// Gathers what summary.json and the closing lines of a run say.
class RunSummary {
public:
    RunSummary(const Scene& scene, const RunPlan& plan) : scene_(scene), plan_(plan) {}

    /// leaks: grain centres inside solids at the end of the frame.
    void add(const FrameReport& report, std::uint64_t leaks);
    void addWall(const FrameRow& row);
    void finish(const Simulation& sand, const Snapshot& last);

    JsonWriter json() const;
    std::string text() const;

private:
    const Scene& scene_;
    const RunPlan& plan_;
    std::vector<FrameReport> reports_;
    std::vector<FrameRow> rows_;
    TransferReport transfer_;
    std::uint64_t leaks_ = 0, hash_ = 0;
    std::size_t bytesMobile_ = 0, bytesBuried_ = 0, bytesCover_ = 0;
    double apex_ = 0, r90_ = 0;
    std::optional<double> repose_;
    std::vector<MeshFigures> meshes_;

    double meanWall() const;
};

}  // namespace sandflow
