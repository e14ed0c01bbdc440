#include "study/error_plot.h"

#include "study/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// The part of the plane that holds every setting, with room for labels.
struct PlotExtent {
    double lowCost = 1.0, highCost = 1.0;
    double highError = 0.0;
};

PlotExtent findExtent(const ErrorEvaluation& evaluation)
{
    PlotExtent extent;
    for (const SettingFigures& figures : evaluation.settings) {
        if (figures.counts()) {
            extent.lowCost = std::min(extent.lowCost, figures.cost);
            extent.highCost = std::max(extent.highCost, figures.cost);
            extent.highError = std::max(extent.highError, figures.error);
        }
    }
    extent.highError = std::max(extent.highError, evaluation.referenceScatter().value_or(0.0));
    extent.lowCost /= 1.15;
    extent.highCost *= 1.35;
    extent.highError = extent.highError > 0.0 ? 1.12 * extent.highError : 1.0;
    return extent;
}

/// A block of lines "cost error low high "label"" that plots refer to by name.
class DataBlock {
public:
    explicit DataBlock(const std::string& name) : text_("$" + name + " << EOD\n") {}

    void add(const SettingFigures& f, const std::string& label)
    {
        text_ += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {}\n", f.cost, f.error, f.errorLow,
                             f.errorHigh, gnuplotQuoted(label));
        empty_ = false;
    }

    bool empty() const { return empty_; }
    std::string text() const { return text_ + "EOD\n"; }

private:
    std::string text_;
    bool empty_ = true;
};

std::string measureTitle(ErrorMeasure measure)
{
    return measure == ErrorMeasure::radial ? "mean |dH| over annuli, in grain diameters"
                                           : "mean |dH| on cells of 5 d, in grain diameters";
}

std::string plotHead(const ErrorEvaluation& evaluation, const std::string& picture, int width,
                     int height)
{
    const PlotExtent extent = findExtent(evaluation);
    std::string text = fmt::format(
        "set terminal pngcairo size {},{} noenhanced font \"sans,12\" background \"white\"\n"
        "set output {}\n",
        width, height, gnuplotQuoted(picture));
    text += fmt::format("set logscale x 2\nset xrange [{:.4g}:{:.4g}]\nset yrange [0:{:.4g}]\n",
                        extent.lowCost, extent.highCost, extent.highError);
    text += "set xtics (\"1/4\" 0.25, \"1/2\" 0.5, \"1\" 1, \"2\" 2, \"4\" 4, \"8\" 8, \"16\" 16, "
            "\"32\" 32)\n"
            "set grid lc rgb \"#e4e4e4\" lt 1\nset border 3 lc rgb \"#606060\"\n"
            "set tics nomirror textcolor rgb \"#404040\"\n";
    return text;
}

/// Below this line a difference from the reference is what two references differ by.
std::string noiseLine(const ErrorEvaluation& evaluation, const std::string& label)
{
    const auto scatter = evaluation.referenceScatter();
    if (!scatter) {
        return "";
    }
    std::string text = fmt::format(
        "set object 1 rectangle from graph 0, first 0 to graph 1, first {:.4g} behind "
        "fillcolor rgb \"#f3f0e6\" fillstyle solid noborder\n",
        *scatter);
    if (!label.empty()) {
        text += fmt::format(
            "set label 1 {} at graph 0.99, first {:.4g} right front textcolor rgb \"#8a7a3c\"\n",
            gnuplotQuoted(label), 0.5 * *scatter);
    }
    return text;
}

}  // namespace

