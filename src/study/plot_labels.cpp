#include "study/plot_labels.h"

#include <cmath>

namespace sandflow {
namespace {

constexpr double kGap = 1.0;          // letters between a point and its text
constexpr double kLineHeight = 1.0;   // letters
constexpr double kPointHalf = 0.5;    // letters: half the size of a point

/// The place of a text: from its point to its last letter.
struct Box {
    double left, right, middle;

    bool meets(const Box& other) const
    {
        return left < other.right && other.left < right &&
               std::abs(middle - other.middle) < kLineHeight;
    }
    bool covers(const PlotLabel& point) const
    {
        return point.x + kPointHalf > left && point.x - kPointHalf < right &&
               std::abs(point.y - middle) < 0.5 * kLineHeight + kPointHalf;
    }
};

}  // namespace

std::vector<bool> chooseLabels(std::span<const PlotLabel> labels)
{
    std::vector<bool> chosen(labels.size(), false);
    std::vector<Box> taken;
    for (std::size_t k = 0; k < labels.size(); ++k) {
        const auto length = static_cast<double>(labels[k].text.size());
        const double begin =
            labels[k].toTheLeft ? labels[k].x - kGap - length : labels[k].x + kGap;
        const Box box{begin, begin + length, labels[k].y};
        bool free = true;
        for (std::size_t other = 0; other < labels.size() && free; ++other) {
            free = other == k || !box.covers(labels[other]);
        }
        for (const Box& there : taken) {
            free = free && !box.meets(there);
        }
        chosen[k] = free;
        if (free) {
            taken.push_back(box);
        }
    }
    return chosen;
}

}  // namespace sandflow
