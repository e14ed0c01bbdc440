#pragma once

#include "core/cell_key.h"
#include "core/cell_map.h"
#include "dem/search_ball.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sandflow {

/// Balls that grains were given after the lists were made, found by their grain and by their place.
/// A grain may have several.
class StrayBalls {
public:
    struct Stray {
        std::uint32_t slot;
        SearchBall ball;
        std::uint32_t previousOfSlot, previousInCell;  ///< 1 + index; 0: none
    };

    explicit StrayBalls(double cellSize) : cellSize_(cellSize) {}

    std::size_t size() const { return strays_.size(); }

    void clear()
    {
        strays_.clear(), ofSlot_.clear(), inCell_.clear();
        longestReach_ = 0.0f;
    }

    void add(std::uint32_t slot, const SearchBall& ball)
    {
        const auto link = static_cast<std::uint32_t>(strays_.size() + 1);
        const auto chain = [&](CellMap& map, std::uint64_t key) {
            const auto [latest, isNew] = map.insert(key, link);
            const std::uint32_t previous = isNew ? 0 : *latest;
            *latest = link;
            return previous;
        };
        const std::uint32_t ofSlot = chain(ofSlot_, slot);
        const std::uint32_t inCell = chain(inCell_, packCellKey(cellOf(ball)));
        strays_.push_back({slot, ball, ofSlot, inCell});
        longestReach_ = std::max(longestReach_, ball.reach);
    }

    /// True if test(ball) holds for a ball of this grain.
    template <class Test>
    bool anyOf(std::uint32_t slot, Test test) const
    {
        const std::uint32_t* latest = ofSlot_.find(slot);
        for (std::uint32_t link = latest ? *latest : 0; link; link = strays_[link - 1].previousOfSlot) {
            if (test(strays_[link - 1].ball)) {
                return true;
            }
        }
        return false;
    }

    /// visit(slot) for every ball that meets this one, in no particular order.
    template <class Visit>
    void visitMeeting(const SearchBall& ball, Visit visit) const
    {
        const auto ask = [&](const Stray& stray) {
            if (stray.ball.meets(ball)) {
                visit(stray.slot);
            }
        };
        const double reach = static_cast<double>(ball.reach) + static_cast<double>(longestReach_);
        const auto radius = static_cast<std::int32_t>(std::ceil(reach / cellSize_));
        const double cells = std::pow(2.0 * radius + 1.0, 3);
        if (static_cast<double>(strays_.size()) < 2.0 * cells) {
            std::for_each(strays_.begin(), strays_.end(), ask);
            return;
        }
        const CellIndex at = cellOf(ball);
        for (std::int32_t k = at.k - radius; k <= at.k + radius; ++k) {
            for (std::int32_t j = at.j - radius; j <= at.j + radius; ++j) {
                for (std::int32_t i = at.i - radius; i <= at.i + radius; ++i) {
                    const std::uint32_t* latest = inCell_.find(packCellKey(i, j, k));
                    for (std::uint32_t link = latest ? *latest : 0; link;
                         link = strays_[link - 1].previousInCell) {
                        ask(strays_[link - 1]);
                    }
                }
            }
        }
    }

private:
    CellIndex cellOf(const SearchBall& ball) const
    {
        const double inverse = 1.0 / cellSize_;
        return {cellCoordinate(ball.x, inverse), cellCoordinate(ball.y, inverse),
                cellCoordinate(ball.z, inverse)};
    }

    double cellSize_;
    float longestReach_ = 0.0f;
    std::vector<Stray> strays_;
    CellMap ofSlot_, inCell_;  ///< to the latest
};

}  // namespace sandflow
