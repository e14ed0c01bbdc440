#include "transfer/matter_transfer.h"

#include "transfer/bed_height.h"
#include "transfer/part_overlaps.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// A released heap of 40 d comes to rest within about that.
constexpr float kSettlingTime = 0.25f;  // s
/// Over a base that may slip: sand that spreads with it is too slow for the usual rest clock.
constexpr float kLongRest = 1.0f;  // s

bool slipsAt(std::span<const std::uint8_t> slips, std::int32_t span)
{
    return span != ColumnGrid::kNone && !slips.empty() && slips[span];
}

template <class Real>
Vec3 positionOf(const GrainRecord<Real>& g)
{
    return {g.x, g.y, g.z};
}

template <class Real>
double speedOf(const GrainRecord<Real>& g)
{
    return std::sqrt(static_cast<double>(g.vx * g.vx + g.vy * g.vy + g.vz * g.vz));
}

}  // namespace

TransferReport& TransferReport::operator+=(const TransferReport& o)
{
    trapped += o.trapped;
    dislodged += o.dislodged;
    buried += o.buried;
    uncovered += o.uncovered;
    fellAsleep += o.fellAsleep;
    woken += o.woken;
    trappedMomentum += o.trappedMomentum;
    landedMomentum += o.landedMomentum;
    return *this;
}

template <class Real>
void MatterTransfer<Real>::plan(const ColumnGrid& columns, const Dem<Real>& dem,
                                std::span<const std::uint8_t> slips)
{
    const auto mobileCount = static_cast<std::int64_t>(dem.mobile().size());
    const auto frozenCount = static_cast<std::int64_t>(dem.frozen().size());
    mobileFate_.resize(dem.mobile().size());
    frozenFate_.resize(dem.frozen().size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < mobileCount; ++k) {
        mobileFate_[k] = judgeMobile(columns, dem, slips, k);
    }
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < frozenCount; ++k) {
        frozenFate_[k] = judgeFrozen(columns, dem, slips, k);
    }
}

template <class Real>
auto MatterTransfer<Real>::judgeMobile(const ColumnGrid& columns, const Dem<Real>& dem,
                                       std::span<const std::uint8_t> slips,
                                       std::size_t k) const -> Fate
{
    if (!isAtRest(params_.rest, dem, k)) {
        return Fate::stays;
    }
    const GrainRecord<Real>& g = dem.mobile().record[k];
    const std::int32_t span = columns.spanAt(g.x, g.y, g.z);
    const bool isSlow = params_.sleep && speedOf(g) < params_.rest.sleepSpeed;
    if (slipsAt(slips, span)) {
        return isSlow && dem.mobile().memory[k].stillTime > kLongRest ? Fate::sleeps : Fate::stays;
    }
    if (span != ColumnGrid::kNone && !columns.ragged[span] &&
        g.z < bedHeightAt(columns, span, g.x, g.y)) {
        return Fate::trapped;
    }
    return isSlow ? Fate::sleeps : Fate::stays;
}

template <class Real>
auto MatterTransfer<Real>::judgeFrozen(const ColumnGrid& columns, const Dem<Real>& dem,
                                       std::span<const std::uint8_t> slips,
                                       std::size_t k) const -> Fate
{
    const GrainRecord<Real>& g = dem.frozen().record(k);
    const FrozenInfo& info = dem.frozen().info(k);
    if (info.wakes) {
        return Fate::dislodged;
    }
    const std::int32_t span = columns.spanAt(g.x, g.y, g.z);
    // Where a column is ragged its h says nothing about this grain: it may sleep, no more.
    const double bed = span == ColumnGrid::kNone || columns.ragged[span]
                           ? -1e30
                           : bedHeightAt(columns, span, g.x, g.y);
    if (info.state == GrainState::asleep) {
        return g.z < bed && !slipsAt(slips, span) ? Fate::sinks : Fate::stays;
    }
    return g.z > bed + params_.hysteresis ? Fate::dislodged : Fate::stays;
}

template <class Real>
TransferReport MatterTransfer<Real>::apply(const ColumnGrid& columns, Dem<Real>& dem,
                                           BuriedGrains& buried,
                                           std::span<const ImpactZone> zones)
{
    TransferReport report;
    // Erosion: interface grains above h, and sleepers that were disturbed, are free again.
    freed_.clear();
    dem.frozen().removeUnless([&](std::size_t k) {
        FrozenInfo& info = dem.frozen().info(k);
        if (frozenFate_[k] == Fate::sinks) {
            info.state = GrainState::interface;
            info.judged = false;
        }
        if (frozenFate_[k] != Fate::dislodged) {
            return true;
        }
        ++(info.state == GrainState::asleep ? report.woken : report.dislodged);
        freed_.push_back(dem.frozen().record(k));
        return false;
    });
    // Deposition: grains at rest below h join the interface; above it they may sleep.
    MobileGrains<Real>& mobile = dem.mobile();
    mobile.removeUnless([&](std::size_t k) {
        if (mobileFate_[k] == Fate::stays) {
            return true;
        }
        const GrainRecord<Real>& g = mobile.record[k];
        const bool sleeps = mobileFate_[k] == Fate::sleeps;
        ++(sleeps ? report.fellAsleep : report.trapped);
        report.trappedMomentum += speedOf(g) / static_cast<double>(g.inverseMass);
        FrozenInfo info;
        info.state = sleeps ? GrainState::asleep : GrainState::interface;
        info.row = mobile.row[k];
        dem.frozen().add(dem.makeRecord(positionOf(g), static_cast<double>(g.radius), g.id), info);
        return false;
    });
    addFreed(dem);
    for (const ImpactZone& zone : zones) {
        freeBuriedIn(zone, columns, dem, buried, report);
    }
    findBuryLines(columns, dem);
    buryDeepOnes(columns, dem, buried, report);
    uncoverShallowOnes(columns, dem, buried, report);
    return report;
}

