#include "io/frame_log.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/number_text.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>
#include <variant>

namespace sandflow {
namespace {

struct Column {
    std::string_view name;
    std::variant<std::uint64_t FrameRow::*, double FrameRow::*> field;
};

/// The one place that ties columns to members: header, writer and reader all follow it.
constexpr std::array kColumns{
    Column{"frame", &FrameRow::frame},
    Column{"time_s", &FrameRow::time},
    Column{"wall_s", &FrameRow::wall},
    Column{"steps", &FrameRow::steps},
    Column{"dt_min_s", &FrameRow::dtMin},
    Column{"dt_mean_s", &FrameRow::dtMean},
    Column{"emitted", &FrameRow::emitted},
    Column{"mobile", &FrameRow::mobile},
    Column{"asleep", &FrameRow::asleep},
    Column{"interface", &FrameRow::interface},
    Column{"buried", &FrameRow::buried},
    Column{"exited", &FrameRow::exited},
    Column{"exported", &FrameRow::exported},
    Column{"max_overlap_r", &FrameRow::maxOverlap},
    Column{"kinetic_energy_j", &FrameRow::kineticEnergy},
    Column{"t_surface_flow_s", &FrameRow::surfaceFlowTime},
    Column{"t_transfer_s", &FrameRow::transferTime},
    Column{"t_rebuild_s", &FrameRow::rebuildTime},
    Column{"t_forces_s", &FrameRow::forcesTime},
    Column{"t_emit_s", &FrameRow::emitTime},
    Column{"t_output_s", &FrameRow::outputTime},
};

std::string formatRow(const FrameRow& row)
{
    std::string line;
    for (const Column& column : kColumns) {
        if (!line.empty()) {
            line += ',';
        }
        std::visit([&](auto field) { appendNumber(line, row.*field); }, column.field);
    }
    return line + '\n';
}

/// Reads one row; false if it has another number of fields or one that is no number.
bool parseRow(std::string_view line, FrameRow& row)
{
    const char* at = line.data();
    const char* const end = at + line.size();
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
        if (i > 0) {
            if (at == end || *at != ',') {
                return false;
            }
            ++at;
        }
        const auto result =
            std::visit([&](auto field) { return std::from_chars(at, end, row.*field); },
                       kColumns[i].field);
        if (result.ec != std::errc{}) {
            return false;
        }
        at = result.ptr;
    }
    return at == end;
}

}  // namespace

std::string frameLogHeader()
{
    std::string header;
    for (const Column& column : kColumns) {
        if (!header.empty()) {
            header += ',';
        }
        header += column.name;
    }
    return header;
}

std::vector<FrameRow> readFrameLog(const std::string& path)
{
    const std::string content = readWholeFile(path);
    std::vector<FrameRow> rows;
    std::string_view rest = content;
    for (std::size_t number = 1;; ++number) {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) {
            if (number == 1) {
                throw InputError(fmt::format("{} is not a frame log: it has no header", path));
            }
            return rows;
        }
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        if (number == 1) {
            if (line != frameLogHeader()) {
                throw InputError(
                    fmt::format("{} is not a frame log of this version: its columns differ", path));
            }
            continue;
        }
        FrameRow row;
        if (!parseRow(line, row)) {
            throw InputError(fmt::format("{}:{}: not a row of {} numbers", path, number,
                                         kColumns.size()));
        }
        rows.push_back(row);
    }
}

FrameLog::FrameLog(const std::string& path, std::optional<std::uint64_t> keepUpTo) : path_(path)
{
    std::string content = frameLogHeader() + '\n';
    if (keepUpTo) {
        for (const FrameRow& row : readFrameLog(path)) {
            if (row.frame <= *keepUpTo) {
                content += formatRow(row);
            }
        }
    }
    writeFileAtomically(path, content);
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) {
        throw SystemError(fmt::format("cannot open {}: {}", path,
                                      std::generic_category().message(errno)));
    }
}

FrameLog::~FrameLog()
{
    ::close(descriptor_);
}

void FrameLog::append(const FrameRow& row)
{
    if (!writeAllBytes(descriptor_, formatRow(row))) {
        throw SystemError(fmt::format("cannot write {}: {}", path_,
                                      std::generic_category().message(errno)));
    }
}

}  // namespace sandflow
