#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

/// What this project is held to: numbers that others published or that follow from the equations,
/// each beside ours. `verify` prints them as a table; the fast ones are tests of CI.
namespace sandflow::verification {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// How far ours may be from what is expected.
enum class Gate {
    relative,  ///< |ours - expected| <= tolerance * |expected|
    absolute,  ///< |ours - expected| <= tolerance
    atMost,    ///< ours <= expected (tolerance is not looked at)
    atLeast,   ///< ours >= expected
    report     ///< not judged: the published value is unsure, or is one of several
};

/// One number of one case.
struct Verdict {
    std::string quantity;              ///< "peak force, glass", with its unit: "[N]"
    double expected = 0.0;
    double ours = 0.0;                 ///< at a step small enough for the case
    Gate gate = Gate::relative;
    double tolerance = 0.0;
    double atShippingStep = kNotMeasured;  ///< ours with the step that scenes use, if that applies

    /// Relative or absolute as the gate says; of report, atMost and atLeast: relative.
    double error() const;
    bool holds() const;
};

struct Settings {
    int seeds = 1;  ///< of bulk cases: how many pours the mean is taken over
};

/// One case from the literature: several numbers from one set-up.
struct Case {
    std::string name;    ///< "ChungOoi1", as in --filter
    std::string source;  ///< "Chung & Ooi 2011, test 1"
    bool bulk = false;   ///< takes minutes: left to scripts/verify.sh
    std::function<std::vector<Verdict>(const Settings&)> run;
};

/// All cases that were registered, in the order of their names.
const std::vector<Case>& allCases();

/// `const Registration kMine({...});` at namespace scope of a case's file makes it known.
struct Registration {
    explicit Registration(Case c);
};

}  // namespace sandflow::verification