/// Into freed_, what was there before is forgotten.
template <class Real>
template <class Leaves>
void MatterTransfer<Real>::takeFixed(Leaves leaves, Dem<Real>& dem, TransferReport& report)
{
    freed_.clear();
    dem.frozen().removeUnless([&](std::size_t k) {
        if (!leaves(k)) {
            return true;
        }
        ++(dem.frozen().info(k).state == GrainState::asleep ? report.woken : report.dislodged);
        freed_.push_back(dem.frozen().record(k));
        return false;
    });
}

template <class Real>
void MatterTransfer<Real>::addFreed(Dem<Real>& dem) const
{
    for (const GrainRecord<Real>& g : freed_) {
        dem.addMobile(positionOf(g), Vec3::Zero(), Vec3::Zero(), static_cast<double>(g.radius),
                      g.id);
    }
}

template <class Real>
TransferReport MatterTransfer<Real>::wakeMarked(const ColumnGrid& columns, Dem<Real>& dem,
                                                BuriedGrains& buried)
{
    TransferReport report;
    takeFixed([&](std::size_t k) { return dem.frozen().info(k).wakes; }, dem, report);
    if (!freed_.empty()) {
        addFreed(dem);
        findBuryLines(columns, dem);
        uncoverShallowOnes(columns, dem, buried, report);
    }
    return report;
}

/// Quarter of its column that a point lies over: 0 to 3.
template <class Real>
std::size_t MatterTransfer<Real>::binOf(const ColumnGrid& columns, std::int32_t span, double x,
                                        double y)
{
    const double u = x / columns.cellSize() - columns.columnI[span];
    const double v = y / columns.cellSize() - columns.columnJ[span];
    return kBins * static_cast<std::size_t>(span) + (u >= 0.5 ? 1 : 0) + (v >= 0.5 ? 2 : 0);
}

/// Nothing may lie buried near a moving grain. Near is judged by quarters of columns: on a slope,
/// whole columns would keep half as much again from being buried.
template <class Real>
void MatterTransfer<Real>::findBuryLines(const ColumnGrid& columns, const Dem<Real>& dem)
{
    lowestMobile_.assign(kBins * columns.spanCount(), 1e30);
    for (const GrainRecord<Real>& g : dem.mobile().record) {
        const std::int32_t span = columns.spanAt(g.x, g.y, g.z);
        if (span != ColumnGrid::kNone) {
            double& lowest = lowestMobile_[binOf(columns, span, g.x, g.y)];
            lowest = std::min(lowest, g.z);
        }
    }
    buryLine_.resize(lowestMobile_.size());
    const auto bins = static_cast<std::int64_t>(buryLine_.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t b = 0; b < bins; ++b) {
        const auto s = static_cast<std::size_t>(b) / kBins;
        const std::int32_t i = 2 * columns.columnI[s] + static_cast<std::int32_t>(b & 1);
        const std::int32_t j = 2 * columns.columnJ[s] + static_cast<std::int32_t>(b >> 1 & 1);
        double lowest = 1e30;
        for (std::int32_t nj = j - 1; nj <= j + 1; ++nj) {
            for (std::int32_t ni = i - 1; ni <= i + 1; ++ni) {
                // Any span of that column counts: sand above a table's edge falls past it.
                const auto [first, count] = columns.spansOf(ni >> 1, nj >> 1);
                for (std::int32_t t = first; t < first + count; ++t) {
                    if (columns.ceiling[t] > columns.floor[s] &&
                        columns.floor[t] < columns.ceiling[s]) {
                        const std::size_t quarter =
                            static_cast<std::size_t>(ni & 1) + 2 * static_cast<std::size_t>(nj & 1);
                        lowest = std::min(
                            lowest, lowestMobile_[kBins * static_cast<std::size_t>(t) + quarter]);
                    }
                }
            }
        }
        buryLine_[b] = lowest - params_.buryClearance;
    }
}

