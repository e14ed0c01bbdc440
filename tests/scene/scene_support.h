#pragma once

#include "core/errors.h"
#include "scene/read_scene.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <sstream>

namespace sandflow {

/// Bits of a double: 0.0 and -0.0 differ, as a round trip must keep them.
inline std::uint64_t bitsOf(double value)
{
    return std::bit_cast<std::uint64_t>(value);
}

/// The message with which the text is refused; fails the test if it is not.
inline std::string refusalOf(const std::string& text,
                             const std::vector<std::string>& overrides = {})
{
    try {
        parseScene(text, "s.toml", overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "accepted:\n" << text;
    return "";
}

/// The smallest scene there is; line 1 to 4.
inline const std::string kOneGrain =
    "[[emitters]]\n"
    "kind = \"single\"\n"
    "position = [0, 0, 1]\n"
    "name = \"grain\"\n";

/// A jet; line 1 to 7.
inline const std::string kJet =
    "[[emitters]]\n"
    "kind = \"jet\"\n"
    "count = 100\n"
    "rate = 50\n"
    "position = [0, 0, 1]\n"
    "speed = 1.5\n"
    "radius = 0.05\n";

inline std::string readText(const std::string& path)
{
    std::ifstream file(path);
    EXPECT_TRUE(file.is_open()) << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline const std::string kSceneDir = std::string(SANDFLOW_SOURCE_DIR) + "/scenes/";

}  // namespace sandflow
