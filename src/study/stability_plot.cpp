#include "study/gnuplot.h"
#include "study/stability_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// Bounds of what is drawn; what lies beyond is drawn on them.
constexpr double kLowest = 1e-3, kHighest = 1e2;
/// Where a refused run stands, which has no error.
constexpr double kRefusedAt = 1.5e-3;

constexpr int kColumnsOfPlots = 4;

struct Look {
    Verdict verdict;
    const char* colour;
};
constexpr Look kLooks[] = {{Verdict::sound, "#2a9d3a"},
                           {Verdict::refused, "#888888"},
                           {Verdict::wrongShape, "#e07b00"},
                           {Verdict::jitters, "#8e44ad"},
                           {Verdict::broke, "#d01c1c"}};

double heightOf(const Finding& finding)
{
    if (finding.decisive.measure.empty()) {
        return finding.verdict == Verdict::broke ? kHighest : kRefusedAt;
    }
    const double share = finding.decisive.error / finding.decisive.limit;
    return std::isfinite(share) ? std::clamp(share, kLowest, kHighest) : kHighest;
}

bool isDem(const Finding& finding)
{
    return finding.mode.rfind("dem", 0) == 0;
}

/// Families whose values span more than a decade are drawn over a logarithmic axis.
bool isWide(const std::vector<Finding>& family)
{
    double low = 1e30, high = -1e30;
    for (const Finding& f : family) {
        low = std::min(low, f.value);
        high = std::max(high, f.value);
    }
    return low > 0.0 && high / low > 12.0;
}

/// dem on the left of its value and surface-flow on the right, so that neither hides the other.
double placeOf(const Finding& finding, bool wide, double span)
{
    const double side = isDem(finding) ? -1.0 : 1.0;
    return wide ? finding.value * std::pow(1.03, side) : finding.value + 0.008 * span * side;
}

std::string plotFamily(const std::vector<Finding>& family)
{
    const auto [low, high] = std::minmax_element(
        family.begin(), family.end(),
        [](const Finding& a, const Finding& b) { return a.value < b.value; });
    const double span = std::max(high->value - low->value, 1e-9);
    const bool wide = isWide(family);

    std::string text;
    std::string curves = "1 with lines dashtype 2 linecolor '#444444' notitle";
    for (const bool dem : {true, false}) {
        for (const Look& look : kLooks) {
            std::string points;
            for (const Finding& f : family) {
                if (isDem(f) == dem && f.verdict == look.verdict) {
                    points += fmt::format("{:.6g} {:.6g}\n", placeOf(f, wide, span), heightOf(f));
                }
            }
            if (points.empty()) {
                continue;
            }
            const std::string name = fmt::format("$p{}{}", dem ? "d" : "s",
                                                 static_cast<int>(look.verdict));
            text += fmt::format("{} << EOD\n{}EOD\n", name, points);
            curves += fmt::format(", {} with points pointtype {} pointsize 1.3 linewidth 2 linecolor '{}' notitle",
                                  name, dem ? 6 : 9, look.colour);
        }
    }
    text += fmt::format("set title {}\nset xlabel {}\n", gnuplotQuoted(family.front().family),
                        gnuplotQuoted(family.front().parameter));
    const double margin = span > 1e-6 ? 0.1 * span : 1.0;
    text += wide ? fmt::format("set logscale x\nset format x '%.4g'\nset xrange [{:.6g}:{:.6g}]\n",
                               low->value / 1.6, high->value * 1.6)
                 : fmt::format("unset logscale x\nset format x '%.4g'\nset xrange [{:.6g}:{:.6g}]\n",
                               low->value - margin, high->value + margin);
    return text + "plot " + curves + "\n\n";
}

/// What colours and marks mean, in a panel of its own.
std::string plotLegend()
{
    std::string text =
        "unset logscale\nset xrange [0:1]\nset yrange [0:1]\nunset tics\nunset border\n"
        "set title ''\nset xlabel ''\nset ylabel ''\nset key center center spacing 1.6 samplen 1\n"
        "plot 1/0 with points pointtype 6 pointsize 1.3 linewidth 2 linecolor '#444444' title 'dem', "
        "1/0 with points pointtype 9 pointsize 1.3 linewidth 2 linecolor '#444444' title 'surface-flow', "
        "1/0 with lines dashtype 2 linecolor '#444444' title 'what is allowed'";
    for (const Look& look : kLooks) {
        text += fmt::format(", 1/0 with points pointtype 5 pointsize 1.6 linecolor '{}' title '{}'",
                            look.colour, nameOf(look.verdict));
    }
    return text + "\n";
}

}  // namespace

std::string makeStabilityPlot(const std::vector<Finding>& findings, const std::string& title,
                              const std::string& png)
{
    std::vector<std::vector<Finding>> families;
    for (const Finding& f : findings) {
        if (families.empty() || families.back().front().family != f.family) {
            families.emplace_back();
        }
        families.back().push_back(f);
    }
    const int rows = (static_cast<int>(families.size()) + kColumnsOfPlots) / kColumnsOfPlots;
    std::string text = fmt::format(
        "set terminal pngcairo size {},{} font 'sans,11'\nset output {}\n"
        "set multiplot layout {},{} title {} font ',15'\n"
        "unset key\nset grid linecolor '#dddddd'\nset logscale y\nset yrange [{}:{}]\n"
        "set format y '10^{{%L}}'\nset ylabel 'error / what is allowed'\n\n",
        420 * kColumnsOfPlots, 60 + 320 * rows, gnuplotQuoted(png), rows, kColumnsOfPlots,
        gnuplotQuoted(title), 0.6 * kLowest, 2.0 * kHighest);
    for (const std::vector<Finding>& family : families) {
        text += plotFamily(family);
    }
    return text + plotLegend() + "unset multiplot\n";
}

}  // namespace sandflow
