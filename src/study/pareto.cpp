#include "study/pareto.h"

#include "core/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sandflow {

bool dominates(const CostAndError& a, const CostAndError& b)
{
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

bool dominatesClearly(const CostAndError& a, const CostAndError& b, const ChoiceNoise& noise)
{
    return dominates(a, b) && (std::log(b.cost / a.cost) > noise.logCost ||
                               b.error - a.error > noise.error);
}

std::vector<std::size_t> findParetoFront(std::span<const CostAndError> choices)
{
    std::vector<std::size_t> order(choices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return choices[a].cost != choices[b].cost ? choices[a].cost < choices[b].cost
                                                  : choices[a].error < choices[b].error;
    });
    // Whoever comes here has cost no less than all before: only a smaller error keeps it.
    std::vector<std::size_t> front;
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t k : order) {
        if (choices[k].error < least) {
            least = choices[k].error;
            front.push_back(k);
        }
    }
    return front;
}

std::optional<std::size_t> findKnee(std::span<const CostAndError> choices,
                                    std::span<const std::size_t> front)
{
    if (front.size() < 3) {
        return std::nullopt;
    }
    const CostAndError& cheap = choices[front.front()];
    const CostAndError& exact = choices[front.back()];
    SAND_CHECK(cheap.cost > 0.0 && exact.cost > cheap.cost && exact.error < cheap.error,
               "a front from cost {} and error {} to {} and {}", cheap.cost, cheap.error,
               exact.cost, exact.error);
    std::optional<std::size_t> knee;
    double deepest = 0.0;
    for (const std::size_t k : front) {
        const double x = std::log(choices[k].cost / cheap.cost) / std::log(exact.cost / cheap.cost);
        const double y = (choices[k].error - exact.error) / (cheap.error - exact.error);
        const double below = 1.0 - x - y;  // the line is x + y = 1
        if (below > deepest) {
            deepest = below;
            knee = k;
        }
    }
    return knee;
}

}  // namespace sandflow
