#include "bcre/evolve.h"

#include "bcre/span_blocks.h"
#include "core/errors.h"

#include <algorithm>
#include <cmath>

namespace sandflow {

namespace {

/// Of the limit gamma R dt / dx = 1 at which the upwind slope stops being stable in one dimension;
/// 1/sqrt(2) would be the limit on a diagonal slope.
constexpr double kExchangeCourant = 0.45;
/// On ground flatter than this (tangent) grains hardly roll: without it, rounding noise in h would
/// choose a direction and send them along at full speed.
constexpr double kFlatSlope = 1e-3;
constexpr double kMaxSubsteps = 1e6;

/// Downhill slopes of h [tangent, >= 0] along x and y at every span.
struct Slopes {
    std::vector<double> x, y;
};

/// What one block of spans adds to the report.
struct BlockTotals {
    double eroded = 0.0;      ///< m, summed over spans
    double deposited = 0.0;   ///< m
    double outflow = 0.0;     ///< m
    double deepest = 0.0;     ///< m, largest R
};

struct Workspace {
    Slopes slopes;
    std::vector<double> movedFlow;   ///< m, R after transport
    std::vector<BlockTotals> totals;
};

/// Rouy-Tourin: along each axis the drop to the lower of the two linked neighbours. Erosion digs a
/// slope from its foot, so that is where the information comes from.
/// True where sand reaches the ceiling, to a quarter of a column's edge (grains seldom fill the last
/// diameter): nothing enters there, so the bed beside it has no drop towards it.
bool isFull(const ColumnGrid& columns, std::size_t span)
{
    return columns.h[span] + columns.R[span] >=
           columns.ceiling[span] - 0.25 * columns.cellSize();
}

void findSlopes(const ColumnGrid& columns, Slopes& slopes)
{
    const std::size_t count = columns.spanCount();
    slopes.x.resize(count);
    slopes.y.resize(count);
    const double* h = columns.h.data();
    const double perCell = 1.0 / columns.cellSize();
    forSpanBlocks(count, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            double drop[4];
            for (int direction = 0; direction < 4; ++direction) {
                const std::int32_t other = columns.link[s][direction];
                drop[direction] = other == ColumnGrid::kNone ||
                                          isFull(columns, static_cast<std::size_t>(other))
                                      ? 0.0
                                      : h[s] - h[other];
            }
            slopes.x[s] = std::max({drop[0], drop[1], 0.0}) * perCell;
            slopes.y[s] = std::max({drop[2], drop[3], 0.0}) * perCell;
        }
    });
    for (const ColumnGrid::ExtraLink& extra : columns.extraLinks) {
        if (isFull(columns, static_cast<std::size_t>(extra.other))) {
            continue;
        }
        double& slope = (extra.direction < 2 ? slopes.x : slopes.y)[extra.span];
        slope = std::max(slope, (h[extra.span] - h[extra.other]) * perCell);
    }
}

/// The flow over the face between two spans, as R times the share of v_d that crosses the face.
/// Positive from `s` to `other`. Both spans compute it from the same numbers, so nothing is lost.
double flowAcross(const ColumnGrid& columns, const Slopes& slopes, std::size_t s, std::size_t other,
                  int direction)
{
    const double slope = (columns.h[s] - columns.h[other]) / columns.cellSize();
    if (slope == 0.0) {
        return 0.0;
    }
    // First-order upwind: grains come from the higher bed.
    const std::size_t from = slope > 0.0 ? s : other;
    const std::size_t to = slope > 0.0 ? other : s;
    if (columns.R[from] == 0.0 || isFull(columns, to)) {
        return 0.0;
    }
    // Direction of flow -grad h / |grad h|: the face sees its own normal component, and the
    // tangential one of the span that gives.
    const double across = (direction < 2 ? slopes.y : slopes.x)[from];
    const double share =
        slope / std::sqrt(slope * slope + across * across + kFlatSlope * kFlatSlope);
    return columns.R[from] * share;
}

