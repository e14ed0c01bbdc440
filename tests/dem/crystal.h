#pragma once

#include "contact_rig.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <random>
#include <tuple>
#include <vector>

/// Crystals of equal spheres of unit mass and diameter under the linear law: the exact stability
/// limit of symplectic Euler from their Bloch modes, and the crystal itself, stepped.
namespace sandflow::rig {

enum class Lattice { simpleCubic, bodyCentred, faceCentred };

/// Unit vectors to the touching neighbours, as integers before scaling.
inline std::vector<std::array<int, 3>> neighbourOffsets(Lattice lattice)
{
    const int wanted = lattice == Lattice::simpleCubic   ? 1
                       : lattice == Lattice::faceCentred ? 2
                                                         : 3;
    std::vector<std::array<int, 3>> offsets;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                if (std::abs(x) + std::abs(y) + std::abs(z) == wanted) {
                    offsets.push_back({x, y, z});
                }
            }
        }
    }
    return offsets;
}

// ---------------------------------------------------------------- the coupled modes of a crystal

using Matrix6 = Eigen::Matrix<std::complex<double>, 6, 6>;
using Matrix12 = Eigen::Matrix<std::complex<double>, 12, 12>;
using Matrix36 = Eigen::Matrix<std::complex<double>, 3, 6>;

/// Mass-weighted stiffness (or damping) of displacement and spin for the Bloch phase given per
/// lattice offset; radius 1/2, mass 1. normal, tangential, rolling: k or c of one contact.
inline Matrix6 blochMatrix(Lattice lattice, const Eigen::Vector3d& phase, double normal,
                    double tangential, double rolling)
{
    Matrix6 sum = Matrix6::Zero();
    for (const auto& offset : neighbourOffsets(lattice)) {
        const Eigen::Vector3d step(offset[0], offset[1], offset[2]);
        const Eigen::Vector3d n = step.normalized();
        const std::complex<double> other = std::polar(1.0, phase.dot(step));
        const Eigen::Matrix3d along = n * n.transpose();
        const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
        Eigen::Matrix3d arm;  // omega x n R as a matrix on omega
        arm << 0.0, n.z(), -n.y(), -n.z(), 0.0, n.x(), n.y(), -n.x(), 0.0;
        arm *= 0.5;
        Matrix36 relative;
        relative << (1.0 - other) * Eigen::Matrix3d::Identity(), (1.0 + other) * arm;
        Matrix36 turn = Matrix36::Zero();
        turn.rightCols<3>() = (1.0 - other) * across;
        const Matrix36 stretch = along * relative;
        const Matrix36 slip = across * relative;
        sum += 0.5 * (normal * stretch.adjoint() * stretch + tangential * slip.adjoint() * slip
                      + rolling * turn.adjoint() * turn);
    }
    Eigen::Matrix<double, 6, 1> weight;  // 1 / sqrt(m), 1 / sqrt(I)
    weight << 1.0, 1.0, 1.0, std::sqrt(10.0), std::sqrt(10.0), std::sqrt(10.0);
    return weight.asDiagonal() * sum * weight.asDiagonal();
}

