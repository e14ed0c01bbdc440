#pragma once

#include "mesh/triangle_mesh.h"

#include <cstddef>

namespace sandflow {

/// Turns triangles round that run along a common edge the same way as their neighbour, where the
/// edge has just these two; of each connected patch the lesser part is turned. Patches without a
/// consistent side (a Moebius strip) are left. Returns how many triangles were turned.
std::size_t alignNeighbours(TriangleMesh& mesh);

struct TurnedParts {
    std::size_t turned = 0;  ///< components
    bool complete = true;    ///< false: so many components that they were not judged
};

/// Turns closed components round that are inside out, with all that lies inside them, so that a
/// mirrored file comes out right; a cavity, which faces inwards inside another component, stays.
/// Components with a hole wider than a quarter of them have no inside and stay too.
TurnedParts turnInsideOut(TriangleMesh& mesh);

}  // namespace sandflow
