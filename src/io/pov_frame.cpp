#include "io/pov_frame.h"

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/snapshot_check.h"

#include <charconv>
#include <cmath>
#include <vector>

namespace sandflow {
namespace {

/// Lengths are written in thousandths of the mean radius: at video size a coarser grid would
/// shimmer when grains creep, a finer one could not be seen.
constexpr double kThousandths = 1000.0;
/// Far beyond any scene, and small enough that the thousandths fit 64 bits.
constexpr double kFarthest = 1e12;
/// "sphere{<,,>,}\n" and four numbers of at most 17 characters.
constexpr std::size_t kLongestSphere = 14 + 4 * 17;

/// Writes value with at most three decimals, without trailing zeros and never as "-0"; returns the
/// end. A scaled integer, because that is several times faster than printing a double.
char* putDecimal(char* out, double value, std::uint32_t id)
{
    // The negation also catches NaN.
    if (!(std::abs(value) < kFarthest)) {
        throw InternalError(fmt::format(
            "grain {} cannot be drawn: a coordinate or its radius is {} mean radii", id, value));
    }
    std::int64_t scaled = std::llround(value * kThousandths);
    if (scaled < 0) {
        *out++ = '-';
        scaled = -scaled;
    }
    const std::int64_t whole = scaled / 1000;
    const auto fraction = static_cast<int>(scaled % 1000);
    if (whole > 0 || fraction == 0) {
        out = std::to_chars(out, out + 16, whole).ptr;
    }
    if (fraction > 0) {
        *out++ = '.';
        *out++ = static_cast<char>('0' + fraction / 100);
        if (fraction % 100 > 0) {
            *out++ = static_cast<char>('0' + fraction / 10 % 10);
            if (fraction % 10 > 0) {
                *out++ = static_cast<char>('0' + fraction % 10);
            }
        }
    }
    return out;
}

char* putLiteral(char* out, std::string_view text)
{
    return out + text.copy(out, text.size());
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
        if (snapshot.state[i] == GrainState::buried && !options.allGrains) {
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
            out = putDecimal(out, position.x() * scale, id);
            *out++ = ',';
            out = putDecimal(out, position.z() * scale, id);
            *out++ = ',';
            out = putDecimal(out, position.y() * scale, id);
            out = putLiteral(out, ">,");
            out = putDecimal(out, static_cast<double>(snapshot.radius[i]) * scale, id);
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