/// Largest |eigenvalue| of one step of symplectic Euler.
inline double amplification(const Matrix6& stiffness, const Matrix6& damping, double dt)
{
    Matrix12 step = Matrix12::Zero();
    step.bottomLeftCorner<6, 6>() = -dt * stiffness;
    step.bottomRightCorner<6, 6>() = Matrix6::Identity() - dt * damping;
    step.topRows<6>() = dt * step.bottomRows<6>();
    step.topLeftCorner<6, 6>() += Matrix6::Identity();
    return Eigen::ComplexEigenSolver<Matrix12>(step, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// The largest dt at which no coupled mode of the crystal grows, over a grid of phases.
inline double crystalLimit(Lattice lattice, const ContactCoefficients& law)
{
    constexpr int kGrid = 8;
    const auto normal = evaluateNormal<NormalLaw::linear>(LawNumbers<double>(law), 0.01, 0.0, 0.5,
                                                          0.25);
    const double cn = normal.dashpot;
    const double kr = law.rollingStiffness * 0.25 * 0.25;
    const double cr = 2.0 * law.rollingDamping * std::sqrt(0.5 * (0.1 + 0.25) * kr);
    double limit = 3.0;
    for (int a = 0; a <= kGrid; ++a) {
        for (int b = 0; b <= a; ++b) {
            for (int c = 0; c <= b; ++c) {
                const Eigen::Vector3d phase = Eigen::Vector3d(a, b, c) * kPi / kGrid;
                const Matrix6 k = blochMatrix(lattice, phase, 1.0, law.tangentialRatio, kr);
                const Matrix6 d = blochMatrix(lattice, phase, cn, law.tangentialDamping * cn, cr);
                if (amplification(k, d, limit) < 1.0 + 1e-7) {
                    continue;
                }
                double low = 0.0;
                while (limit - low > 1e-6) {
                    const double middle = 0.5 * (low + limit);
                    (amplification(k, d, middle) > 1.0 + 1e-7 ? limit : low) = middle;
                }
            }
        }
    }
    return limit;
}

// ------------------------------------------------------------------------------- a stepped crystal

/// A periodic crystal of grains of unit mass and diameter, run with the kernel's own law. Contacts
/// are those of the lattice for ever, which is what an infinitesimal disturbance sees.
class Crystal {
public:
    Crystal(Lattice lattice, int edge, const ContactCoefficients& law)
        : law_(law), numbers_(law), offsets_(neighbourOffsets(lattice)), edge_(edge),
          site_(static_cast<std::size_t>(8 * edge * edge * edge), -1)
    {
        const int span = 2 * edge_;  // in steps of a neighbour offset
        std::vector<std::array<int, 3>> cells;
        for (int x = 0; x < span; ++x) {
            for (int y = 0; y < span; ++y) {
                for (int z = 0; z < span; ++z) {
                    const bool used = lattice == Lattice::simpleCubic ? true
                                      : lattice == Lattice::faceCentred
                                          ? (x + y + z) % 2 == 0
                                          : x % 2 == y % 2 && y % 2 == z % 2;
                    if (used) {
                        site_[index(x, y, z)] = static_cast<int>(cells.size());
                        cells.push_back({x, y, z});
                    }
                }
            }
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            for (const auto& o : offsets_) {
                const auto wrap = [&](int q) { return (q + span) % span; };
                const int j = site_[index(wrap(cells[i][0] + o[0]), wrap(cells[i][1] + o[1]),
                                          wrap(cells[i][2] + o[2]))];
                // Each contact once: the offsets come in opposite pairs.
                if (std::make_tuple(o[0], o[1], o[2]) > std::make_tuple(0, 0, 0)) {
                    const double scale =
                        1.0 / std::sqrt(std::abs(o[0]) + std::abs(o[1]) + std::abs(o[2]));
                    contacts_.push_back({static_cast<int>(i), j,
                                         Real3{scale * o[0], scale * o[1], scale * o[2]}, {}, {}});
                }
            }
        }
        displacement_.resize(cells.size());
        velocity_.resize(cells.size());
        spin_.resize(cells.size());
        std::mt19937 random(7);
        std::uniform_real_distribution<double> kick(-1e-9, 1e-9);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            velocity_[i] = {kick(random), kick(random), kick(random)};
            spin_[i] = {kick(random), kick(random), kick(random)};
        }
    }

    void step(double dt)
    {
        constexpr double kPressed = 0.01;  // overlap of the crystal at rest; its forces cancel
        std::vector<Real3> force(velocity_.size());
        std::vector<Real3> torque(velocity_.size());
        for (Contact& c : contacts_) {
            const auto i = static_cast<std::size_t>(c.i);
            const auto j = static_cast<std::size_t>(c.j);
            const Real3 relative = velocity_[i] - velocity_[j];
            const double overlap = kPressed + dot(displacement_[i] - displacement_[j], c.n);
            const auto normal = evaluateNormal<NormalLaw::linear>(
                numbers_, overlap, dot(relative, c.n), 0.5, 0.25);
            const Real3 slip =
                projectOff(relative, c.n) + cross(0.5 * (spin_[i] + spin_[j]), c.n);
            const auto tangential =
                evaluateTangential(numbers_, c.spring, slip, normal.force,
                                   normal.tangentStiffness, normal.dashpot, dt);
            const auto rolling = evaluateRolling(
                numbers_, c.rollingSpring, 0.25 * projectOff(spin_[i] - spin_[j], c.n),
                normal.force, normal.tangentStiffness, 0.25, 0.175 / (0.25 * 0.25), dt);
            c.spring = tangential.spring;
            c.rollingSpring = rolling.spring;
            const Real3 push = tangential.force - normal.force * c.n;
            force[i] += push;
            force[j] -= push;
            const Real3 twist = cross(0.5 * c.n, tangential.force);
            torque[i] += twist + rolling.torque;
            torque[j] += twist - rolling.torque;
        }
        for (std::size_t i = 0; i < velocity_.size(); ++i) {
            velocity_[i] += dt * force[i];
            spin_[i] += (dt / 0.1) * torque[i];
            displacement_[i] += dt * velocity_[i];
        }
    }

    double motion() const
    {
        double sum = 0.0;
        for (std::size_t i = 0; i < velocity_.size(); ++i) {
            sum += dot(velocity_[i], velocity_[i]) + 0.1 * dot(spin_[i], spin_[i]);
        }
        return std::sqrt(sum);
    }

    /// Growth of the motion over many steps; far above 1 when unstable.
    static double growth(Lattice lattice, const ContactCoefficients& law, double dt)
    {
        Crystal crystal(lattice, 2, law);
        const double before = crystal.motion();
        for (int i = 0; i < 300 && crystal.motion() < 1e4 * before; ++i) {
            crystal.step(dt);
        }
        return crystal.motion() / before;
    }

private:
    struct Contact {
        int i, j;
        Real3 n;
        Real3 spring;
        Real3 rollingSpring;
    };

    std::size_t index(int x, int y, int z) const
    {
        return static_cast<std::size_t>((x * 2 * edge_ + y) * 2 * edge_ + z);
    }

    ContactCoefficients law_;
    LawNumbers<double> numbers_;
    std::vector<std::array<int, 3>> offsets_;
    int edge_;
    std::vector<int> site_;
    std::vector<Contact> contacts_;
    std::vector<Real3> displacement_, velocity_, spin_;
};

}  // namespace sandflow::rig