std::string scriptOfFront(const ErrorEvaluation& evaluation, const std::string& title,
                          const std::string& picture)
{
    DataBlock others("others"), front("front"), shipped("shipped"), knee("knee");
    for (std::size_t k = 0; k < evaluation.settings.size(); ++k) {
        const SettingFigures& figures = evaluation.settings[k];
        if (!figures.counts()) {
            continue;
        }
        if (k == 0) {
            shipped.add(figures, "default");
        } else if (!evaluation.onFront(k)) {
            others.add(figures, labelOf(figures.setting));
        }
    }
    for (const std::size_t k : evaluation.front) {
        front.add(evaluation.settings[k], k == 0 ? "" : labelOf(evaluation.settings[k].setting));
    }
    if (evaluation.knee) {
        knee.add(evaluation.settings[*evaluation.knee], "");
    }
    std::string script = others.text() + front.text() + shipped.text() + knee.text();
    script += plotHead(evaluation, picture, 1200, 760);
    script += noiseLine(evaluation, "two seeds of the reference differ by this");
    script += fmt::format("set title {}\n", gnuplotQuoted(title));
    script += fmt::format(
        "set xlabel \"run time over that of the defaults ({} time)\"\nset ylabel {}\n",
        evaluation.clock == StudyClock::wall ? "wall" : "processor",
        gnuplotQuoted(measureTitle(evaluation.measure)));
    script += "set key top right Left reverse\nplot \\\n";
    if (!others.empty()) {
        script += "  $others with points pt 7 ps 0.9 lc rgb \"#a8b0b8\" title \"one setting "
                  "changed\", \\\n"
                  "  $others using 1:2:5 with labels left offset 0.7,0 font \"sans,8\" "
                  "textcolor rgb \"#8a929a\" notitle, \\\n";
    }
    script += "  $front with steps lw 2 lc rgb \"#1f6fb4\" notitle, \\\n"
              "  $front with points pt 7 ps 1.4 lc rgb \"#1f6fb4\" title \"Pareto front\", \\\n"
              "  $front using 1:2:5 with labels left offset 0.8,0.6 font \"sans,11\" textcolor rgb "
              "\"#14507f\" notitle, \\\n";
    if (!knee.empty()) {
        script +=
            "  $knee with points pt 6 ps 3.2 lw 2 lc rgb \"#1f6fb4\" title \"its knee\", \\\n";
    }
    script += "  $shipped with points pt 9 ps 2.4 lc rgb \"#d0342c\" title \"default\"\n";
    return script;
}

std::string scriptOfSweeps(const ErrorEvaluation& evaluation, const std::string& title,
                           const std::string& picture)
{
    DataBlock all("all"), shipped("shipped");
    struct Panel {
        std::string approximation;
        std::vector<const SettingFigures*> values;
    };
    std::vector<Panel> panels;
    for (const SettingFigures& figures : evaluation.settings) {
        if (!figures.counts()) {
            continue;
        }
        if (&figures == &evaluation.settings.front()) {
            shipped.add(figures, "");
            continue;
        }
        all.add(figures, "");
        if (panels.empty() || panels.back().approximation != figures.setting.approximation) {
            panels.push_back({figures.setting.approximation, {}});
        }
        panels.back().values.push_back(&figures);
    }
    constexpr int kAcross = 4, kWidth = 380, kHeight = 290;
    const int down = (static_cast<int>(panels.size()) + kAcross - 1) / kAcross;
    std::string script = all.text() + shipped.text();
    for (std::size_t p = 0; p < panels.size(); ++p) {
        DataBlock own(fmt::format("sweep{}", p));
        for (const SettingFigures* figures : panels[p].values) {
            own.add(*figures, figures->setting.value);
        }
        script += own.text();
    }
    script += plotHead(evaluation, picture, kAcross * kWidth, down * kHeight + 60);
    script += noiseLine(evaluation, "");
    script += fmt::format("set multiplot layout {},{} title {} font \"sans,14\"\nunset key\n", down,
                          kAcross, gnuplotQuoted(title));
    for (std::size_t p = 0; p < panels.size(); ++p) {
        script += fmt::format(
            "set title {0}\nplot $all with points pt 7 ps 0.5 lc rgb \"#d0d4d8\", \\\n"
            "  $sweep{1} using 1:2:3:4 with yerrorbars pt 7 ps 1.1 lc rgb \"#1f6fb4\", \\\n"
            "  $sweep{1} using 1:2:5 with labels left offset 0.8,0.4 font \"sans,10\" "
            "textcolor rgb \"#14507f\", \\\n"
            "  $shipped using 1:2 with points pt 9 ps 1.8 lc rgb \"#d0342c\"\n",
            gnuplotQuoted(panels[p].approximation), p);
    }
    return script + "unset multiplot\n";
}

}  // namespace sandflow
