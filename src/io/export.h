#pragma once

#include "grains/snapshot.h"

#include <string>
#include <string_view>

namespace sandflow {

enum class ExportFormat {
    csv,  ///< id,x,y,z,radius,vx,vy,vz,state with the state's name
    ply,  ///< binary little-endian PLY, one vertex per grain (state as number)
    vtp   ///< VTK PolyData, XML with ASCII numbers, one vertex per grain (state as number)
};

/// mobile, asleep, interface or buried.
std::string_view nameState(GrainState state);

/// "csv", "ply" or "vtp"; InputError for anything else.
ExportFormat parseExportFormat(std::string_view name);

/// The exported text or bytes: every grain, the buried ones too, in SI units and the simulator's
/// axes (z up). Numbers read back as the same value.
std::string formatSnapshot(const Snapshot& snapshot, ExportFormat format);

/// Writes formatSnapshot to a file, or to the standard output if `path` is "-". Throws SystemError
/// if the disk or the reader of the output refuses it.
void exportSnapshot(const Snapshot& snapshot, ExportFormat format, const std::string& path);

}  // namespace sandflow
