#include "app/run_figures.h"

#include "core/errors.h"
#include "io/frame_row.h"
#include "io/run_folder.h"
#include "measure/run_table.h"

#include <algorithm>

namespace sandflow {
namespace {

constexpr double kAfterLastEmission = 0.5;  // s that still count as busy
constexpr double kPouringWindow = 1.0;      // s
constexpr double kTimeRounding = 1e-9;      // s

/// The columns that are used here; a run of another version may have more.
std::vector<FrameRow> readRows(const std::string& folder)
{
    const RunTable table = RunTable::readRun(RunFolder(folder, FolderUse::read).path());
    std::vector<FrameRow> rows(table.rowCount());
    const auto readCount = [&](const char* name, std::uint64_t FrameRow::*field) {
        const std::vector<double>& values = table.column(name);
        for (std::size_t n = 0; n < rows.size(); ++n) {
            rows[n].*field = static_cast<std::uint64_t>(values[n]);
        }
    };
    const auto readNumber = [&](const char* name, double FrameRow::*field) {
        const std::vector<double>& values = table.column(name);
        for (std::size_t n = 0; n < rows.size(); ++n) {
            rows[n].*field = values[n];
        }
    };
    readNumber("time_s", &FrameRow::time);
    readNumber("wall_s", &FrameRow::wall);
    readNumber("dt_mean_s", &FrameRow::dtMean);
    readCount("steps", &FrameRow::steps);
    readCount("emitted", &FrameRow::emitted);
    readCount("mobile", &FrameRow::mobile);
    readCount("asleep", &FrameRow::asleep);
    readCount("interface", &FrameRow::interface);
    readCount("buried", &FrameRow::buried);
    readCount("exited", &FrameRow::exited);
    return rows;
}

GrainShares sharesOf(const FrameRow& row)
{
    if (row.emitted == 0) {
        return {};
    }
    const auto share = [&row](std::uint64_t count) {
        return static_cast<double>(count) / static_cast<double>(row.emitted);
    };
    return {share(row.mobile), share(row.mobile - std::min(row.asleep, row.mobile)),
            share(row.interface), share(row.buried)};
}

/// Mean over the frames with from < time <= until.
GrainShares meanShares(const std::vector<FrameRow>& rows, double from, double until)
{
    GrainShares sum;
    double frames = 0.0;
    for (const FrameRow& row : rows) {
        if (row.emitted == 0 || row.time <= from + kTimeRounding ||
            row.time > until + kTimeRounding) {
            continue;
        }
        const GrainShares shares = sharesOf(row);
        sum.mobile += shares.mobile, sum.awake += shares.awake;
        sum.interface += shares.interface, sum.buried += shares.buried;
        frames += 1.0;
    }
    if (frames == 0.0) {
        return {};
    }
    return {sum.mobile / frames, sum.awake / frames, sum.interface / frames, sum.buried / frames};
}

/// End of the last frame in which grains came.
double findLastEmission(const std::vector<FrameRow>& rows)
{
    double last = 0.0;
    std::uint64_t emitted = 0;
    for (const FrameRow& row : rows) {
        last = row.emitted > emitted ? row.time : last;
        emitted = row.emitted;
    }
    return last;
}

}  // namespace

RunFigures readRunFigures(const std::string& folder)
{
    const std::vector<FrameRow> rows = readRows(folder);
    if (rows.empty()) {
        throw InputError(fmt::format("{} holds a run without a finished frame", folder));
    }
    RunFigures figures;
    figures.frames = rows.size();
    figures.grains = rows.back().emitted;
    figures.exited = rows.back().exited;
    figures.endTime = rows.back().time;
    figures.lastEmission = findLastEmission(rows);
    figures.atEnd = sharesOf(rows.back());
    figures.pouring = meanShares(rows, figures.lastEmission - kPouringWindow, figures.lastEmission);
    figures.ledgerOk = std::all_of(rows.begin(), rows.end(), [](const FrameRow& row) {
        return row.emitted == row.mobile + row.interface + row.buried + row.exited;
    });

    double busy = 0.0, wall = 0.0, busySteps = 0.0, steps = 0.0, time = 0.0;
    for (const FrameRow& row : rows) {
        const auto count = static_cast<double>(row.steps);
        steps += count;
        time += count * row.dtMean;
        if (row.emitted > 0 && row.time <= figures.lastEmission + kAfterLastEmission) {
            busy += 1.0;
            wall += row.wall;
            busySteps += count;
        }
    }
    figures.wallPerFrame = busy > 0.0 ? wall / busy : 0.0;
    figures.stepsPerFrame = busy > 0.0 ? busySteps / busy : 0.0;
    figures.step = steps > 0.0 ? time / steps : 0.0;
    return figures;
}

}  // namespace sandflow
