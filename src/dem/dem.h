#pragma once

#include "dem/contact_book.h"
#include "dem/contact_coefficients.h"
#include "dem/contact_lists.h"
#include "dem/force_kernel.h"
#include "grains/fixed_grains.h"
#include "grains/frozen_info.h"
#include "grains/mobile_grains.h"
#include "solids/primitive.h"
#include "solids/rough_cover.h"

#include <memory>
#include <span>
#include <vector>

namespace sandflow {

/// Fixed particles that stand for the surface of a mesh.
struct MeshCover {
    double from = 0.0, until = 1e30;  ///< s
    std::span<const Vec3> centres;    ///< m; owned by the caller
    double radius = 0.0;              ///< m

    bool existsAt(double time) const { return time >= from && time < until; }
};

/// What the grain solver is made from. SI.
struct DemSetup {
    ContactCoefficients law;
    double meanRadius = 0.005;
    double largestRadius = 0.0054;
    double density = 2600.0;
    Vec3 gravity = Vec3(0.0, 0.0, -kGravity);
    std::vector<Primitive> primitives;
    std::vector<MeshCover> meshCovers;
    std::uint64_t seed = 1;
    double skin = 0.3;          ///< in mean radii: how far a resting grain may move before lists end
    bool judged = true;         ///< mobile grains keep clocks of rest and loads (surface flow)
    double longestHorizon = 64;  ///< T of the contact lists, in steps, at the most
    /// In mean radii, see RoughCover. Wide: as rough as grains glued side by side, yet tight (a grain
    /// would pass at an overlap of 0.5). At 0.85 the lowest grains of a poured heap still slid at
    /// 9 mm/s.
    double roughGap = 1.5;
};

/// Step 3 of the method: soft spheres. Owns every grain that is computed or pushes: mobile, frozen
/// (interface, asleep) and the particles of rough solids.
///
/// Sets of grains change only between recordContacts() and rebuild(), but for mobile grains that come
/// in; steps are taken only while listsHold().
template <class Real>
class Dem {
public:
    explicit Dem(const DemSetup& setup);

    /// Before any change of the sets: keeps the springs of all live contacts, by id, and ends the
    /// lists. Nothing happens if that was done since the last rebuild.
    void recordContacts();
    /// Wipes the springs that recordContacts() kept: all contacts begin anew.
    void forgetContacts();
    /// While the lists hold it is put into them as well; where that cannot be, they hold no longer.
    void addMobile(const Vec3& position, const Vec3& velocity, const Vec3& spin, double radius,
                   std::uint32_t id);
    /// Sorts, covers rough solids and lists contacts; afterwards listsHold().
    void rebuild(double time, double dt);
    bool listsHold() const { return listsHold_; }

    /// One step; `observe` fills mobile().load. Throws PhysicsError when a grain is lost to
    /// infinity.
    void step(double dt, bool observe);

    MobileGrains<Real>& mobile() { return mobile_; }
    const MobileGrains<Real>& mobile() const { return mobile_; }
    FixedGrains<Real, FrozenInfo>& frozen() { return frozen_; }
    const FixedGrains<Real, FrozenInfo>& frozen() const { return frozen_; }
    const FixedGrains<Real, BoundaryInfo>& boundary() const { return boundary_; }
    const ContactLists<Real>& lists() const { return lists_; }
    /// s, when the lists were last made: which solids exist for the grains.
    double listTime() const { return listTime_; }
    const DemSetup& setup() const { return setup_; }

    GrainRecord<Real> makeRecord(const Vec3& position, double radius, std::uint32_t id) const;
    double massOf(double radius) const;

    /// Frozen grains (index) that were pushed beyond their wakeForce since the last rebuild, in a
    /// fixed order, possibly repeated. recordContacts() notes them in FrozenInfo::wakes.
    const std::vector<std::uint32_t>& wakeRequests() const { return wakeRequests_; }

    double deepestOverlap() const { return deepestOverlap_; }  ///< m, since resetExtremes()
    double latestOverlap() const { return latestOverlap_; }    ///< m, in the last step
    double fastestSpeed() const { return fastestSpeed_; }      ///< m/s, in the last step
    void resetExtremes() { deepestOverlap_ = 0.0; }
    std::uint64_t rebuilds() const { return rebuilds_; }
    std::uint64_t strays() const { return strays_; }  ///< searched alone, between rebuilds
    std::uint64_t listedPairs() const;
    std::size_t bytes() const;

private:
    double chooseHorizon(double dt) const;
    void followStrays();
    void listNewcomer();
    bool hasRoomFor(const SearchBall& ball) const;
    bool isCovered(const Vec3& centre, double range) const;
    void coverMeshes(double time);
    void coverRoughSolids(const SortedCells& cells, double time);

    DemSetup setup_;
    MobileGrains<Real> mobile_;
    FixedGrains<Real, FrozenInfo> frozen_;
    FixedGrains<Real, BoundaryInfo> boundary_;
    ContactLists<Real> lists_;
    ContactBook<Real> book_;
    std::unique_ptr<ForceKernel<Real>> kernel_, observingKernel_;
    std::vector<ChunkReport> reports_;
    std::vector<std::uint32_t> wakeRequests_;

    struct Cover {
        std::size_t primitive;
        RoughCover cover;
        CellMap made;
    };
    std::vector<Cover> covers_;            ///< of rough planes
    std::vector<std::uint8_t> meshStands_;  ///< 1: the particles of that mesh are there
    std::uint32_t boundaryIds_ = 0;

    bool listsHold_ = false;
    bool contactsRecorded_ = false;  ///< since the last rebuild
    double listTime_ = 0.0;  ///< s, for which the lists were made
    std::uint64_t strays_ = 0;
    double deepestOverlap_ = 0.0, latestOverlap_ = 0.0, fastestSpeed_ = 0.0;
    std::uint64_t rebuilds_ = 0;
};

}  // namespace sandflow
