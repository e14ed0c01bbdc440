#pragma once

#include "dem/contact_pair.h"
#include "grains/grain_record.h"

#include <cstddef>

namespace sandflow {

/// Where a record keeps mass and motion: two rows of four numbers, radius, 1/m, vx, vy and
/// vz, wx, wy, wz. Lanes read and write whole rows and turn them in registers.
template <class Lanes>
struct RecordRows {
    using Number = typename Lanes::Number;
    using Real = typename Lanes::Real;
    using Record = GrainRecord<Number>;
    static constexpr std::size_t kMass = offsetof(Record, radius) / sizeof(Number);
    static constexpr std::size_t kSpin = kMass + 4;
    static_assert(offsetof(Record, vz) == kSpin * sizeof(Number) &&
                  offsetof(Record, wz) == (kSpin + 3) * sizeof(Number));

    /// record(l) is the record of lane l.
    template <class RecordOf>
    static ContactSide<Real> gather(RecordOf record)
    {
        const auto row = [&](std::size_t l) {
            return reinterpret_cast<const Number*>(record(l));
        };
        Real mass[4], spin[4];
        Lanes::gatherRows(row, kMass, mass);
        Lanes::gatherRows(row, kSpin, spin);
        return {mass[0], mass[1], {mass[2], mass[3], spin[0]}, {spin[1], spin[2], spin[3]}};
    }

    template <class RecordOf>
    static void scatter(const ContactSide<Real>& side, RecordOf record)
    {
        const auto row = [&](std::size_t l) { return reinterpret_cast<Number*>(record(l)); };
        const Vec<Real>& v = side.velocity;
        const Vec<Real>& w = side.spin;
        Lanes::scatterRows({side.radius, side.inverseMass, v.x, v.y}, row, kMass);
        Lanes::scatterRows({v.z, w.x, w.y, w.z}, row, kSpin);
    }
};

}  // namespace sandflow
