#pragma once

#include "bcre/evolve.h"
#include "bcre/test_fields.h"
#include "verification/verdict.h"

#include <vector>

/// Columns put through step 2 of the method as scenes run it, with the transport of eq. (2), for
/// there are no grains here to carry the flow.
namespace sandflow::verification {

/// Columns of scenes with the default grains: 3 d, and the interval of their updates.
constexpr double kSceneCell = 0.03;      ///< m
constexpr double kSceneInterval = 0.02;  ///< s

/// Of sand, share in one update: a few roundings.
constexpr double kLeastLoss = 1e-15;

/// The exact solutions are those of the tangent law, without limit on dh.
BcreParams makeExactParams(double exchangeRate, double neutralSlope, double speed);
/// The same with a saturated exchange: kinks travel uphill at uphillSpeed [m/s] = gamma xi whatever
/// R. xi [m] is far below any R of these cases.
BcreParams makeSaturatedParams(double uphillSpeed, double neutralSlope, double speed);

/// A height field that is fed and keeps its books.
class HeightBench {
public:
    HeightBench(ColumnGrid columns, const BcreParams& params);

    /// Raises the flow of a span by `depth` [m].
    void feed(std::size_t span, double depth);
    /// The paper's order: h follows H, evolution, R_min (which is 0 here).
    void advance(double dt);

    ColumnGrid& columns() { return columns_; }
    const ColumnGrid& columns() const { return columns_; }
    double outflow() const { return outflow_; }  ///< m3 in the last advance
    /// |sand now - (sand before + fed - gone)| over what there was in all, per advance.
    double lostShare() const;

private:
    /// Books are kept in a wider type than the field: millions of small sums would else be what
    /// lostShare() shows.
    using Wide = long double;
    Wide volume() const;

    ColumnGrid columns_;
    BcreParams params_;
    Wide before_ = 0.0, fed_ = 0.0, gone_ = 0.0;  ///< m3
    double outflow_ = 0.0;                        ///< m3
    int advances_ = 0;
};

/// Strip of columns along x with h and R given at their centres. The foot at x = 0 is a wall, or
/// `open`: one column more, centred at -dx/2, keeps its h and takes all flow out of the field.
HeightBench makeStrip(const BcreParams& params, double length, int count, bool open,
                      const std::function<double(double)>& bed,
                      const std::function<double(double)>& flow);

/// Slope of h between column i - 1 and i of a strip, tangent.
double slopeBelow(const ColumnGrid& columns, int i);

/// Errors on grids of halved columns; the order that the last two show.
double observedOrder(const std::vector<double>& errors);

/// "name: error, columns of 5 mm" for each grid, reported, then the observed order, which should be
/// 0.9 at least.
void judgeOrder(const std::string& name, const std::vector<double>& cells,
                const std::vector<double>& errors, std::vector<Verdict>& verdicts,
                Gate gate = Gate::atLeast);

}  // namespace sandflow::verification
