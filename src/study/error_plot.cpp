#include "study/error_plot.h"

#include "study/gnuplot.h"
#include "study/plot_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

constexpr int kFrontWidth = 1200, kFrontHeight = 760;  // pixels

/// The part of the plane that holds every setting, with room for labels.
struct PlotExtent {
    double lowCost = 1.0, highCost = 1.0;
    double highError = 0.0;
};

PlotExtent findExtent(const ErrorEvaluation& evaluation, bool withBars)
{
    PlotExtent extent;
    for (const SettingFigures& figures : evaluation.settings) {
        if (figures.counts()) {
            extent.lowCost = std::min(extent.lowCost, figures.cost);
            extent.highCost = std::max(extent.highCost, figures.cost);
            extent.highError =
                std::max(extent.highError, withBars ? figures.errorHigh : figures.error);
        }
    }
    extent.highError = std::max(extent.highError, evaluation.referenceScatter().value_or(0.0));
    extent.lowCost /= 1.4;
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

std::string plotHead(const PlotExtent& extent, const std::string& picture, int width, int height)
{
    std::string text = fmt::format(
        "set terminal pngcairo size {},{} noenhanced font \"sans,12\" background \"white\"\n"
        "set output {}\n",
        width, height, gnuplotQuoted(picture));
    text += fmt::format("set logscale x 2\nset xrange [{:.4g}:{:.4g}]\nset yrange [0:{:.4g}]\n",
                        extent.lowCost, extent.highCost, extent.highError);
    text += "set xtics (0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 2.8, 4, 5.6, 8, 11, 16, 22, 32)\n"
            "set grid lc rgb \"#e4e4e4\" lt 1\nset border 3 lc rgb \"#606060\"\n"
            "set tics nomirror textcolor rgb \"#404040\"\n";
    return text;
}

/// Shades the errors that two references have against each other.
std::string noiseBand(const ErrorEvaluation& evaluation, const std::string& label)
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

/// A frame round the default: what lies inside differs from it by no more than chance explains.
std::string chanceBox(const ErrorEvaluation& evaluation)
{
    if (!evaluation.noise) {
        return "";
    }
    const SettingFigures& shipped = evaluation.settings.front();
    const double factor = std::exp(evaluation.noise->logCost);
    const double lowest = std::max(0.0, shipped.error - evaluation.noise->error);
    return fmt::format("set object 2 rectangle from {:.4g},{:.4g} to {:.4g},{:.4g} front "
                       "fillstyle empty border lc rgb \"#d0342c\" dt 2\n",
                       shipped.cost / factor, lowest, shipped.cost * factor,
                       shipped.error + evaluation.noise->error);
}

/// The settings' names in the order given, empty where there is no room for one.
std::vector<std::string> nameWherePossible(const ErrorEvaluation& evaluation,
                                           const std::vector<std::size_t>& order)
{
    constexpr double kLetterWidth = 6.5, kLetterHeight = 13.0;  // pixels
    const PlotExtent extent = findExtent(evaluation, false);
    const double perLogCost = 0.9 * kFrontWidth / std::log(extent.highCost / extent.lowCost);
    const double perError = 0.85 * kFrontHeight / extent.highError;
    std::vector<PlotLabel> labels;
    for (const std::size_t k : order) {
        const SettingFigures& figures = evaluation.settings[k];
        labels.push_back({perLogCost * std::log(figures.cost) / kLetterWidth,
                          perError * figures.error / kLetterHeight,
                          k == 0 ? "" : labelOf(figures.setting), evaluation.onFront(k)});
    }
    const std::vector<bool> chosen = chooseLabels(labels);
    std::vector<std::string> names;
    for (std::size_t n = 0; n < order.size(); ++n) {
        names.push_back(chosen[n] ? labels[n].text : "");
    }
    return names;
}

/// One approximation.
struct SweepPanel {
    std::string approximation;
    std::string without;  ///< values that did the same as the default
    std::vector<const SettingFigures*> values;  ///< the others
};

std::vector<SweepPanel> makePanels(const ErrorEvaluation& evaluation)
{
    std::vector<SweepPanel> panels;
    for (std::size_t k = 1; k < evaluation.settings.size(); ++k) {
        const SettingFigures& figures = evaluation.settings[k];
        if (panels.empty() || panels.back().approximation != figures.setting.approximation) {
            panels.push_back({figures.setting.approximation, "", {}});
        }
        SweepPanel& panel = panels.back();
        if (figures.sameAsDefault) {
            panel.without += (panel.without.empty() ? "" : ", ") + figures.setting.value;
        } else if (figures.counts()) {
            panel.values.push_back(&figures);
        }
    }
    return panels;
}

/// Its values with their names, to the left of the cheaper ones: away from the default's mark.
std::string scriptOfPanel(const SweepPanel& panel)
{
    std::string plots;
    DataBlock right("right"), left("left");
    for (const SettingFigures* figures : panel.values) {
        (figures->cost > 1.0 ? right : left).add(*figures, figures->setting.value);
    }
    const auto add = [&plots](const char* block, const char* place) {
        plots += fmt::format("  ${0} using 1:2:3:4 with yerrorbars pt 7 ps 1.1 lc rgb \"#1f6fb4\", "
                             "\\\n  ${0} using 1:2:5 with labels {1} font \"sans,10\" textcolor "
                             "rgb \"#14507f\", \\\n",
                             block, place);
    };
    if (!right.empty()) {
        add("right", "left offset 0.8,0.3");
    }
    if (!left.empty()) {
        add("left", "right offset -0.8,-0.3");
    }
    const std::string name =
        panel.without.empty() ? panel.approximation
                              : panel.approximation + " (" + panel.without + ": as default)";
    return right.text() + left.text() +
           fmt::format("set title {}\nplot $all with points pt 7 ps 0.5 lc rgb \"#d0d4d8\", \\\n"
                       "{}  $shipped using 1:2 with points pt 9 ps 1.8 lc rgb \"#d0342c\"\n",
                       gnuplotQuoted(name), plots);
}

}  // namespace

