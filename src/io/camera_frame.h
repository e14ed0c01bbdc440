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
/// two thirds of the picture's width, the solids of limited size fit in, and no horizon shows.
CameraFrame frameCamera(const Scene& scene, const Box3& sand);

}  // namespace sandflow
