#pragma once

#include "core/vec3.h"
#include "grains/snapshot.h"
#include "io/scene_mesh.h"
#include "scene/scene.h"

#include <Eigen/Geometry>

namespace sandflow {

/// Axis-aligned box, m.
using Box3 = Eigen::AlignedBox3d;

/// Where the sand of a scene will probably lie when it has come to rest, from the emitters alone:
/// a heap of 26 degrees where each jet lands, the box of a fill, and so on, kept within containers.
/// A mesh that is hollow where the sand comes down, as a bowl, is a container; from any other, as a
/// figure, it slides to the ground. Good for aiming a camera, for nothing else. Never empty.
Box3 estimateSandBox(const Scene& scene, std::span<const SceneMesh> meshes = {});

/// Where the sand of a snapshot lies: the box around its grains, the outermost 0.25 % on each side
/// left out, so that a few grains that rolled away do not shrink the heap in the picture. Empty
/// for a snapshot without grains.
Box3 measureSandBox(const Snapshot& snapshot);

/// True for a mesh that belongs in the picture as a thing: it is drawn, and not so much larger than
/// the sand that it is rather the landscape the sand lies in.
bool isThing(const Scene& scene, const Box3& sand, const SceneMesh& mesh);

/// The box around the sand and the meshes that are things.
Box3 measurePictureBox(const Scene& scene, const Box3& sand, std::span<const SceneMesh> meshes);

}  // namespace sandflow
