#pragma once

#include "mesh/clean_copy.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

/// The gates: strict readers, one per format. Each refuses with InputError what is malformed or
/// names geometry that the simulator cannot hold, and makes the clean copy of the rest. `file` is
/// the name for messages. Time and memory are proportional to the size of the file, whatever counts
/// it declares.
namespace sandflow {

/// Stanford polygon files, ascii and binary of either byte order: a vertex element with x y z, then
/// a face element with one list of indices. Other properties, and elements behind the faces, are
/// skipped.
CleanCopy passPly(std::string_view bytes, const std::string& file);

/// Wavefront objects: v and f count; groups, materials, normals and the like are skipped.
CleanCopy passObj(std::string_view bytes, const std::string& file);

/// Geomview OFF in text, with or without colours, normals and texture coordinates.
CleanCopy passOff(std::string_view bytes, const std::string& file);

/// Stereolithography, text or binary.
CleanCopy passStl(std::string_view bytes, const std::string& file);

/// Reads a file named in a glTF file; nothing if there is none or it may not be read.
using ReadSibling = std::function<std::optional<std::string>(const std::string& name)>;

/// glTF 2.0 as text or as GLB: the nodes of its scene with their triangles.
CleanCopy passGltf(std::string_view bytes, const std::string& file, const ReadSibling& read);

}  // namespace sandflow
