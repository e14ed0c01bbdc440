#pragma once

#include <string>

namespace sandflow {

/// Every key of a scene file with what it may be, its default and its meaning, as Markdown tables;
/// the reference part of scenes/README.md.
std::string writeSceneReference();

}  // namespace sandflow
