#include "core/find_root.h"

#include "core/errors.h"
#include "core/quiet_gsl.h"

#include <gsl/gsl_roots.h>

#include <memory>

namespace sandflow {

double findRoot(const std::function<double(double)>& f, double low, double high)
{
    constexpr int kMaxSteps = 200;
    const QuietGsl quiet;
    std::unique_ptr<gsl_root_fsolver, decltype(&gsl_root_fsolver_free)> solver(
        gsl_root_fsolver_alloc(gsl_root_fsolver_brent), &gsl_root_fsolver_free);
    SAND_CHECK(solver != nullptr, "no memory for a root solver");
    gsl_function function;
    function.function = [](double x, void* context) {
        return (*static_cast<const std::function<double(double)>*>(context))(x);
    };
    function.params = const_cast<std::function<double(double)>*>(&f);
    SAND_CHECK(gsl_root_fsolver_set(solver.get(), &function, low, high) == GSL_SUCCESS,
               "no sign change between {} and {}", low, high);
    for (int i = 0; i < kMaxSteps; ++i) {
        SAND_CHECK(gsl_root_fsolver_iterate(solver.get()) == GSL_SUCCESS, "Brent failed");
        const double a = gsl_root_fsolver_x_lower(solver.get());
        const double b = gsl_root_fsolver_x_upper(solver.get());
        if (gsl_root_test_interval(a, b, 0.0, 1e-13) == GSL_SUCCESS) {
            break;
        }
    }
    return gsl_root_fsolver_root(solver.get());
}

}  // namespace sandflow
