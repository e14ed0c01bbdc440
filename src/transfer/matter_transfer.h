#pragma once

#include "bcre/columns.h"
#include "dem/dem.h"
#include "grains/buried_grains.h"
#include "transfer/impact_zones.h"
#include "transfer/rest_judge.h"

#include <span>
#include <vector>

namespace sandflow {

struct TransferParams {
    double interfaceThickness = 0.022;  ///< m
    double buryClearance = 0.016;       ///< m between the lowest mobile and the highest buried grain
    double hysteresis = 0.002;          ///< m: a grain on the line does not cross to and fro
    bool sleep = true;
    RestRules rest;
};

/// Grains that crossed in one transfer.
struct TransferReport {
    std::uint64_t trapped = 0;     ///< mobile -> interface
    std::uint64_t dislodged = 0;   ///< interface -> mobile
    std::uint64_t buried = 0;      ///< interface -> buried
    std::uint64_t uncovered = 0;   ///< buried -> interface
    std::uint64_t fellAsleep = 0;  ///< mobile -> asleep
    std::uint64_t woken = 0;       ///< asleep -> mobile
    double trappedMomentum = 0.0;  ///< kg m/s, sum of |m v| at trapping and falling asleep
    double landedMomentum = 0.0;   ///< kg m/s, sum of |m v| at the end of flights, flight_judge.h

    TransferReport& operator+=(const TransferReport& o);
};

/// Step 2 of the method: moves grains between the flowing layer, the interface and the static bed
/// so that they agree with h. Deposition traps grains below h that have come to rest; erosion frees
/// interface grains above h; what lies deeper than the interface is buried, and comes back where it
/// lay when h falls or moving grains come near.
///
/// plan() only reads; apply() carries it out in a fixed order, between Dem::recordContacts() and
/// Dem::rebuild().
template <class Real>
class MatterTransfer {
public:
    explicit MatterTransfer(const TransferParams& params) : params_(params) {}

    /// No grain is fixed in a span where `slips` is 1; empty: nowhere.
    void plan(const ColumnGrid& columns, const Dem<Real>& dem,
              std::span<const std::uint8_t> slips = {});
    /// Besides, buried grains in the zones are set free; frozen ones there must be marked to wake.
    TransferReport apply(const ColumnGrid& columns, Dem<Real>& dem, BuriedGrains& buried,
                         std::span<const ImpactZone> zones = {});

    /// Sets only those grains free that are marked to wake, and uncovers what is buried near them:
    /// when lists are made anew between two transfers, for a blow runs through sand much faster than
    /// they come (between recordContacts() and rebuild()).
    TransferReport wakeMarked(const ColumnGrid& columns, Dem<Real>& dem, BuriedGrains& buried);

    /// Sets free what lies above the line [m] of its span, by span; none if it is empty. It is not
    /// fixed again before it had time to find its rest. As apply(), between recordContacts() and
    /// rebuild().
    TransferReport setFreeAbove(const std::vector<double>& line, const ColumnGrid& columns,
                                Dem<Real>& dem, BuriedGrains& buried);

    /// Makes every frozen and buried grain mobile (between recordContacts() and rebuild()).
    void releaseAll(Dem<Real>& dem, BuriedGrains& buried) const;

    /// Clearance line per quarter of a span's column, m: nothing stays buried above it. For tests and
    /// diagnostics.
    const std::vector<double>& buryLine() const { return buryLine_; }

private:
    enum class Fate : std::uint8_t { stays, trapped, sleeps, dislodged, sinks };

    Fate judgeMobile(const ColumnGrid& columns, const Dem<Real>& dem,
                     std::span<const std::uint8_t> slips, std::size_t k) const;
    Fate judgeFrozen(const ColumnGrid& columns, const Dem<Real>& dem,
                     std::span<const std::uint8_t> slips, std::size_t k) const;
    static constexpr std::size_t kBins = 4;  ///< quarters of a column
    static std::size_t binOf(const ColumnGrid& columns, std::int32_t span, double x, double y);
    template <class Leaves>
    void takeFixed(Leaves leaves, Dem<Real>& dem, TransferReport& report);
    void addFreed(Dem<Real>& dem) const;
    void findBuryLines(const ColumnGrid& columns, const Dem<Real>& dem);
    void buryDeepOnes(const ColumnGrid& columns, Dem<Real>& dem, BuriedGrains& buried,
                      TransferReport& report);
    static void freeBuriedIn(const ImpactZone& zone, const ColumnGrid& columns, Dem<Real>& dem,
                             BuriedGrains& buried, TransferReport& report);
    void uncoverShallowOnes(const ColumnGrid& columns, Dem<Real>& dem, BuriedGrains& buried,
                            TransferReport& report);

    TransferParams params_;
    std::vector<Fate> mobileFate_, frozenFate_;
    std::vector<double> lowestMobile_, buryLine_;
    std::vector<GrainRecord<Real>> freed_;
};

}  // namespace sandflow
