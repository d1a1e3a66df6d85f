#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <glm/gtc/quaternion.hpp>

#include "game/view/scene_view.h"
#include "world/islands/march.h"

namespace skerry::game::test {

/// Puts blocks in a level square about the camera, `above` blocks over it: a roof, or what of one
/// is to go. @param from, to along x, of -8 to 8.
inline void put_roof(SceneView& view, int above, int from, int to, world::BlockId block) {
  const render::FixedPos& eye = view.start_camera().position;
  const world::WorldPos at{eye[0], eye[1], eye[2]};
  const std::uint64_t id = view.world().islands_near(at, 100.0, 0.0).front().id;
  const world::Pose pose = *view.world().pose(id, 0.0);
  const glm::dvec3 place = glm::inverse(pose.rotation) * world::difference_blocks(at, pose.origin);
  const world::IVec3 over{world::floor_to_int(place.x), world::floor_to_int(place.y) + above,
                          world::floor_to_int(place.z)};
  for (int x = from; x <= to; ++x)
    for (int z = -8; z <= 8; ++z)
      EXPECT_TRUE(view.world().set_block(id, {over.x + x, over.y, over.z + z}, block));
}

}  // namespace skerry::game::test
