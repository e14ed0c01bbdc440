#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace sandflow {

/// Far beyond any scene, in mean grain radii, and small enough that scaled values fit 64 bits.
inline constexpr double kFarthestDecimal = 1e12;
/// What the longest decimal takes: a sign, twelve digits, the point and the decimals.
inline constexpr std::size_t kLongestDecimal = 18;

inline bool isDrawable(double value)
{
    return std::abs(value) < kFarthestDecimal;  // false for NaN
}

/// Writes a drawable value with at most that many decimals, without trailing zeros and never as
/// "-0"; returns the end. A scaled integer, because that is several times faster than printing a
/// double.
template <int Decimals>
char* putDecimal(char* out, double value)
{
    static_assert(Decimals > 0 && Decimals <= 4);
    constexpr std::int64_t scale = Decimals == 1 ? 10 : Decimals == 2 ? 100 : Decimals == 3 ? 1000
                                                                                           : 10000;
    std::int64_t scaled = std::llround(value * static_cast<double>(scale));
    if (scaled < 0) {
        *out++ = '-';
        scaled = -scaled;
    }
    const std::int64_t whole = scaled / scale;
    auto fraction = static_cast<int>(scaled % scale);
    if (whole > 0 || fraction == 0) {
        out = std::to_chars(out, out + 16, whole).ptr;
    }
    if (fraction > 0) {
        *out++ = '.';
        for (int unit = static_cast<int>(scale) / 10; fraction > 0; unit /= 10) {
            *out++ = static_cast<char>('0' + fraction / unit);
            fraction %= unit;
        }
    }
    return out;
}

inline char* putLiteral(char* out, std::string_view text)
{
    return out + text.copy(out, text.size());
}

}  // namespace sandflow