/// eq. (2) without the exchange: R += -dt div(R v_d), by fluxes over the faces of the columns.
void transportFlow(double speed, double dt, ColumnGrid& columns, Workspace& work)
{
    const std::size_t count = columns.spanCount();
    work.movedFlow.resize(count);
    const double courant = speed * dt / columns.cellSize();
    forSpanBlocks(count, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            double leaving = 0.0;
            for (int direction = 0; direction < 4; ++direction) {
                const std::int32_t other = columns.link[s][direction];
                if (other != ColumnGrid::kNone) {
                    leaving += flowAcross(columns, work.slopes, s, other, direction);
                }
            }
            work.movedFlow[s] = columns.R[s] - courant * leaving;
        }
    });
    for (const ColumnGrid::ExtraLink& extra : columns.extraLinks) {
        work.movedFlow[extra.span] -=
            courant * flowAcross(columns, work.slopes, extra.span, extra.other, extra.direction);
    }
    columns.R.swap(work.movedFlow);
}

/// What of a flowing layer takes part in the exchange: R, or R / (1 + R / xi).
double exchangingDepth(const BcreParams& params, double R)
{
    return params.saturationDepth > 0.0 ? R / (1.0 + R / params.saturationDepth) : R;
}

/// eqs. (1)-(3): dh/dt = -Gamma, dR/dt = +Gamma, Gamma = gamma R (theta - theta0), span by span.
void exchangeLayers(const BcreParams& params, double dt, ColumnGrid& columns, Workspace& work)
{
    const bool tangent = params.slopeForm == SlopeForm::tangent;
    const double neutral = tangent ? std::tan(params.reposeAngle) : params.reposeAngle;
    forSpanBlocks(columns.spanCount(), [&](std::size_t block, std::size_t begin, std::size_t end) {
        BlockTotals& totals = work.totals[block];
        totals.deepest = 0.0;
        for (std::size_t s = begin; s < end; ++s) {
            // Transport gives away at most all of R; what is below zero is rounding.
            const double R = std::max(columns.R[s], 0.0);
            if (columns.sink[s] != 0 || R == 0.0) {
                totals.outflow += R;
                columns.R[s] = 0.0;
                continue;
            }
            const double slope = std::sqrt(work.slopes.x[s] * work.slopes.x[s] +
                                           work.slopes.y[s] * work.slopes.y[s]);
            const double steepness = tangent ? slope : std::atan(slope);
            double eroded = params.exchangeRate * exchangingDepth(params, R) *
                            (steepness - neutral) * dt;
            // The whole change since the start of evolveBcre() stays within +-maxChange, and at
            // most what is there can cross.
            const double changed = columns.dh[s];
            eroded = std::clamp(eroded, changed - params.maxChange, changed + params.maxChange);
            eroded = std::clamp(eroded, -R, std::max(columns.h[s] - columns.floor[s], 0.0));

            columns.h[s] = std::max(columns.h[s] - eroded, columns.floor[s]);
            columns.R[s] = R + eroded;
            columns.dh[s] = changed - eroded;
            (eroded > 0.0 ? totals.eroded : totals.deposited) += std::abs(eroded);
            totals.deepest = std::max(totals.deepest, columns.R[s]);
        }
    });
}

/// Most extra links of one span.
int mostExtraLinks(const ColumnGrid& columns)
{
    int most = 0;
    int run = 0;
    for (std::size_t k = 0; k < columns.extraLinks.size(); ++k) {
        const bool same = k > 0 && columns.extraLinks[k].span == columns.extraLinks[k - 1].span;
        run = same ? run + 1 : 1;
        most = std::max(most, run);
    }
    return most;
}

/// Longest stable substep, s, while R is at most `deepest` [m].
double stableSubstep(const BcreParams& params, const ColumnGrid& columns, double deepest)
{
    const double dx = columns.cellSize();
    double limit = 1e30;
    // gamma R (saturated: at most gamma xi) is the speed at which kinks of h travel uphill.
    const double kinkSpeed = params.exchangeRate * exchangingDepth(params, deepest);
    if (kinkSpeed > 0.0) {
        limit = kExchangeCourant * dx / kinkSpeed;
    }
    // Through every face at most v_d R leaves, so R stays positive if all faces together give R.
    if (params.transport && params.transportSpeed > 0.0) {
        limit = std::min(limit, dx / (params.transportSpeed * (4 + mostExtraLinks(columns))));
    }
    return limit;
}

}  // namespace

