#pragma once

#include "scene/field_rules.h"
#include "scene/scene.h"

/// The words a scene file uses for what is an enumeration in the code.
namespace sandflow::words {

inline constexpr Choice<Mode> kModes[] = {{Mode::surfaceFlow, "surface-flow"}, {Mode::dem, "dem"}};

inline constexpr Choice<Precision> kPrecisions[] = {{Precision::single, "float"},
                                                    {Precision::real64, "double"}};

inline constexpr Choice<NormalLaw> kLaws[] = {{NormalLaw::linear, "linear"},
                                              {NormalLaw::hertz, "hertz"},
                                              {NormalLaw::bellYuMucha, "bell-yu-mucha"}};

inline constexpr Choice<SlopeForm> kSlopeForms[] = {{SlopeForm::angle, "angle"},
                                                    {SlopeForm::tangent, "tangent"}};

inline constexpr Choice<SolidShape> kShapes[] = {{SolidShape::plane, "plane"},
                                                 {SolidShape::box, "box"},
                                                 {SolidShape::cylinder, "cylinder"},
                                                 {SolidShape::disc, "disc"},
                                                 {SolidShape::mesh, "mesh"}};

inline constexpr Choice<EmitterKind> kKinds[] = {
    {EmitterKind::jet, "jet"},   {EmitterKind::slot, "slot"}, {EmitterKind::block, "block"},
    {EmitterKind::fill, "fill"}, {EmitterKind::pile, "pile"}, {EmitterKind::single, "single"}};

inline constexpr Choice<UpAxis> kUpAxes[] = {{UpAxis::y, "y"}, {UpAxis::z, "z"}};

/// Materials of the generated picture.
inline constexpr Choice<const char*> kLooks[] = {{"floor", "floor"},
                                                 {"glass", "glass"},
                                                 {"ceramic", "ceramic"},
                                                 {"wood", "wood"},
                                                 {"stone", "stone"},
                                                 {"jade", "jade"},
                                                 {"bronze", "bronze"},
                                                 {"none", "none"}};

}  // namespace sandflow::words
