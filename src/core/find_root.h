#pragma once

#include <functional>

namespace sandflow {

/// Root of f in [low, high] by Brent's method, to the last bits; f must change sign there, else
/// InternalError.
double findRoot(const std::function<double(double)>& f, double low, double high);

}  // namespace sandflow
