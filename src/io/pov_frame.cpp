#include "io/pov_frame.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/pov_decimal.h"
#include "io/snapshot_check.h"

#include <charconv>
#include <cmath>
#include <vector>

namespace sandflow {
namespace {

/// Lengths are written in thousandths of the mean radius: at video size a coarser grid would
/// shimmer when grains creep, a finer one could not be seen.
constexpr int kDecimals = 3;
/// "sphere{<,,>,}\n" and its four numbers.
constexpr std::size_t kLongestSphere = 14 + 4 * kLongestDecimal;

char* putLength(char* out, double value, std::uint32_t id)
{
    if (!isDrawable(value)) {
        throw InternalError(fmt::format(
            "grain {} cannot be drawn: a coordinate or its radius is {} mean radii", id, value));
    }
    return putDecimal<kDecimals>(out, value);
}

}  // namespace

int chooseColourFamily(std::uint32_t id)
{
    // Multiply-and-shift mixing; neighbouring ids leave an emitter together and must not share a
    // colour.
    std::uint32_t hash = id ^ (id >> 16);
    hash *= 0x7feb352dU;
    hash ^= hash >> 15;
    hash *= 0x846ca68bU;
    hash ^= hash >> 16;
    return static_cast<int>(hash % kColourFamilies);
}

std::string formatPovFrame(const Snapshot& snapshot, const PovFrameOptions& options,
                           std::uint64_t* exported)
{
    checkSnapshot(snapshot);
    SAND_CHECK(snapshot.meanRadius > 0.0 && std::isfinite(snapshot.meanRadius),
               "the mean radius is {}", snapshot.meanRadius);
    const bool byFamily = options.colourBy == GrainColour::family;
    std::vector<std::vector<std::uint32_t>> members(byFamily ? kColourFamilies : 4);
    std::size_t count = 0;
    for (std::size_t i = 0; i < snapshot.size(); ++i) {
        if (snapshot.state[i] == GrainState::buried && !options.allGrains &&
            !(options.isSeen && options.isSeen(snapshot.position[i]))) {
            continue;
        }
        const int colour = byFamily ? chooseColourFamily(snapshot.id[i])
                                    : static_cast<int>(snapshot.state[i]);
        members[static_cast<std::size_t>(colour)].push_back(static_cast<std::uint32_t>(i));
        ++count;
    }
    if (exported != nullptr) {
        *exported = count;
    }

    std::string text =
        fmt::format("// frame {}, {} grains, lengths in mean grain radii\n", snapshot.frame, count);
    std::size_t used = text.size();
    const double scale = 1.0 / snapshot.meanRadius;
    for (std::size_t colour = 0; colour < members.size(); ++colour) {
        if (members[colour].empty()) {
            continue;  // POV-Ray warns about a union of nothing
        }
        // Room for the longest text; what is left over is used by the next union.
        text.resize(used + members[colour].size() * kLongestSphere + 64);
        // POV-Ray warns about a union of one.
        char* out = putLiteral(text.data() + used,
                               members[colour].size() > 1 ? "union{\n" : "object{\n");
        for (std::uint32_t i : members[colour]) {
            const Vec3& position = snapshot.position[i];
            const std::uint32_t id = snapshot.id[i];
            out = putLiteral(out, "sphere{<");
            out = putLength(out, position.x() * scale, id);
            *out++ = ',';
            out = putLength(out, position.z() * scale, id);
            *out++ = ',';
            out = putLength(out, position.y() * scale, id);
            out = putLiteral(out, ">,");
            out = putLength(out, static_cast<double>(snapshot.radius[i]) * scale, id);
            out = putLiteral(out, "}\n");
        }
        out = putLiteral(out, byFamily ? "GrainTexture(" : "StateTexture(");
        out = std::to_chars(out, out + 4, colour).ptr;
        out = putLiteral(out, ")}\n");
        used = static_cast<std::size_t>(out - text.data());
    }
    text.resize(used);
    return text;
}

std::uint64_t writePovFrame(const std::string& path, const Snapshot& snapshot,
                            const PovFrameOptions& options)
{
    std::uint64_t exported = 0;
    writeFileAtomically(path, formatPovFrame(snapshot, options, &exported));
    return exported;
}

}  // namespace sandflow
