#pragma once

#include "app/mesh_figures.h"
#include "io/frame_row.h"
#include "io/json_writer.h"
#include "measure/release.h"
#include "solver/simulation.h"

#include <optional>
#include <string>

namespace sandflow {

/// Folder of the hand-written POV-Ray files: SANDFLOW_POVRAY_PATH, else where the program was built
/// from. Throws InputError if it is not there.
std::string findPovrayFolder();

/// Gathers what summary.json and the closing lines of a run say.
class RunSummary {
public:
    RunSummary(const Scene& scene, const RunPlan& plan) : scene_(scene), plan_(plan) {}

    void add(const FrameReport& report, const FrameRow& row);
    /// Grain centres inside solids at the end of a frame.
    void addLeaks(std::uint64_t leaks) { leaks_ += leaks; }
    /// All there is to say of a release after that, but for leaks.
    void addRelease(const ReleaseFigures& release) { release_ = release; }
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
    std::optional<ReleaseFigures> release_;
    std::vector<MeshFigures> meshes_;

    double meanWall() const;
    std::optional<double> trappedShare() const;
};

}  // namespace sandflow
