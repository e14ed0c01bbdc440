#include "measure/robust_line.h"

#include "core/errors.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>

#include <algorithm>
#include <memory>

namespace sandflow {
namespace {

/// GSL's structures with owners.
template <typename T, void (*release)(T*)>
struct Release {
    void operator()(T* p) const { release(p); }
};
template <typename T, void (*release)(T*)>
using Owned = std::unique_ptr<T, Release<T, release>>;

constexpr std::size_t kFewestPoints = 4;

}  // namespace

std::optional<Line> fitRobustLine(const std::vector<double>& x, const std::vector<double>& y)
{
    SAND_CHECK(x.size() == y.size(), "{} abscissae, {} ordinates", x.size(), y.size());
    const std::size_t n = x.size();
    if (n < kFewestPoints) {
        return std::nullopt;
    }
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    if (*least == *most) {
        return std::nullopt;
    }

    gsl_set_error_handler_off();  // the default one aborts; codes are checked below
    const Owned<gsl_matrix, gsl_matrix_free> design(gsl_matrix_alloc(n, 2));
    const Owned<gsl_vector, gsl_vector_free> values(gsl_vector_alloc(n));
    const Owned<gsl_vector, gsl_vector_free> found(gsl_vector_alloc(2));
    const Owned<gsl_matrix, gsl_matrix_free> covariance(gsl_matrix_alloc(2, 2));
    const Owned<gsl_multifit_robust_workspace, gsl_multifit_robust_free> workspace(
        gsl_multifit_robust_alloc(gsl_multifit_robust_bisquare, n, 2));
    if (!design || !values || !found || !covariance || !workspace) {
        throw SystemError("out of memory while fitting the slope of a heap");
    }
    for (std::size_t i = 0; i < n; ++i) {
        gsl_matrix_set(design.get(), i, 0, 1.0);
        gsl_matrix_set(design.get(), i, 1, x[i]);
        gsl_vector_set(values.get(), i, y[i]);
    }
    const int code = gsl_multifit_robust(design.get(), values.get(), found.get(), covariance.get(),
                                         workspace.get());
    // Out of iterations is no failure: with few points the weights may go to and fro for ever
    // between two lines that are equally good, and `found` holds one of them.
    if (code != GSL_SUCCESS && code != GSL_EMAXITER) {
        return std::nullopt;
    }
    return Line{gsl_vector_get(found.get(), 0), gsl_vector_get(found.get(), 1)};
}

}  // namespace sandflow
