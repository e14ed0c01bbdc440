#pragma once

#include "dem/chunk_pass.h"
#include "dem/record_rows.h"

#include <algorithm>

namespace sandflow {

/// Motion of a chunk's grains over dt, symplectic Euler:
///     v += dt (F / m + g),  omega += dt T / I,  x += dt v.
/// Lanes as in ContactPass, and for the same reason; besides
///
///   advance(record, next, dt, v, origin)
///                                 next.x = record.x + dt v in double; returns next.x - origin,
///                                 rounded
template <class Lanes>
class MotionPass {
    using Number = typename Lanes::Number;
    using Real = typename Lanes::Real;
    using Record = GrainRecord<Number>;
    using Rows = RecordRows<Lanes>;
    static constexpr std::uint32_t kWidth = Lanes::width;
    static constexpr std::uint32_t kAhead = 64;  ///< records to be written are asked for so early

public:
    static void run(MotionWork<Number>& work)
    {
        MotionPass pass(work);
        for (std::uint32_t begin = 0; begin < work.count; begin += kWidth) {
            pass.move(begin);
        }
        work.fastestSquared = static_cast<float>(Lanes::largest(pass.fastest_));
    }

private:
    explicit MotionPass(MotionWork<Number>& work)
        : work_(work),
          dt_(static_cast<Number>(work.dt)),
          gravity_{Real(static_cast<Number>(work.gravity[0])),
                   Real(static_cast<Number>(work.gravity[1])),
                   Real(static_cast<Number>(work.gravity[2]))},
          fastest_(Number(0))
    {
        work.leftCount = 0;
        work.broke = false;
        work.brokenGrain = 0;
    }

    [[gnu::flatten]] void move(std::uint32_t begin)
    {
        for (std::uint32_t l = 0; l < kWidth && begin + kAhead + l < work_.count; ++l) {
            __builtin_prefetch(work_.next + begin + kAhead + l, 1);
        }
        if (work_.count - begin >= kWidth) [[likely]] {
            moveLanes([begin](std::size_t l) { return begin + l; });
        } else {  // idle lanes repeat the last grain
            moveLanes([begin, last = work_.count - 1](std::size_t l) {
                return std::min<std::size_t>(begin + l, last);
            });
        }
    }

    /// slot(l) is the grain of lane l.
    template <class SlotOf>
    void moveLanes(SlotOf slot)
    {
        const auto record = [&](std::size_t l) { return work_.record + slot(l); };
        const auto next = [&](std::size_t l) { return work_.next + slot(l); };
        const auto sum = [&](std::size_t l) { return &work_.sums[slot(l)].fx; };
        const auto ball = [&](std::size_t l) { return work_.ball + 4 * slot(l); };
        ContactSide<Real> g = Rows::gather(record);
        Real force[4], torque[4];
        Lanes::gatherRows(sum, 0, force);
        Lanes::gatherRows(sum, 4, torque);

        g.velocity += dt_ * (g.inverseMass * Vec<Real>{force[0], force[1], force[2]} + gravity_);
        // I = 2/5 m R^2
        const Real turn = Real(2.5) * g.inverseMass / (g.radius * g.radius) * dt_;
        g.spin += turn * Vec<Real>{torque[0], torque[1], torque[2]};
        const Vec<Real> place = Lanes::advance(record, next, work_.dt, g.velocity, work_.origin);
        Rows::scatter(g, next);
        for (std::uint32_t l = 0; l < kWidth; ++l) {
            next(l)->id = record(l)->id;
            next(l)->wakeForce = record(l)->wakeForce;
        }

        Real c[4];
        Lanes::gatherRows(ball, 0, c);
        const Vec<Real> off = place - Vec<Real>{c[0], c[1], c[2]};
        const Real away = dot(off, off);
        const std::uint32_t left = Lanes::bitsOf(away > c[3] * c[3]);
        if (left != 0) [[unlikely]] {
            noteLeft(left, slot);
        }
        // Far outside its ball within one step, or not a number at all: nothing physical.
        const Real limit = c[3] + g.radius;
        const std::uint32_t broken = Lanes::bitsOf(!(away < Real(100) * limit * limit));
        if (broken != 0) [[unlikely]] {
            work_.broke = true;
            const std::uint32_t lane = 31u - static_cast<std::uint32_t>(__builtin_clz(broken));
            work_.brokenGrain = static_cast<std::uint32_t>(slot(lane));
        }
        using std::max;
        fastest_ = max(fastest_, dot(g.velocity, g.velocity));
    }

    /// Idle lanes repeat the last grain, which is noted once.
    template <class SlotOf>
    void noteLeft(std::uint32_t lanes, SlotOf slot)
    {
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto at =
                static_cast<std::uint16_t>(slot(static_cast<std::size_t>(__builtin_ctz(lanes))));
            if (work_.leftCount == 0 || work_.left[work_.leftCount - 1] != at) {
                work_.left[work_.leftCount++] = at;
            }
        }
    }

    MotionWork<Number>& work_;
    const Real dt_;
    const Vec<Real> gravity_;
    Real fastest_;
};

}  // namespace sandflow
