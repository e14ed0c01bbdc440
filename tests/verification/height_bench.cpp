#include "verification/height_bench.h"

#include "core/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandflow::verification {

namespace {

constexpr double kLeastOrder = 0.9;
constexpr double kSaturationDepth = 1e-7;  ///< m

}  // namespace

BcreParams makeExactParams(double exchangeRate, double neutralSlope, double speed)
{
    BcreParams params;
    params.exchangeRate = exchangeRate;
    params.reposeAngle = std::atan(neutralSlope);
    params.slopeForm = SlopeForm::tangent;
    params.maxChange = 1e9;
    params.minFlowDepth = 0.0;
    params.transport = true;
    params.transportSpeed = speed;
    return params;
}

BcreParams makeSaturatedParams(double uphillSpeed, double neutralSlope, double speed)
{
    BcreParams params =
        makeExactParams(uphillSpeed / kSaturationDepth, neutralSlope, speed);
    params.saturationDepth = kSaturationDepth;
    return params;
}

HeightBench::HeightBench(ColumnGrid columns, const BcreParams& params)
    : columns_(std::move(columns)), params_(params), before_(volume())
{
}

HeightBench::Wide HeightBench::volume() const
{
    Wide depth = 0.0;
    for (std::size_t s = 0; s < columns_.spanCount(); ++s) {
        depth += columns_.h[s] + columns_.R[s];
    }
    return depth * columns_.cellSize() * columns_.cellSize();
}

void HeightBench::feed(std::size_t span, double depth)
{
    columns_.R[span] += depth;
    columns_.H[span] += depth;
    fed_ += Wide(depth) * columns_.cellSize() * columns_.cellSize();
}

void HeightBench::advance(double dt)
{
    followSurface(columns_);
    outflow_ = evolveBcre(params_, dt, columns_).outflowVolume;
    enforceMinFlowDepth(params_, columns_);
    gone_ += outflow_;
    ++advances_;
}

double HeightBench::lostShare() const
{
    const Wide lost = std::abs(volume() - (before_ + fed_ - gone_)) / (before_ + fed_);
    return static_cast<double>(lost / std::max(advances_, 1));
}

HeightBench makeStrip(const BcreParams& params, double length, int count, bool open,
                      const std::function<double(double)>& bed,
                      const std::function<double(double)>& flow)
{
    const double cell = length / count;
    ColumnGrid columns = testing::makeFlatBox(count + (open ? 1 : 0), 1, cell);
    const double origin = open ? cell : 0.0;
    testing::fill(
        columns, [&](double x, double) { return bed(x - origin); },
        [&](double x, double) { return flow(x - origin); });
    if (open) {
        const std::size_t foot = testing::at(columns, 0);
        columns.sink[foot] = 1;
        columns.R[foot] = 0.0;
        columns.H[foot] = columns.h[foot];
    }
    return {std::move(columns), params};
}

double slopeBelow(const ColumnGrid& columns, int i)
{
    return (columns.h[testing::at(columns, i)] - columns.h[testing::at(columns, i - 1)])
           / columns.cellSize();
}

double observedOrder(const std::vector<double>& errors)
{
    SAND_CHECK(errors.size() >= 3, "an order from {} grids", errors.size());
    return std::log2(errors[errors.size() - 2] / errors.back());
}

void judgeOrder(const std::string& name, const std::vector<double>& cells,
                const std::vector<double>& errors, std::vector<Verdict>& verdicts, Gate gate)
{
    for (std::size_t k = 0; k < errors.size(); ++k) {
        verdicts.push_back({fmt::format("{}: error, columns of {:.4g} mm", name, 1e3 * cells[k]),
                            0.0, errors[k], Gate::report});
    }
    verdicts.push_back({name + ": observed order", kLeastOrder, observedOrder(errors), gate});
}

}  // namespace sandflow::verification
