#pragma once
#include "world/voxel/coords.h"

namespace skerry::game {

/// Where a camera is and looks; conventions of yaw and pitch: docs/conventions.md.
struct CameraPlace {
  world::WorldPos position;
  double yaw_deg = 0.0;    ///< -3600 .. 3600
  double pitch_deg = 0.0;  ///< -90 .. 90
  bool operator==(const CameraPlace&) const = default;
};

}  // namespace skerry::game
