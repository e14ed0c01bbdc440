#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace sandflow {

/// A choice: what it costs and how wrong it is, both better when smaller.
struct CostAndError {
    double cost = 0.0;   ///< above 0
    double error = 0.0;  ///< 0 or more
};

/// How far two choices may differ by chance.
struct ChoiceNoise {
    double logCost = 0.0;  ///< of the natural logarithm of a cost
    double error = 0.0;
};

/// True if a is no worse than b in both and better in one.
bool dominates(const CostAndError& a, const CostAndError& b);

/// The same, and in one of them better by more than the noise.
bool dominatesClearly(const CostAndError& a, const CostAndError& b, const ChoiceNoise& noise);

/// The choices that no other dominates, by rising cost (and so by falling error); of equal ones the
/// first.
std::vector<std::size_t> findParetoFront(std::span<const CostAndError> choices);

/// The knee of a front: its point farthest below the straight line between its two ends, in
/// log(cost) and error, each scaled to the front's extent.
///
///     error |*                  to the left of it a little less cost makes a lot more error,
///           | \ ` .             to the right a lot more cost makes little less error
///           |  *    ` .         <- the knee
///           |     *     ` *
///           +---------------- log cost
///
/// Empty if no point lies below the line: a front of fewer than three points, or one that bulges.
/// `front` as findParetoFront gives it.
std::optional<std::size_t> findKnee(std::span<const CostAndError> choices,
                                    std::span<const std::size_t> front);

}  // namespace sandflow
