#pragma once

#include "io/picture_extent.h"

namespace sandflow {

/// A camera in the simulator's axes, m and degrees.
struct CameraFrame {
    Vec3 position;
    Vec3 lookAt;
    double angle;  ///< horizontal
};

/// Completes the scene's camera. What the scene leaves open is chosen so that the sand fills about
/// two thirds of the picture's width, unless solids of limited size and meshes, which must fit in,
/// need more room than that, and no horizon shows.
CameraFrame frameCamera(const Scene& scene, const Box3& sand,
                        std::span<const SceneMesh> meshes = {});

}  // namespace sandflow
