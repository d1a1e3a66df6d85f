#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "world/voxel/coords.h"
#include "world/voxel/island.h"

namespace skerry::world {

/// An island that left its course, at one tick. Islands stay upright: they turn about the vertical
/// only, so that up is up on all of them.
struct MotionState {
  std::int64_t tick = 0;  ///< of kMotionTicksPerSecond
  Pose pose;              ///< of the lattice; a rotation about +y
  glm::dvec3 velocity{};  ///< of the centre of mass, world axes [blocks/s]
  double spin = 0.0;      ///< about +y [rad/s]
  /// The velocity is that of the lattice's origin: where the centre of mass is, is not known yet.
  bool of_origin = false;
  bool operator==(const MotionState& o) const {
    return tick == o.tick && pose.origin == o.pose.origin && pose.rotation == o.pose.rotation &&
           velocity == o.velocity && spin == o.spin && of_origin == o.of_origin;
  }
};

/// An island and how it moves.
struct MovingIsland {
  std::uint64_t island = 0;
  MotionState state;
  /// Its engines do nothing: its shape, or that of an island about it, is still being worked out.
  bool waits = false;
};

}  // namespace skerry::world
