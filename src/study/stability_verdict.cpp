#include "study/stability_verdict.h"

#include "core/errors.h"

#include <cmath>
#include <limits>

namespace sandflow {
namespace {

/// Error in units of what is allowed.
double excess(const Check& check)
{
    return std::isfinite(check.error) ? check.error / check.limit
                                      : std::numeric_limits<double>::infinity();
}

/// What decides rather: a failure, then a worse verdict, then a larger excess.
bool outweighs(const Check& a, const Check& b)
{
    const bool aFails = excess(a) > 1.0, bFails = excess(b) > 1.0;
    if (aFails != bFails) {
        return aFails;
    }
    if (aFails && a.otherwise != b.otherwise) {
        return a.otherwise > b.otherwise;
    }
    if (!aFails && a.isGuard != b.isGuard) {
        return b.isGuard;
    }
    return excess(a) > excess(b);
}

}  // namespace

const char* nameOf(Verdict verdict)
{
    switch (verdict) {
    case Verdict::sound:
        return "sound";
    case Verdict::refused:
        return "refused";
    case Verdict::wrongShape:
        return "wrong shape";
    case Verdict::jitters:
        return "jitters";
    case Verdict::broke:
        return "broke";
    }
    throw InternalError("unknown verdict");
}

bool isAcceptable(Verdict verdict)
{
    return verdict == Verdict::sound || verdict == Verdict::refused;
}

void judge(const std::vector<Check>& checks, Finding& finding)
{
    SAND_CHECK(!checks.empty(), "{} {}: nothing was checked", finding.family, finding.value);
    const Check* decisive = &checks.front();
    for (const Check& check : checks) {
        SAND_CHECK(check.limit > 0.0, "{}: limit {}", check.measure, check.limit);
        decisive = outweighs(check, *decisive) ? &check : decisive;
    }
    const bool fails = excess(*decisive) > 1.0;
    finding.decisive = *decisive;
    finding.verdict = fails ? decisive->otherwise : Verdict::sound;
    finding.cause = fails ? decisive->cause : "";
}

}  // namespace sandflow
