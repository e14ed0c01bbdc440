#pragma once

#include "grains/grain_record.h"
#include "grains/sorted_cells.h"

#include <cstdint>
#include <span>
#include <vector>

namespace sandflow {

/// Grains that do not move but push: the particle interface, sleepers, rough solids. Kept sorted
/// along cells; sorting again costs nothing while nothing was added or removed.
template <class Real, class Info>
class FixedGrains {
public:
    explicit FixedGrains(double cellSize) : cells_(cellSize) {}

    void add(const GrainRecord<Real>& record, const Info& info)
    {
        record_.push_back(record);
        info_.push_back(info);
        sorted_ = false;
    }

    /// Keeps those for which keep(index) is true, in their order.
    template <class Keep>
    void removeUnless(Keep keep)
    {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < record_.size(); ++k) {
            if (keep(k)) {
                record_[kept] = record_[k];
                info_[kept] = info_[k];
                ++kept;
            }
        }
        sorted_ = sorted_ && kept == record_.size();
        record_.resize(kept);
        info_.resize(kept);
    }

    /// Afterwards entry k of cells() is grain k.
    void sort()
    {
        if (sorted_) {
            return;
        }
        cells_.build(record_.size(), [&](std::size_t k) {
            return Vec3(record_[k].x, record_[k].y, record_[k].z);
        });
        // Not kept: fixed grains change seldom, and there can be many.
        std::vector<GrainRecord<Real>> sortedRecords(record_.size());
        std::vector<Info> sortedInfos(record_.size());
        const auto n = static_cast<std::int64_t>(record_.size());
#pragma omp parallel for schedule(static) if (n > 4096)
        for (std::int64_t k = 0; k < n; ++k) {
            sortedRecords[k] = record_[cells_.order()[k]];
            sortedInfos[k] = info_[cells_.order()[k]];
        }
        record_.swap(sortedRecords);
        info_.swap(sortedInfos);
        sorted_ = true;
        ++version_;
    }

    /// Grain which[n] lies at place[n] from now on.
    void moveTo(std::span<const std::uint32_t> which, std::span<const Vec3> place)
    {
        for (std::size_t n = 0; n < which.size(); ++n) {
            GrainRecord<Real>& g = record_[which[n]];
            g.x = place[n].x(), g.y = place[n].y(), g.z = place[n].z();
        }
        sorted_ = sorted_ && which.empty();
    }

    /// Another number whenever sort() changed anything.
    std::uint64_t version() const { return version_; }

    std::size_t size() const { return record_.size(); }
    std::size_t bytes() const
    {
        return record_.capacity() * sizeof(GrainRecord<Real>) + info_.capacity() * sizeof(Info) +
               cells_.bytes();
    }
    const std::vector<GrainRecord<Real>>& records() const { return record_; }
    GrainRecord<Real>& record(std::size_t k) { return record_[k]; }  ///< not for moving it
    const GrainRecord<Real>& record(std::size_t k) const { return record_[k]; }
    Info& info(std::size_t k) { return info_[k]; }
    const Info& info(std::size_t k) const { return info_[k]; }
    const SortedCells& cells() const { return cells_; }

private:
    std::vector<GrainRecord<Real>> record_;
    std::vector<Info> info_;
    SortedCells cells_;
    bool sorted_ = true;
    std::uint64_t version_ = 0;
};

}  // namespace sandflow
