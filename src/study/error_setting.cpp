#include "study/error_setting.h"

#include "core/errors.h"
#include "scene/repose_angle.h"

#include <algorithm>
#include <cmath>

namespace sandflow {
namespace {

/// A number of the scene file and the values it takes, cheap or rough ones not always first. They
/// reach as far as the scene is still sand: what lies beyond is refused or breaks.
struct Sweep {
    const char* approximation;
    const char* key;
    const char* unit;        ///< after the value, for people
    double perUnit;          ///< of the unit in the file's unit
    double current;          ///< of the scene, in the file's unit
    std::vector<double> values;  ///< in `unit`
};

std::vector<Sweep> listSweeps(const Scene& scene)
{
    const SurfaceFlowSpec& s = scene.surfaceFlow;
    return {
        {"time step", "time.step_safety", " of bound", 1.0, scene.time.stepSafety,
         {0.4, 0.6, 0.8, 1.0}},
        {"R_min", "surface_flow.min_flow_depth", " d", 1.0, s.minFlowDepth, {1.0, 1.5, 2.0, 3.0}},
        {"interface", "surface_flow.interface_thickness", " d", 1.0, s.interfaceThickness,
         {1.6, 2.2, 3.0, 4.0}},
        {"cell size", "surface_flow.cell_size", " d", 1.0, s.cellSize, {2.0, 3.0, 4.0, 6.0}},
        {"transfer interval", "surface_flow.interval", " ms", 1e-3, s.interval,
         {5.0, 10.0, 20.0, 34.0}},
        {"gamma", "surface_flow.exchange_rate", " /s", 1.0, s.exchangeRate, {25.0, 100.0, 400.0}},
        {"theta0", "surface_flow.repose_angle", " deg", 1.0, reportRepose(scene).neutralSlope(),
         {30.0, 33.0, 36.0, 39.0}},
        {"freeze speed", "surface_flow.freeze_speed", " mm/s", 1e-3, s.freezeSpeed,
         {4.0, 15.0, 30.0, 60.0}},
        {"freeze time", "surface_flow.freeze_time", " ms", 1e-3, s.freezeTime,
         {30.0, 60.0, 120.0}},
        {"bury clearance", "surface_flow.bury_clearance", " d", 1.0, s.buryClearance,
         {1.0, 1.3, 2.5}},
        {"bed creep", "surface_flow.creep_decay", " d", 1.0, s.creepDecay, {0.0, 0.4, 0.6, 0.8}},
        {"settling", "surface_flow.settle_depth", " d", 1.0, s.settleDepth, {0.0, 15.0, 40.0}},
        {"smoothing", "surface_flow.smoothing", "", 1.0, s.smoothing, {0.0, 0.3, 0.6}},
    };
}

bool areEqual(double a, double b)
{
    return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

void addSweep(const Sweep& sweep, bool quick, std::vector<ErrorSetting>& settings)
{
    std::vector<ErrorSetting> added;
    for (const double value : sweep.values) {
        const double inFile = value * sweep.perUnit;
        if (!areEqual(inFile, sweep.current)) {
            added.push_back({sweep.approximation, fmt::format("{:g}{}", value, sweep.unit),
                             {fmt::format("{}={:.6g}", sweep.key, inFile)}});
        }
    }
    if (quick && added.size() > 2) {
        added.erase(added.begin() + 1, added.end() - 1);
    }
    settings.insert(settings.end(), added.begin(), added.end());
}

/// Overrides for a stiffness of `factor` times `stiffness`. Softer grains overlap deeper than the
/// scene allows: linear impacts as k^-1/2, loads as k^-1, which bounds the other laws too.
std::vector<std::string> overrideStiffness(const Scene& scene, double stiffness, double factor)
{
    std::vector<std::string> overrides;
    if (scene.contact.law == NormalLaw::linear) {
        overrides.push_back(fmt::format("contact.stiffness={:.6g}", factor * stiffness));
    } else {
        const double nu = scene.contact.poissonRatio;  // 4/3 E* to Young's modulus of a grain
        const double young = 1.5 * (1.0 - nu * nu) * factor * stiffness;
        overrides.push_back(fmt::format("contact.young_modulus={:.6g}", young));
    }
    if (factor < 1.0) {
        const double overlap = std::min(0.8, scene.contact.maxOverlap / factor);
        overrides.push_back(fmt::format("contact.max_overlap={:.4g}", overlap));
    }
    return overrides;
}

void addStiffness(const Scene& scene, double stiffness, bool quick,
                  std::vector<ErrorSetting>& settings)
{
    for (const double factor : {0.4, 3.0, 10.0}) {
        if (!quick || factor != 3.0) {
            settings.push_back({"stiffness", fmt::format("x {:g}", factor),
                                overrideStiffness(scene, stiffness, factor)});
        }
    }
}

}  // namespace

std::vector<ErrorSetting> listErrorSettings(const Scene& scene, double stiffness, bool quick)
{
    if (scene.mode == Mode::dem) {
        throw InputError("mode = \"dem\" leaves nothing to study: the approximations are those of "
                         "\"surface-flow\", leave mode out");
    }
    if (scene.time.step) {
        throw InputError("time.step is given, but a study of errors sweeps time.step_safety: leave "
                         "time.step out");
    }
    std::vector<ErrorSetting> settings{{kDefaultSetting, "", {}}};
    settings.push_back({"method", "dem", {"mode=dem"}});
    settings.push_back({"sleep", "off", {"skip.sleep=false"}});
    const bool isFloat = scene.precision == Precision::single;
    settings.push_back({"precision", isFloat ? "double" : "float",
                        {isFloat ? "precision=double" : "precision=float"}});
    addStiffness(scene, stiffness, quick, settings);
    for (const Sweep& sweep : listSweeps(scene)) {
        addSweep(sweep, quick, settings);
    }
    return settings;
}

ErrorSetting makeReferenceSetting(const Scene& scene, double stiffness,
                                  const ErrorReference& reference)
{
    ErrorSetting setting;
    setting.approximation = kReferenceSetting;
    setting.value = fmt::format("dem, stiffness x {:g}, step {:g} of bound", reference.stiffness,
                                reference.stepSafety);
    setting.overrides = overrideStiffness(scene, stiffness, reference.stiffness);
    setting.overrides.push_back("mode=dem");
    setting.overrides.push_back(fmt::format("time.step_safety={:g}", reference.stepSafety));
    return setting;
}

}  // namespace sandflow
