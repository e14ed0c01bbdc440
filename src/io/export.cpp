#include "io/export.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/snapshot_check.h"

#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace sandflow {
namespace {

template <typename Vector>
void appendVector(std::string& text, const Vector& vector, char separator)
{
    appendNumber(text, vector.x());
    text += separator;
    appendNumber(text, vector.y());
    text += separator;
    appendNumber(text, vector.z());
}

std::string formatCsv(const Snapshot& snapshot)
{
    std::string text = "id,x,y,z,radius,vx,vy,vz,state\n";
    for (std::size_t i = 0; i < snapshot.size(); ++i) {
        appendNumber(text, snapshot.id[i]);
        text += ',';
        appendVector(text, snapshot.position[i], ',');
        text += ',';
        appendNumber(text, snapshot.radius[i]);
        text += ',';
        appendVector(text, snapshot.velocity[i], ',');
        text += ',';
        text += nameState(snapshot.state[i]);
        text += '\n';
    }
    return text;
}

template <typename T>
void appendBytes(std::string& bytes, T number)
{
    char buffer[sizeof number];
    std::memcpy(buffer, &number, sizeof number);
    bytes.append(buffer, sizeof number);
}

std::string formatPly(const Snapshot& snapshot)
{
    // PLY lets the file name its byte order, so the machine's own will do.
    constexpr std::string_view order =
        std::endian::native == std::endian::little ? "little" : "big";
    std::string bytes = fmt::format(
        "ply\nformat binary_{}_endian 1.0\ncomment sandflow, frame {}, metres and seconds, z up\n"
        "comment state: 0 mobile, 1 asleep, 2 interface, 3 buried\nelement vertex {}\n"
        "property double x\nproperty double y\nproperty double z\nproperty float radius\n"
        "property float vx\nproperty float vy\nproperty float vz\nproperty uint id\n"
        "property uchar state\nend_header\n",
        order, snapshot.frame, snapshot.size());
    bytes.reserve(bytes.size() + 45 * snapshot.size());
    for (std::size_t i = 0; i < snapshot.size(); ++i) {
        for (double coordinate : snapshot.position[i]) {
            appendBytes(bytes, coordinate);
        }
        appendBytes(bytes, snapshot.radius[i]);
        for (float component : snapshot.velocity[i]) {
            appendBytes(bytes, component);
        }
        appendBytes(bytes, snapshot.id[i]);
        appendBytes(bytes, static_cast<std::uint8_t>(snapshot.state[i]));
    }
    return bytes;
}

/// One <DataArray>; `append(i)` adds the text of grain i.
template <typename Append>
void appendArray(std::string& text, std::string_view attributes, std::size_t count, Append append)
{
    text += fmt::format("<DataArray {} format=\"ascii\">\n", attributes);
    for (std::size_t i = 0; i < count; ++i) {
        append(i);
        text += '\n';
    }
    text += "</DataArray>\n";
}

std::string formatVtp(const Snapshot& snapshot)
{
    const std::size_t n = snapshot.size();
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" "
        "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"state\">\n",
        n);
    appendArray(text, "type=\"UInt32\" Name=\"id\"", n,
                [&](std::size_t i) { appendNumber(text, snapshot.id[i]); });
    appendArray(text, "type=\"Float32\" Name=\"radius\"", n,
                [&](std::size_t i) { appendNumber(text, snapshot.radius[i]); });
    appendArray(text, "type=\"Float32\" Name=\"velocity\" NumberOfComponents=\"3\"", n,
                [&](std::size_t i) { appendVector(text, snapshot.velocity[i], ' '); });
    appendArray(text, "type=\"UInt8\" Name=\"state\"", n, [&](std::size_t i) {
        appendNumber(text, static_cast<unsigned>(snapshot.state[i]));
    });
    text += "</PointData>\n<Points>\n";
    appendArray(text, "type=\"Float64\" NumberOfComponents=\"3\"", n,
                [&](std::size_t i) { appendVector(text, snapshot.position[i], ' '); });
    text += "</Points>\n<Verts>\n";
    appendArray(text, "type=\"Int64\" Name=\"connectivity\"", n,
                [&](std::size_t i) { appendNumber(text, i); });
    appendArray(text, "type=\"Int64\" Name=\"offsets\"", n,
                [&](std::size_t i) { appendNumber(text, i + 1); });
    return text + "</Verts>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace

std::string_view nameState(GrainState state)
{
    switch (state) {
        case GrainState::mobile: return "mobile";
        case GrainState::asleep: return "asleep";
        case GrainState::interface: return "interface";
        case GrainState::buried: return "buried";
    }
    throw InternalError(fmt::format("no grain state has the number {}", static_cast<int>(state)));
}

ExportFormat parseExportFormat(std::string_view name)
{
    if (name == "csv") {
        return ExportFormat::csv;
    }
    if (name == "ply") {
        return ExportFormat::ply;
    }
    if (name == "vtp") {
        return ExportFormat::vtp;
    }
    throw InputError(fmt::format("unknown export format \"{}\": use csv, ply or vtp", name));
}

std::string formatSnapshot(const Snapshot& snapshot, ExportFormat format)
{
    checkSnapshot(snapshot);
    switch (format) {
        case ExportFormat::csv: return formatCsv(snapshot);
        case ExportFormat::ply: return formatPly(snapshot);
        case ExportFormat::vtp: return formatVtp(snapshot);
    }
    throw InternalError("no such export format");
}

void exportSnapshot(const Snapshot& snapshot, ExportFormat format, const std::string& path)
{
    const std::string content = formatSnapshot(snapshot, format);
    if (path != "-") {
        writeFileAtomically(path, content);
    } else if (!writeAllBytes(STDOUT_FILENO, content)) {
        throw SystemError(fmt::format("cannot write to the standard output: {}",
                                      std::generic_category().message(errno)));
    }
}

}  // namespace sandflow
