#pragma once

#include "core/small_vec.h"
#include "dem/chunk_pass.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace sandflow {

/// Lanes of ContactPass for any machine and for double: one.
template <class Scalar>
struct ScalarLanes {
    using Number = Scalar;
    using Real = Scalar;
    static constexpr std::uint32_t width = 1;

    struct Row {
        Number v[4];
    };

    template <class RecordOf, class PartnerOf>
    static void subtract(RecordOf a, PartnerOf b, Vec<Number>& apart, Number& radii)
    {
        apart = {static_cast<Number>(a(0)->x - b(0)->x), static_cast<Number>(a(0)->y - b(0)->y),
                 static_cast<Number>(a(0)->z - b(0)->z)};
        radii = a(0)->radius + b(0)->radius;
    }
    template <class RecordOf, class NextOf>
    static Vec<Number> advance(RecordOf record, NextOf next, double dt, const Vec<Number>& v,
                               const double (&origin)[3])
    {
        next(0)->x = record(0)->x + dt * static_cast<double>(v.x);
        next(0)->y = record(0)->y + dt * static_cast<double>(v.y);
        next(0)->z = record(0)->z + dt * static_cast<double>(v.z);
        return {static_cast<Number>(next(0)->x - origin[0]),
                static_cast<Number>(next(0)->y - origin[1]),
                static_cast<Number>(next(0)->z - origin[2])};
    }
    static Number load(const Number* p) { return *p; }
    template <class RowOf>
    static void gatherRows(RowOf row, std::size_t k, Number (&v)[4])
    {
        for (int c = 0; c < 4; ++c) {
            v[c] = static_cast<Number>(row(0)[k + c]);
        }
    }
    template <class RowOf>
    static void scatterRows(const Row& row, RowOf to, std::size_t k)
    {
        std::copy(row.v, row.v + 4, to(0) + k);
    }
    static void storeSums(const Row& v, const Row& w, Number* p)
    {
        for (int c = 0; c < 4; ++c) {
            p[c] = v.v[c];
            p[c + 4] = w.v[c];
        }
    }
    static std::uint32_t storedSum(std::uint32_t) { return 0; }
    static void addSum(Number* sum, const Number* row)
    {
        for (int c = 0; c < 8; ++c) {
            sum[c] += row[c];
        }
    }
    static Number largest(Number v) { return v; }
    static std::uint32_t bitsOf(bool mask) { return mask; }
    static bool firstLanes(std::uint32_t) { return true; }
    static void appendSlots(bool, std::uint32_t slot, std::uint32_t* out) { *out = slot; }
    static void append(bool, const Vec<Number>& apart, const std::uint32_t* packed,
                       std::uint32_t p, TouchingPairs<Number>& out, std::uint32_t at)
    {
        out.x[at] = apart.x, out.y[at] = apart.y, out.z[at] = apart.z;
        out.packed[at] = *packed;
        out.pair[at] = p;
    }
};

}  // namespace sandflow
