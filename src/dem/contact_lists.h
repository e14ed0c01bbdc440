#pragma once

#include "dem/chunk_contacts.h"
#include "dem/contact_book.h"
#include "dem/search_ball.h"
#include "dem/stray_balls.h"
#include "grains/fixed_grains.h"
#include "grains/mobile_grains.h"
#include "solids/primitive.h"

#include <span>
#include <vector>

namespace sandflow {

/// Why a fixed grain is fixed; see transfer/.
struct FrozenInfo;

/// Who may touch whom until further notice. Every grain is promised to stay within a ball; pairs
/// whose balls come close enough are listed. The ball of a moving grain is shifted ahead,
///
///     centre = x + v T / 2,   reach = skin / 2 + |v| T / 2,
///
/// so that a jet at 3 m/s does not use up the lists of everybody every few steps, and a grain that
/// hits the heap and stops is still inside its ball. Lists hold while all grains are in their balls.
template <class Real>
class ContactLists {
public:
    struct Ball {
        float x, y, z;   ///< m, centre relative to the origin of the chunk
        float reach;     ///< m
    };

    ContactLists(double cellSize, double skin, double largestRadius);

    /// Sorts the mobile grains along cells and lists their possible contacts. `horizon` is T [s].
    /// Springs of contacts that lived before come from `book`. `needBoundary` is called with the
    /// sorted cells before anything is searched, so that rough solids can be covered where grains
    /// are near.
    template <class Info, class BoundaryInfo, class NeedBoundary>
    void rebuild(double horizon, MobileGrains<Real>& mobile, FixedGrains<Real, Info>& frozen,
                 FixedGrains<Real, BoundaryInfo>& boundary, std::span<const Primitive> walls,
                 double time, const ContactBook<Real>& book, NeedBoundary needBoundary)
    {
        horizon_ = horizon;
        sortMobile(horizon, mobile);
        needBoundary(cells_);
        frozen.sort();
        boundary.sort();
        frozenColumns_.follow(frozen);
        boundaryColumns_.follow(boundary);
        search(mobile, viewOf(frozen, frozenColumns_), viewOf(boundary, boundaryColumns_), walls,
               time, book);
    }

    /// A mobile grain left its ball: gives it another one from where it is now and appends the pairs
    /// that this brings. Cheap, so that a few grains that bounce do not end everybody's lists.
    template <class Info, class BoundaryInfo>
    void followStray(std::uint32_t slot, const MobileGrains<Real>& mobile,
                     const FixedGrains<Real, Info>& frozen,
                     const FixedGrains<Real, BoundaryInfo>& boundary,
                     std::span<const Primitive> walls, double time)
    {
        followStray(slot, mobile, viewOf(frozen, frozenColumns_),
                    viewOf(boundary, boundaryColumns_), walls, time);
    }

    /// A grain that came in after the lists were made, the last of `mobile`: gets a slot behind the
    /// others and the pairs that its ball brings. So a jet does not make everybody's lists anew with
    /// every layer.
    template <class Info, class BoundaryInfo>
    void append(const MobileGrains<Real>& mobile, const FixedGrains<Real, Info>& frozen,
                const FixedGrains<Real, BoundaryInfo>& boundary, std::span<const Primitive> walls,
                double time)
    {
        const auto slot = static_cast<std::uint32_t>(mobile.size() - 1);
        openSlot(slot, mobile.record[slot]);
        followStray(slot, mobile, frozen, boundary, walls, time);
    }

    /// The ball that followStray would give.
    SearchBall ballAhead(const GrainRecord<Real>& grain) const
    {
        return ballAhead(grain, horizon_);
    }

    bool isInBall(std::uint32_t slot, const GrainRecord<Real>& grain) const
    {
        const Ball& ball = balls_[slot];
        const Vec3& origin = origins_[slot / kChunkSize];
        const float dx = static_cast<float>(grain.x - origin.x()) - ball.x;
        const float dy = static_cast<float>(grain.y - origin.y()) - ball.y;
        const float dz = static_cast<float>(grain.z - origin.z()) - ball.z;
        return dx * dx + dy * dy + dz * dz <= ball.reach * ball.reach;
    }

    /// Balls given since the rebuild to grains that had left theirs.
    std::size_t strayCount() const { return strayCount_; }

    std::vector<ChunkContacts<Real>>& chunks() { return chunks_; }
    const std::vector<ChunkContacts<Real>>& chunks() const { return chunks_; }
    std::size_t chunkCount() const { return chunks_.size(); }
    const std::vector<Ball>& balls() const { return balls_; }
    const Vec3& origin(std::size_t chunk) const { return origins_[chunk]; }
    double skin() const { return skin_; }
    const SortedCells& cells() const { return cells_; }

    /// How many cells away grains of each cell may have partners (1 except near fast grains).
    int searchRadius(std::size_t cell) const { return searchRadius_[cell]; }

