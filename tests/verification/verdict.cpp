#include "verification/verdict.h"

#include <algorithm>
#include <cmath>

namespace sandflow::verification {
namespace {

std::vector<Case>& registry()
{
    static std::vector<Case> cases;
    return cases;
}

}  // namespace

double Verdict::error() const
{
    const double difference = ours - expected;
    return gate == Gate::absolute || expected == 0.0 ? difference : difference / std::abs(expected);
}

bool Verdict::holds() const
{
    switch (gate) {
    case Gate::relative:
    case Gate::absolute: return std::abs(error()) <= tolerance;
    case Gate::atMost: return ours <= expected;
    case Gate::atLeast: return ours >= expected;
    case Gate::report: break;
    }
    return std::isfinite(ours);
}

const std::vector<Case>& allCases()
{
    return registry();
}

Registration::Registration(Case c)
{
    std::vector<Case>& cases = registry();
    const auto at = std::lower_bound(cases.begin(), cases.end(), c,
                                     [](const Case& a, const Case& b) { return a.name < b.name; });
    cases.insert(at, std::move(c));
}

}  // namespace sandflow::verification