void followSurface(ColumnGrid& columns)
{
    forSpanBlocks(columns.spanCount(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            columns.h[s] = std::max(std::min(columns.h[s], columns.H[s]), columns.floor[s]);
            columns.R[s] = std::max(columns.H[s] - columns.h[s], 0.0);
        }
    });
}

BcreReport evolveBcre(const BcreParams& params, double dt, ColumnGrid& columns)
{
    SAND_CHECK(dt >= 0.0 && std::isfinite(dt), "evolution over {} s", dt);
    SAND_CHECK(params.exchangeRate >= 0.0 && params.maxChange >= 0.0 &&
                   params.transportSpeed >= 0.0 && params.saturationDepth >= 0.0,
               "gamma {}, largest change {} m, v_d {} m/s, xi {} m must not be negative",
               params.exchangeRate, params.maxChange, params.transportSpeed,
               params.saturationDepth);
    const std::size_t count = columns.spanCount();
    BcreReport report;
    Workspace work;
    work.totals.resize(spanBlockCount(count));
    std::fill(columns.dh.begin(), columns.dh.end(), 0.0);
    double deepest = 0.0;
    for (const double R : columns.R) {
        deepest = std::max(deepest, R);
    }

    for (double left = dt; left > 0.0 && count > 0;) {
        // A hair less than asked does no harm; a last substep of nearly nothing would be waste.
        const double limit = stableSubstep(params, columns, deepest);
        const double substeps = std::max(std::ceil(left / limit - 1e-9), 1.0);
        if (!(report.substeps + substeps < kMaxSubsteps)) {
            throw PhysicsError(fmt::format(
                "the flowing layer is {:.3g} m deep, too much for surface_flow.exchange_rate {:g} "
                "on columns of {:g} m; lower exchange_rate or raise cell_size",
                deepest, params.exchangeRate, columns.cellSize()));
        }
        const double step = substeps > 1.0 ? left / substeps : left;
        findSlopes(columns, work.slopes);
        if (params.transport) {
            transportFlow(params.transportSpeed, step, columns, work);
        }
        exchangeLayers(params, step, columns, work);
        deepest = 0.0;
        for (const BlockTotals& totals : work.totals) {
            deepest = std::max(deepest, totals.deepest);
        }
        left -= step;
        ++report.substeps;
    }
    if (params.transport) {
        for (std::size_t s = 0; s < count; ++s) {
            columns.H[s] = columns.h[s] + columns.R[s];
        }
    }

    const double cellArea = columns.cellSize() * columns.cellSize();
    for (const BlockTotals& totals : work.totals) {
        report.erodedVolume += cellArea * totals.eroded;
        report.depositedVolume += cellArea * totals.deposited;
        report.outflowVolume += cellArea * totals.outflow;
    }
    if (!std::isfinite(report.erodedVolume + report.depositedVolume + report.outflowVolume)) {
        throw PhysicsError("the height of the static bed or of the flowing layer is not a number; "
                           "grains probably exploded, try a smaller time.step");
    }
    return report;
}

void enforceMinFlowDepth(const BcreParams& params, ColumnGrid& columns)
{
    forSpanBlocks(columns.spanCount(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            // Shallower than R_min: all of it is mobile.
            const double depth = std::max(columns.H[s] - columns.floor[s], 0.0);
            columns.R[s] = std::min(std::max(columns.R[s], params.minFlowDepth), depth);
            columns.h[s] = std::max(columns.H[s] - columns.R[s], columns.floor[s]);
        }
    });
}

void upwindSlope(const ColumnGrid& columns, std::vector<double>& theta)
{
    Slopes slopes;
    findSlopes(columns, slopes);
    theta.resize(columns.spanCount());
    for (std::size_t s = 0; s < theta.size(); ++s) {
        theta[s] = std::atan(std::sqrt(slopes.x[s] * slopes.x[s] + slopes.y[s] * slopes.y[s]));
    }
}

}  // namespace sandflow
