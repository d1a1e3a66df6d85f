#include "game/player/world_surroundings.h"

#include <gtest/gtest.h>

#include <chrono>
#include <glm/geometric.hpp>
#include <thread>

namespace skerry::game {
namespace {

/// Frames of 1/60 s with pauses for the loader, until the player stands; at most `frames`.
bool settle(Player& player, WorldSurroundings& around, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    around.refresh(player.feet(), 1.0, player.world_time_s());
    player.advance(1.0 / 60.0, {}, around);
    if (player.on_ground() && player.frame_island()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

TEST(WorldSurroundings, ASpawnedPlayerStandsWhereTheWorldPutThem) {
  for (const std::int64_t offset : {std::int64_t{0}, world::kMaxBlock / 2}) {
    world::WorldDesc desc;
    desc.seed = 1;
    desc.offset_blocks = {offset, -offset, offset};
    world::World world(desc);
    const world::Spawn spawn = world.spawn();
    WorldSurroundings around(world);
    Player player(spawn.feet, spawn.yaw_deg, spawn.pitch_deg, 0.0);
    ASSERT_TRUE(settle(player, around, 5000));
    EXPECT_EQ(player.frame_island(), spawn.island);
    // Seen from the island, so that its drift does not count: still within a step of the spawn.
    const world::Pose then = *world.pose(spawn.island, 0.0);
    const world::Pose now = *world.pose(spawn.island, player.tick_time_s());
    const glm::dvec3 was =
        glm::conjugate(then.rotation) * world::difference_blocks(spawn.feet, then.origin);
    const glm::dvec3 is =
        glm::conjugate(now.rotation) * world::difference_blocks(player.feet(), now.origin);
    EXPECT_LT(glm::distance(was, is), 1.0);
  }
}

}  // namespace
}  // namespace skerry::game
