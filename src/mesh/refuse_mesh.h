#pragma once

#include "core/errors.h"

#include <string>
#include <utility>

namespace sandflow {

/// Throws InputError: the file's name, then the defect, where it is, and what to do about it.
template <typename... Args>
[[noreturn]] void refuseMesh(const std::string& file, fmt::format_string<Args...> sentence,
                             Args&&... args)
{
    throw InputError(
        fmt::format("{}: {}", file, fmt::format(sentence, std::forward<Args>(args)...)));
}

}  // namespace sandflow
