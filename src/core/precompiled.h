#pragma once

/// Headers that most sources read, compiled once per kind of target. Every source still includes
/// what it uses: it builds as well with CMAKE_DISABLE_PRECOMPILE_HEADERS.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