template <class Real>
void MatterTransfer<Real>::buryDeepOnes(const ColumnGrid& columns, Dem<Real>& dem,
                                        BuriedGrains& buried, TransferReport& report)
{
    dem.frozen().removeUnless([&](std::size_t k) {
        if (dem.frozen().info(k).state != GrainState::interface) {
            return true;
        }
        const GrainRecord<Real>& g = dem.frozen().record(k);
        const std::int32_t span = columns.spanAt(g.x, g.y, g.z);
        if (span == ColumnGrid::kNone) {
            return true;
        }
        const double line = std::min(
            bedHeightAt(columns, span, g.x, g.y) - params_.interfaceThickness,
            buryLine_[binOf(columns, span, g.x, g.y)]);
        if (g.z >= line - params_.hysteresis) {
            return true;
        }
        buried.add(positionOf(g), static_cast<double>(g.radius), g.id);
        ++report.buried;
        return false;
    });
}

template <class Real>
void MatterTransfer<Real>::freeBuriedIn(const ImpactZone& zone, const ColumnGrid& columns,
                                        Dem<Real>& dem, BuriedGrains& buried,
                                        TransferReport& report)
{
    const auto [x, y] = std::pair(zone.centre.x(), zone.centre.y());
    for (std::int32_t j = columns.cellIndex(y - zone.radius);
         j <= columns.cellIndex(y + zone.radius); ++j) {
        for (std::int32_t i = columns.cellIndex(x - zone.radius);
             i <= columns.cellIndex(x + zone.radius); ++i) {
            buried.takeAbove(i, j, zone.centre.z() - zone.radius,
                             [&](const Vec3& position, double radius, std::uint32_t id) {
                                 if (!zone.holds(position)) {
                                     return false;
                                 }
                                 dem.addMobile(position, Vec3::Zero(), Vec3::Zero(), radius, id);
                                 ++report.uncovered;
                                 ++report.dislodged;
                                 return true;
                             });
        }
    }
}

template <class Real>
void MatterTransfer<Real>::uncoverShallowOnes(const ColumnGrid& columns, Dem<Real>& dem,
                                              BuriedGrains& buried, TransferReport& report)
{
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        const auto span = static_cast<std::int32_t>(s);
        const bool isShared = columns.spansOf(columns.columnI[s], columns.columnJ[s]).second > 1;
        // h may be a slope's drop lower at the column's far side than at its centre.
        const double clear =
            *std::min_element(buryLine_.begin() + static_cast<std::ptrdiff_t>(kBins * s),
                              buryLine_.begin() + static_cast<std::ptrdiff_t>(kBins * (s + 1)));
        const double lowest =
            std::min(columns.h[s] - columns.cellSize() - params_.interfaceThickness, clear);
        buried.takeAbove(
            columns.columnI[s], columns.columnJ[s], lowest,
            [&](const Vec3& position, double radius, std::uint32_t id) {
                const double line =
                    std::min(bedHeightAt(columns, span, position.x(), position.y()) -
                                 params_.interfaceThickness,
                             buryLine_[binOf(columns, span, position.x(), position.y())]);
                // The span that buried it: on a sloping floor that may begin above the grain.
                if (position.z() <= line ||
                    (isShared &&
                     columns.spanAt(position.x(), position.y(), position.z()) != span)) {
                    return false;
                }
                dem.frozen().add(dem.makeRecord(position, radius, id), {});
                ++report.uncovered;
                return true;
            });
    }
}

template <class Real>
TransferReport MatterTransfer<Real>::setFreeAbove(const std::vector<double>& line,
                                                  const ColumnGrid& columns, Dem<Real>& dem,
                                                  BuriedGrains& buried)
{
    TransferReport report;
    if (line.empty()) {
        return report;
    }
    const auto isAbove = [&](const Vec3& position) {
        const std::int32_t span = columns.spanAt(position.x(), position.y(), position.z());
        return span != ColumnGrid::kNone && position.z() > line[span];
    };
    takeFixed([&](std::size_t k) { return isAbove(positionOf(dem.frozen().record(k))); }, dem,
              report);
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        buried.takeAbove(columns.columnI[s], columns.columnJ[s], line[s],
                         [&](const Vec3& position, double radius, std::uint32_t id) {
                             if (!isAbove(position)) {
                                 return false;
                             }
                             freed_.push_back(dem.makeRecord(position, radius, id));
                             ++report.uncovered;
                             ++report.dislodged;
                             return true;
                         });
    }
    const std::size_t moving = dem.mobile().size();
    addFreed(dem);
    for (std::size_t k = moving; k < dem.mobile().size(); ++k) {
        dem.mobile().memory[k].stillTime = -kSettlingTime;
    }
    findBuryLines(columns, dem);
    uncoverShallowOnes(columns, dem, buried, report);
    return report;
}

template <class Real>
void MatterTransfer<Real>::releaseAll(Dem<Real>& dem, BuriedGrains& buried) const
{
    buried.forEach([&](const Vec3& position, double radius, std::uint32_t id) {
        dem.frozen().add(dem.makeRecord(position, radius, id), {});
    });
    buried.clear();
    OverlapParter<Real>().partAll(dem);
    dem.frozen().removeUnless([&](std::size_t k) {
        const GrainRecord<Real>& g = dem.frozen().record(k);
        dem.addMobile(positionOf(g), Vec3::Zero(), Vec3::Zero(), static_cast<double>(g.radius),
                      g.id);
        return false;
    });
}

template class MatterTransfer<float>;
template class MatterTransfer<double>;

}  // namespace sandflow
