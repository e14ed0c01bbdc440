#include "verification/height_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Hadeler & Kuttler 1999: tables with open edges under a steady source f. At rest the bed is
/// u = alpha dist(x, edge), the flow v as below (Cannarsa & Cardaliaguet 2004). Their alpha beta is
/// our v_d: flow runs at v_d down the slope of the bed.
namespace sandflow::verification {
namespace {

constexpr double kAlpha = 0.5;     ///< neutral slope
constexpr double kSource = 0.5;    ///< m/s, f
constexpr double kSpeed = 1.0;     ///< m/s, v_d
constexpr double kExchange = 20.0; ///< 1/s, gamma
constexpr double kBedTolerance = 0.005;  ///< mean error over the height of the bed
constexpr double kFlowTolerance = 0.02;  ///< of mean flows over rings
constexpr double kRing = 0.1;            ///< m

/// A table within the unit distance of the origin, and what it should carry.
struct Table {
    std::function<double(double x, double y)> inside;  ///< m from the edge, negative beyond
    std::function<double(double x, double y)> source;  ///< m/s
    std::function<double(double x, double y)> flow;    ///< m, exact v
    double innermost = 0.0;  ///< m from the centre, where v begins to be compared
    double time = 5.0;       ///< s, until it stands
    bool isStrip = false;
};

struct TableErrors {
    double cell = 0.0;       ///< m
    double bed = 0.0;        ///< mean |u - exact| over alpha
    double flow = 0.0;       ///< mean |v - exact| over the mean of v
    double ringFlow = 0.0;   ///< the same of means over rings
    double apex = 0.0;       ///< m, u at the centre
    double lost = 0.0;
    double unrest = 0.0;     ///< m/s, fastest change of the bed at the end
};

/// Odd count: a column's centre is at the origin, and the outermost columns lie on the edge or
/// beyond. There the floor goes on along the bed, so that the edge is not the outline of columns.
TableErrors pour(const Table& table, int count, double dt)
{
    const double cell = 2.0 / (count - 1);
    const double middle = 0.5 * count * cell;
    const double middleY = table.isStrip ? 0.5 * cell : middle;
    ColumnGrid columns =
        testing::makeBox(count, table.isStrip ? 1 : count, cell, [&](double x, double y) {
            return std::min(0.0, kAlpha * table.inside(x - middle, y - middleY));
        });
    std::vector<Vec2> place(columns.spanCount());
    std::vector<double> fed(columns.spanCount());
    for (std::size_t s = 0; s < columns.spanCount(); ++s) {
        place[s] = Vec2((columns.columnI[s] + 0.5) * cell - middle,
                        (columns.columnJ[s] + 0.5) * cell - middleY);
        columns.sink[s] = table.inside(place[s].x(), place[s].y()) <= 1e-9;
        fed[s] = table.source(place[s].x(), place[s].y()) * dt;
    }
    HeightBench bench(std::move(columns), makeExactParams(kExchange, kAlpha, kSpeed));
    const int steps = static_cast<int>(std::lround(table.time / dt));
    std::vector<double> before;
    for (int k = 0; k < steps; ++k) {
        before = bench.columns().h;
        for (std::size_t s = 0; s < fed.size(); ++s) {
            bench.feed(s, fed[s]);
        }
        bench.advance(dt);
    }
    const ColumnGrid& at = bench.columns();
    TableErrors errors;
    errors.cell = cell;
    errors.lost = bench.lostShare();
    int bedSeen = 0;
    double exactFlow = 0.0;
    std::vector<double> rings(static_cast<std::size_t>(2.0 / kRing));
    for (std::size_t s = 0; s < at.spanCount(); ++s) {
        if (at.sink[s] != 0) {
            continue;
        }
        const double x = place[s].x(), y = place[s].y();
        errors.bed += std::abs(at.h[s] - kAlpha * table.inside(x, y)) / kAlpha;
        ++bedSeen;
        errors.unrest = std::max(errors.unrest, std::abs(at.h[s] - before[s]) / dt);
        if (std::hypot(x, y) < 0.1 * cell) {
            errors.apex = at.h[s];
        }
        const double radius = std::hypot(x, y);
        if (radius > table.innermost) {
            const double exact = table.flow(x, y);
            errors.flow += std::abs(at.R[s] - exact);
            rings[static_cast<std::size_t>((radius - table.innermost) / kRing)] += at.R[s] - exact;
            exactFlow += exact;
        }
    }
    for (const double ring : rings) {
        errors.ringFlow += std::abs(ring) / exactFlow;
    }
    errors.bed /= bedSeen;
    errors.flow /= exactFlow;
    return errors;
}

/// What is judged of the flow besides that it is reported column by column.
enum class FlowGate { orderOfColumns, orderOfRings, errorOfRings };

void judgeTable(const std::string& name, const Table& table, const std::vector<int>& counts,
                FlowGate gate, std::vector<Verdict>& verdicts)
{
    std::vector<double> cells, bed, flow, ringFlow;
    TableErrors finest;
    for (const int count : counts) {
        finest = pour(table, count, 0.25 * 2.0 / (count - 1) / kSpeed);
        cells.push_back(finest.cell);
        bed.push_back(finest.bed);
        flow.push_back(finest.flow);
        ringFlow.push_back(finest.ringFlow);
    }
    // As near to the columns of scenes as an odd count comes.
    const TableErrors scene =
        pour(table, 2 * static_cast<int>(1.0 / kSceneCell) + 1, kSceneInterval);
    verdicts.push_back({name + "apex of the bed [m]", kAlpha, finest.apex, Gate::report, 0.0,
                        scene.apex});
    verdicts.push_back({name + "unrest of the bed [m/s]", 1e-4, finest.unrest, Gate::atMost, 0.0,
                        scene.unrest});
    verdicts.push_back({name + "sand lost in an update, share", kLeastLoss, finest.lost,
                        Gate::atMost, 0.0, scene.lost});
    verdicts.push_back({name + "bed: mean error over its height", kBedTolerance, finest.bed,
                        Gate::atMost, 0.0, scene.bed});
    // Where the edge runs along the columns of a strip the upwind slope is exact.
    if (bed.back() > 1e-5) {
        judgeOrder(name + "bed", cells, bed, verdicts);
    }
    judgeOrder(name + "flow", cells, flow, verdicts,
               gate == FlowGate::orderOfColumns ? Gate::atLeast : Gate::report);
    if (gate == FlowGate::orderOfRings) {
        judgeOrder(name + "flow over rings", cells, ringFlow, verdicts);
    } else if (gate == FlowGate::errorOfRings) {
        verdicts.push_back({name + "flow over rings: error", kFlowTolerance, finest.ringFlow,
                            Gate::atMost, 0.0, scene.ringFlow});
    }
}

std::vector<Verdict> pourOnInterval(const Settings&)
{
    Table table;
    table.inside = [](double x, double) { return 1.0 - std::abs(x); };
    table.source = [](double x, double) { return std::abs(x) < 1.0 ? kSource : 0.0; };
    table.flow = [](double x, double) { return kSource * std::abs(x) / kSpeed; };
    table.isStrip = true;
    std::vector<Verdict> verdicts;
    judgeTable("", table, {41, 81, 161}, FlowGate::orderOfColumns, verdicts);
    return verdicts;
}

std::vector<Verdict> pourOnDisc(const Settings&)
{
    // The error of the bed, of first order in dx, has a kink along the grid's axes. There the slope
    // across the axis is itself only of order dx, so that the flow in the column on the axis
    // spreads twice too fast whatever dx is, and what is missing there is carried outward between
    // the streamlines: column by column the error goes as dx log(1/dx). Over rings it goes as dx.
    Table table;
    table.inside = [](double x, double y) { return 1.0 - std::hypot(x, y); };
    table.source = [](double x, double y) { return std::hypot(x, y) < 1.0 ? kSource : 0.0; };
    table.flow = [](double x, double y) { return kSource * std::hypot(x, y) / (2.0 * kSpeed); };
    table.innermost = 0.2;
    std::vector<Verdict> verdicts;
    judgeTable("uniform source: ", table, {25, 49, 97}, FlowGate::orderOfRings, verdicts);

    // All of it poured within r0, smoothly, so that grids agree on how much that is.
    constexpr double kInner = 0.5;
    const double peak = 4.0 * kSource;
    table.source = [=](double x, double y) {
        return peak * std::max(0.0, 1.0 - (x * x + y * y) / (kInner * kInner));
    };
    // Q = integral of 2 pi r f, v = Q / (2 pi r v_d) from r0 on.
    const double rate = kPi * kInner * kInner * peak / 2.0;
    table.flow = [=](double x, double y) {
        return rate / (2.0 * kPi * std::hypot(x, y) * kSpeed);
    };
    table.innermost = kInner;
    judgeTable("source in the middle: ", table, {25, 49, 97}, FlowGate::errorOfRings, verdicts);
    return verdicts;
}

std::vector<Verdict> pourOnSquare(const Settings&)
{
    Table table;
    table.inside = [](double x, double y) { return 1.0 - std::max(std::abs(x), std::abs(y)); };
    table.source = [=](double x, double y) {
        return std::max(std::abs(x), std::abs(y)) < 1.0 ? kSource : 0.0;
    };
    table.flow = [](double x, double y) {
        return kSource * std::abs(std::abs(x) - std::abs(y)) / kSpeed;
    };
    std::vector<Verdict> verdicts;
    judgeTable("", table, {25, 49, 97}, FlowGate::orderOfColumns, verdicts);
    return verdicts;
}

const Registration kInterval({"HadelerKuttlerInterval",
                              "Hadeler & Kuttler 1999, open interval, uniform source", false,
                              pourOnInterval});
const Registration kDisc({"HadelerKuttlerDisc", "Hadeler & Kuttler 1999, open disc", false,
                          pourOnDisc});
const Registration kSquare({"HadelerKuttlerSquare",
                            "Hadeler & Kuttler 1999, open square, uniform source", false,
                            pourOnSquare});

}  // namespace
}  // namespace sandflow::verification