std::string scriptOfFront(const ErrorEvaluation& evaluation, const std::string& title,
                          const std::string& picture)
{
    // The front has the first choice of places for its names; of the others the worst come first.
    std::vector<std::size_t> order = evaluation.front;
    for (std::size_t k = 0; k < evaluation.settings.size(); ++k) {
        if (evaluation.settings[k].counts() && !evaluation.onFront(k)) {
            order.push_back(k);
        }
    }
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(evaluation.front.size()), order.end(),
              [&](std::size_t a, std::size_t b) {
                  return evaluation.settings[a].error > evaluation.settings[b].error;
              });
    const std::vector<std::string> names = nameWherePossible(evaluation, order);
    DataBlock others("others"), front("front"), shipped("shipped"), knee("knee");
    for (std::size_t n = 0; n < order.size(); ++n) {
        const SettingFigures& figures = evaluation.settings[order[n]];
        if (order[n] == 0) {
            shipped.add(figures, "");
        }
        if (evaluation.onFront(order[n])) {
            front.add(figures, names[n]);
        } else if (order[n] != 0) {
            others.add(figures, names[n]);
        }
    }
    if (evaluation.knee) {
        knee.add(evaluation.settings[*evaluation.knee], "");
    }
    std::string script = others.text() + front.text() + shipped.text() + knee.text();
    script += plotHead(findExtent(evaluation, false), picture, kFrontWidth, kFrontHeight);
    script += noiseBand(evaluation,
                        fmt::format("two seeds of the reference (time x {:.1f}) differ by this",
                                    evaluation.reference.cost));
    script += chanceBox(evaluation);
    script += fmt::format("set title {}\n", gnuplotQuoted(title));
    script += fmt::format(
        "set xlabel \"run time over that of the defaults ({} time)\"\nset ylabel {}\n",
        evaluation.clock == StudyClock::wall ? "wall" : "processor",
        gnuplotQuoted(measureTitle(evaluation.measure)));
    script += "set key top right Left reverse\nplot \\\n";
    if (!others.empty()) {
        script += "  $others with points pt 7 ps 0.9 lc rgb \"#a8b0b8\" title \"one setting "
                  "changed\", \\\n"
                  "  $others using 1:2:5 with labels left offset 1,0 font \"sans,9\" textcolor "
                  "rgb \"#7a828a\" notitle, \\\n";
    }
    script += "  $front with steps lw 2 lc rgb \"#1f6fb4\" notitle, \\\n"
              "  $front with points pt 7 ps 1.4 lc rgb \"#1f6fb4\" title \"Pareto front\", \\\n"
              "  $front using 1:2:5 with labels right offset -1,-0.5 font \"sans,11\" "
              "textcolor rgb \"#14507f\" notitle, \\\n";
    if (!knee.empty()) {
        script += "  $knee with points pt 6 ps 3.4 lw 2 lc rgb \"#1f6fb4\" title \"its knee\", "
                  "\\\n";
    }
    if (evaluation.noise) {
        script += "  NaN with lines dt 2 lc rgb \"#d0342c\" title \"no different from the default "
                  "(2 sigma)\", \\\n";
    }
    script += "  $shipped with points pt 9 ps 2.4 lc rgb \"#d0342c\" title \"default\"\n";
    return script;
}

std::string scriptOfSweeps(const ErrorEvaluation& evaluation, const std::string& title,
                           const std::string& picture)
{
    constexpr int kAcross = 4, kWidth = 380, kHeight = 290;  // pixels
    DataBlock all("all"), shipped("shipped");
    shipped.add(evaluation.settings.front(), "");
    for (const SettingFigures& figures : evaluation.settings) {
        if (figures.counts()) {
            all.add(figures, "");
        }
    }
    const std::vector<SweepPanel> panels = makePanels(evaluation);
    const int down = (static_cast<int>(panels.size()) + kAcross - 1) / kAcross;
    std::string script = all.text() + shipped.text();
    script += plotHead(findExtent(evaluation, true), picture, kAcross * kWidth,
                       down * kHeight + 60);
    script += noiseBand(evaluation, "");
    script += fmt::format("set multiplot layout {},{} title {} font \"sans,14\"\nunset key\n", down,
                          kAcross, gnuplotQuoted(title));
    for (const SweepPanel& panel : panels) {
        script += scriptOfPanel(panel);
    }
    return script + "unset multiplot\n";
}

}  // namespace sandflow