    std::size_t bytes() const;

private:
    /// Columns of the fixed grains, made anew when those were sorted anew, and their rows in the
    /// book, which change with every book.
    struct FixedColumns {
        BallColumns balls;
        std::vector<std::uint32_t> row;
        std::uint64_t version = 0;

        template <class Info>
        void follow(const FixedGrains<Real, Info>& fixed)
        {
            if constexpr (requires(Info info) { info.row; }) {
                row.resize(fixed.size());
                for (std::size_t k = 0; k < fixed.size(); ++k) {
                    row[k] = fixed.info(k).row;
                }
            }
            if (version == fixed.version()) {
                return;
            }
            version = fixed.version();
            balls.resize(fixed.size());
            for (std::size_t k = 0; k < fixed.size(); ++k) {
                balls.set(k, ballOfFixed(fixed.record(k)));
            }
        }
    };
    struct FixedView {
        const std::vector<GrainRecord<Real>>& record;
        const SortedCells& cells;
        const BallColumns& balls;
        const std::vector<std::uint32_t>& row;

        std::uint32_t rowOf(std::uint32_t k) const { return row.empty() ? kNoRow : row[k]; }
    };
    template <class Info>
    static FixedView viewOf(const FixedGrains<Real, Info>& fixed, const FixedColumns& columns)
    {
        return {fixed.records(), fixed.cells(), columns.balls, columns.row};
    }

    /// Neighbours of one cell as ranges of slots, and who of them one grain may meet.
    struct Surroundings {
        std::vector<SlotRange> mobile, frozen, boundary;
        std::vector<std::uint32_t> found;
    };

    SearchBall ballAhead(const GrainRecord<Real>& grain, double horizon) const
    {
        const Vec3 ahead = Vec3(grain.vx, grain.vy, grain.vz) * (0.5 * horizon);
        return {grain.x + ahead.x(), grain.y + ahead.y(), grain.z + ahead.z(),
                static_cast<float>(0.5 * skin_ + ahead.norm() + static_cast<double>(grain.radius)),
                grain.id};
    }
    void giveBall(std::uint32_t slot, const SearchBall& ball, Real radius);

    /// The ball that a grain has now, a little wider than the kernel knows it: whatever rounds there,
    /// the grain is seen to leave it in time.
    [[gnu::always_inline]] SearchBall ballOf(std::uint32_t slot,
                                             const MobileGrains<Real>& mobile) const
    {
        const Ball& ball = balls_[slot];
        const Vec3& origin = origins_[slot / kChunkSize];
        const GrainRecord<Real>& g = mobile.record[slot];
        return {origin.x() + static_cast<double>(ball.x), origin.y() + static_cast<double>(ball.y),
                origin.z() + static_cast<double>(ball.z),
                1.0002f * ball.reach + static_cast<float>(g.radius), g.id};
    }
    void sortMobile(double horizon, MobileGrains<Real>& mobile);
    void placeBalls(const MobileGrains<Real>& mobile);
    void spreadSearchRadius();
    void search(const MobileGrains<Real>& mobile, FixedView frozen, FixedView boundary,
                std::span<const Primitive> walls, double time, const ContactBook<Real>& book);
    void searchChunk(std::uint32_t chunk, const MobileGrains<Real>& mobile, const FixedView& frozen,
                     const FixedView& boundary, const ContactBook<Real>& book, Surroundings& near);
    void findSurroundings(std::uint32_t cell, std::uint32_t firstOfChunk, const FixedView& frozen,
                          const FixedView& boundary, Surroundings& near) const;
    void searchWalls(std::uint32_t chunk, const MobileGrains<Real>& mobile,
                     std::span<const Primitive> walls, double time,
                     const ContactBook<Real>& book);

    void followStray(std::uint32_t slot, const MobileGrains<Real>& mobile, const FixedView& frozen,
                     const FixedView& boundary, std::span<const Primitive> walls, double time);
    void openSlot(std::uint32_t slot, const GrainRecord<Real>& grain);
    bool cameLater(std::uint32_t slot) const { return slot >= cells_.order().size(); }
    void appendPair(std::uint32_t a, std::uint32_t b);
    void appendForeign(std::uint32_t slot, PartnerSource source, std::uint32_t index);

    double skin_, largestRadius_;
    FindNear findNear_;
    double horizon_ = 0.0;  ///< s, T of these lists
    SortedCells cells_;
    BallColumns columns_;  ///< of the balls of mobile grains
    FixedColumns frozenColumns_, boundaryColumns_;
    StrayBalls strays_;               ///< all balls of grains that had several, or came in later
    std::size_t strayCount_ = 0;
    std::vector<std::uint32_t> strayPartners_;
    double longestReach_ = 0.0;       ///< m, over all cells
    std::vector<float> cellReach_;    ///< m, longest reach of the grains of each cell
    std::vector<std::uint32_t> cellOfSlot_;
    std::vector<std::uint8_t> searchRadius_;
    std::vector<GrainMemory> memoryScratch_;
    std::vector<Ball> balls_;
    std::vector<Vec3> origins_;
    std::vector<ChunkContacts<Real>> chunks_;
};

}  // namespace sandflow
