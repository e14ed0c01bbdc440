#pragma once

#include "bcre/columns.h"
#include "dem/dem.h"

#include <vector>

namespace sandflow {

/// Sand that something is about to strike: all of it must be able to move before the blow falls,
/// for what is fixed gives a striking grain no time, it throws it back like a rock.
struct ImpactZone {
    Vec3 centre;          ///< m, on the surface of the sand
    double radius = 0.0;  ///< m

    bool holds(const Vec3& point) const
    {
        return (point - centre).squaredNorm() < radius * radius;
    }
};

/// Foresees where grains in flight (see flight_judge.h) will meet the surface H of the sand. A zone
/// is as wide as the widest of the grains that strike there, and besides as far as the larger of
/// - where their energy E could lift sand: half a ball of radius L, heaved by L, takes
///   E = 2/3 pi rho g L^4. What strikes within L in the same interval adds to it;
/// - where the force F with which they press, beyond what has long pressed there, adds noticeably to
///   the weight of the sand: Boussinesq's stress under a point load, 3 F / (2 pi P^2), is a fifth
///   of rho g P. A heap on which a burst falls is pushed apart to its foot, while under a jet
///   that has built it sand has come to rest under that very load.
/// Zones of less than a grain are left out: what lands so gently wakes by its weight what it must.
class ImpactWatch {
public:
    /// Of what strikes within `interval` [s]; the last call was as long ago.
    template <class Real>
    std::vector<ImpactZone> foresee(double interval, const ColumnGrid& columns,
                                    const Dem<Real>& dem);

private:
    /// What strikes one span, or several near each other.
    struct Strike {
        double energy = 0.0;         ///< J
        double widest = 0.0;         ///< m, radius
        Vec3 moment = Vec3::Zero();  ///< J m, of the places where the surface is met
        double momentum = 0.0;       ///< kg m/s, sum of |m v|

        Vec3 centre() const { return moment / energy; }
        /// L [m], in sand of this weight [N/m3].
        double heaved(double weight) const;
        void add(const Strike& other);
    };
    /// A share of a force that pressed on the surface some time ago, the smaller the longer ago.
    struct UsualForce {
        Vec3 at;       ///< m
        double force;  ///< N
    };

    static std::vector<Strike> gather(double weight, const std::vector<Strike>& bySpan);
    double usualNear(const Vec3& centre, double reach) const;

    std::vector<UsualForce> usual_;
};

/// Marks the frozen grains in the zones to be set free at the next transfer.
template <class Real>
void wakeZones(const std::vector<ImpactZone>& zones, Dem<Real>& dem);

}  // namespace sandflow
