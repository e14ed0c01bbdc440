#pragma once

#include "core/vec3.h"
#include "grains/snapshot.h"
#include "scene/scene.h"

#include <Eigen/Geometry>

namespace sandflow {

/// Axis-aligned box, m.
using Box3 = Eigen::AlignedBox3d;

/// Where the sand of a scene will probably lie when it has come to rest, from the emitters alone:
/// a heap of 26 degrees where each jet lands, the box of a fill, and so on, kept within containers.
/// Good for aiming a camera, for nothing else. Never empty.
Box3 estimateSandBox(const Scene& scene);

/// Where the sand of a snapshot lies: the box around its grains, the outermost 0.25 % on each side
/// left out, so that a few grains that rolled away do not shrink the heap in the picture. Empty
/// for a snapshot without grains.
Box3 measureSandBox(const Snapshot& snapshot);

}  // namespace sandflow
