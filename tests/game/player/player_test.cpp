#include "game/player/player.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <random>

#include "tests/game/player/test_world.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::IVec3;
using world::Pose;
using world::WorldPos;

constexpr std::int64_t kUnit = world::kUnitsPerBlock;

/// A box full of random stone in [-24, 24)^3 with a closed stone wall around it, decided by a hash
/// of the voxel.
std::optional<BlockId> rubble(IVec3 v, std::uint32_t seed, std::uint32_t percent) {
  const int edge = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (edge >= 24) return edge < 27 ? world::block::kStone : world::block::kAirBlock;
  return voxel_hash(v, seed) % 100 < percent ? world::block::kStone : world::block::kAirBlock;
}

/// The truth, voxel by voxel and independent of the sweep: volume shared with any solid.
double solid_volume(const TestWorld& world, std::size_t island, const glm::dvec3& feet) {
  double volume = 0.0;
  for (int x = static_cast<int>(std::floor(feet.x)) - 2; x <= feet.x + 2; ++x) {
    for (int y = static_cast<int>(std::floor(feet.y)) - 2; y <= feet.y + 4; ++y) {
      for (int z = static_cast<int>(std::floor(feet.z)) - 2; z <= feet.z + 2; ++z) {
        const auto id = world.block(island, {x, y, z});
        if (!id || !world::is_solid(*id)) continue;
        const auto shared = [](double a0, double a1, double b0, double b1) {
          return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
        };
        volume += shared(feet.x - 0.3, feet.x + 0.3, x, x + 1) *
                  shared(feet.y, feet.y + 1.8, y, y + 1) *
                  shared(feet.z - 0.3, feet.z + 0.3, z, z + 1);
      }
    }
  }
  return volume;
}

/// The first free place in a rubble box, scanning upwards from a random column.
std::optional<glm::dvec3> free_place(const TestWorld& world, std::mt19937& random) {
  for (int tries = 0; tries < 1000; ++tries) {
    const glm::dvec3 feet{static_cast<int>(random() % 40) - 19.5,
                          static_cast<int>(random() % 40) - 20.0 + 0.01,
                          static_cast<int>(random() % 40) - 19.5};
    if (solid_volume(world, 0, feet) == 0.0) return feet;
  }
  return std::nullopt;
}

TEST(Player, RandomMotionThroughRandomWorldsNeverEndsInsideASolid) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    TestWorld world;
    const double spin = seed % 3 == 0 ? 0.0 : 0.4 * unit(random);
    const WorldPos origin = at_blocks(5000.25, -17.5, 3.0);
    world.islands.push_back({[=](double t) { return turning(origin, spin, t); },
                             [=](IVec3 v) { return rubble(v, seed, 5 + seed % 4 * 10); }});
    const auto start = free_place(world, random);
    ASSERT_TRUE(start);
    Player player(world::moved(origin, *start), 0.0, 0.0, 0.0);
    player.set_fly_speed(std::pow(10.0, seed % 5));
    for (int step = 0; step < 1500; ++step) {
      if (step % 97 == 0) player.set_mode(step / 97 % 2 ? MoveMode::kFly : MoveMode::kWalk);
      player.turn(40.0 * unit(random), 10.0 * unit(random));
      player.advance(
          1.0 / 60.0,
          {{unit(random), unit(random)}, unit(random), random() % 3 == 0, random() % 2 == 0},
          world);
      const glm::dvec3 feet =
          lattice_of(world.pose(0, player.tick_time_s()).value(), player.feet());
      ASSERT_EQ(solid_volume(world, 0, feet), 0.0) << "seed " << seed << " step " << step;
      // The closed wall also means: nobody ever gets out.
      ASSERT_LT(std::max({std::abs(feet.x), std::abs(feet.y), std::abs(feet.z)}), 24.0);
    }
  }
}

TEST(Player, NoSpeedTunnelsThroughAOneBlockWall) {
  for (const double speed : {10.0, 100.0, 1e3, 1e4}) {
    TestWorld world;
    // One layer of stone at z = 1000, thin as can be; nothing else.
    world.islands.push_back(
        {[](double) { return still({}); },
         [](IVec3 v) { return v.z == 1000 ? world::block::kStone : world::block::kAirBlock; },
         1e6});
    Player player(at_blocks(0.5, 10.0, 0.5), 0.0, 0.0, 0.0);
    player.set_mode(MoveMode::kFly);
    player.set_fly_speed(speed);
    for (int i = 0; i < 150 * 120 && player.feet().z < 999 * kUnit; ++i)
      player.advance(1.0, {{0.0, 1.0}, 0.0, false, true}, world);
    player.advance(5.0, {{0.0, 1.0}, 0.0, false, true}, world);
    const double z = world::difference_blocks(player.feet(), {}).z;
    EXPECT_NEAR(z, 1000.0 - 0.3, 0.001) << speed;
  }
}

TEST(Player, RestsForAnHourWithoutMovingABit) {
  for (const double spin : {0.0, 0.003}) {
    TestWorld world;
    world.islands.push_back(
        {[=](double t) { return turning(at_blocks(7.0, 3.0, -2.0), spin, t); }, plain});
    Player player(at_blocks(17.3, 3.2, 1.7), 0.0, 0.0, 0.0);
    player.advance(2.0, {}, world);
    ASSERT_TRUE(player.on_ground());
    const glm::dvec3 before =
        lattice_of(world.pose(0, player.tick_time_s()).value(), player.feet());
    for (int second = 0; second < 3600; ++second) player.advance(1.0, {}, world);
    const glm::dvec3 after = lattice_of(world.pose(0, player.tick_time_s()).value(), player.feet());
    EXPECT_TRUE(player.on_ground());
    EXPECT_EQ(player.velocity(), glm::dvec3(0.0));
    // Only the rounding of the world place to 1/65536 block remains, twice.
    EXPECT_LT(glm::distance(before, after), 2.0 / kUnit) << spin;
  }
}

TEST(Player, FrameLengthsFromATenthOfAMillisecondToASecondAgree) {
  // Same ticks whatever the frame: at most one tick of travel apart (plus the sum's rounding).
  std::vector<glm::dvec3> ends;
  for (const double dt : {1e-4, 1.0 / 144.0, 1.0 / 60.0, 0.1, 1.0}) {
    TestWorld world;
    world.islands.push_back({[](double t) { return turning({}, 0.05, t); }, plain});
    Player player(at_blocks(3.0, 0.5, 4.0), 30.0, 0.0, 0.0);
    for (int i = 0; i < std::lround(10.0 / dt); ++i)
      player.advance(dt, {{0.3, 0.8}, 0.0, true, true}, world);
    ends.push_back(world::difference_blocks(player.feet(), {}));
  }
  const double tick_travel =
      (8.0 + 7.9 + 2.0) * kTickSeconds;  // sprint + jump + carried by the island
  for (const glm::dvec3& end : ends) EXPECT_LT(glm::distance(end, ends.back()), tick_travel);
}

TEST(Player, WhatHappensAtTheEdgeOfTheWorldIsWhatHappensAtItsMiddle) {
  const auto run = [](WorldPos offset) {
    TestWorld world;
    world.islands.push_back(
        {[=](double t) { return turning(offset + at_blocks(1.0, 2.0, 3.0), 0.1, t); },
         [](IVec3 v) {
           return rubble({v.x, v.y, v.z}, 9, 12);
         }});
    std::mt19937 random(2);
    Player player(
        offset + world::moved(at_blocks(1.0, 2.0, 3.0), free_place(world, random).value()), 10.0,
        0.0, 0.0);
    std::vector<WorldPos> path;
    for (int i = 0; i < 600; ++i) {
      player.advance(0.016, {{0.4, 1.0}, 0.0, i % 50 < 10, false}, world);
      path.push_back(player.feet() - offset);
      path.push_back(player.eye(world).position - offset);
    }
    return path;
  };
  const auto middle = run({});
  const std::int64_t edge = (world::kMaxBlock - 1000) * kUnit;
  EXPECT_EQ(run({edge, edge, -edge}), middle);
  EXPECT_EQ(run({-edge, 0, 12345}), middle);
}

TEST(Player, StandingOnATurningAndDriftingIslandMovesAndTurnsWithIt) {
  TestWorld world;
  const auto pose = [](double t) {
    return Pose{world::moved({}, {10.0 * std::sin(0.1 * t), 2.0 * std::cos(0.05 * t), 3.0 * t}),
                glm::angleAxis(0.2 * t, glm::dvec3(0.0, 1.0, 0.0))};
  };
  world.islands.push_back({pose, plain});
  Player player(world::moved(pose(0.0).origin, {20.0, 0.1, 0.0}), 0.0, 0.0, 0.0);
  player.advance(1.0, {}, world);
  ASSERT_TRUE(player.on_ground());
  const auto relative = [&] {
    const CameraPlace eye = player.eye(world);
    return lattice_of(pose(player.world_time_s()), eye.position);
  };
  const glm::dvec3 place = relative();
  const double yaw = player.eye(world).yaw_deg;
  const double start_s = player.world_time_s();
  for (int frame = 0; frame < 1000; ++frame) {
    player.advance(0.0137, {}, world);  // not a whole number of ticks: the view is interpolated
    EXPECT_LT(glm::distance(relative(), place), 3.0 / kUnit);
  }
  const double turned = glm::degrees(0.2 * (player.world_time_s() - start_s));
  EXPECT_NEAR(std::remainder(player.eye(world).yaw_deg - yaw - turned, 360.0), 0.0, 1e-6);
}

TEST(Player, AnIslandThatRisesOrSweepsSidewaysPushesWhoeverIsInItsWay) {
  for (const glm::dvec3 velocity : {glm::dvec3(0.0, 3.0, 0.0), glm::dvec3(0.0, 0.0, -6.0)}) {
    TestWorld world;
    world.islands.push_back({[=](double t) { return still(world::moved({}, velocity * t)); },
                             [](IVec3 v) {
                               return v.y < 0 || v.z > 10 ? world::block::kStone
                                                          : world::block::kAirBlock;
                             }});
    Player player(at_blocks(0.5, 5.0, 0.5), 0.0, 0.0, 0.0);
    player.set_mode(MoveMode::kFly);  // hovers in the world's frame
    for (int i = 0; i < 600; ++i) {
      player.advance(1.0 / 60.0, {}, world);
      ASSERT_EQ(
          solid_volume(world, 0,
                       lattice_of(world.pose(0, player.tick_time_s()).value(), player.feet())),
          0.0);
    }
  }
}

TEST(Player, LeavingAnIslandKeepsItsMotionAndTheView) {
  TestWorld world;
  world.islands.push_back({[](double t) {
                             return still(world::moved({}, {5.0 * t, 0.0, 0.0}));
                           },
                           plain, 8.0});
  Player player(at_blocks(0.5, 0.01, 0.5), 90.0, 0.0, 0.0);
  player.advance(0.5, {}, world);
  ASSERT_EQ(player.frame_island(), 0u);
  // Walk off towards +x until the island is out of reach; in the air nothing but grip changes the
  // speed.
  while (player.frame_island()) player.advance(kTickSeconds, {{0.0, 1.0}, 0.0, true, true}, world);
  EXPECT_NEAR(player.velocity().x, 5.0 + 8.0, 0.2);
  EXPECT_NEAR(player.eye(world).yaw_deg, 90.0, 1e-9);
}

TEST(Player, JumpsOneBlockHighButNotTwo) {
  for (const int height : {1, 2}) {
    TestWorld world;
    world.islands.push_back({[](double) { return still({}); },
                             [=](IVec3 v) {
                               return v.y < 0 || (v.z >= 3 && v.y < height)
                                          ? world::block::kStone
                                          : world::block::kAirBlock;
                             }});
    Player player(at_blocks(0.5, 0.01, 0.5), 0.0, 0.0, 0.0);
    for (int i = 0; i < 300; ++i) player.advance(1.0 / 60.0, {{0.0, 1.0}, 0.0, true, false}, world);
    const double z = world::difference_blocks(player.feet(), {}).z;
    if (height == 1) {
      EXPECT_GT(z, 4.0);
    } else {
      EXPECT_NEAR(z, 2.7, 0.001);
    }
  }
}

TEST(Player, WaterSlowsTheFallAndStrokesLift) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); },
                           [](IVec3 v) {
                             return v.y < -50 ? world::block::kStone
                                    : v.y < 0 ? world::block::kWater
                                              : world::block::kAirBlock;
                           }});
  Player player(at_blocks(0.5, -5.0, 0.5), 0.0, 0.0, 0.0);
  player.advance(2.0, {}, world);
  EXPECT_TRUE(player.in_water());
  EXPECT_NEAR(player.velocity().y, -1.5, 0.05);
  player.advance(2.0, {{}, 0.0, true, false}, world);
  EXPECT_NEAR(player.velocity().y, 3.5, 0.05);
}

TEST(Player, UnknownVoxelsHoldAWalkerAndPassAFlier) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); }, [](IVec3) { return std::nullopt; }});
  Player player(at_blocks(0.5, 5.0, 0.5), 0.0, 0.0, 0.0);
  player.advance(5.0, {{0.0, 1.0}, 0.0, true, true}, world);
  const glm::dvec3 held = world::difference_blocks(player.feet(), at_blocks(0.5, 5.0, 0.5));
  EXPECT_LT(glm::length(held), 1.0);
  player.set_mode(MoveMode::kFly);
  player.advance(5.0, {{0.0, 1.0}, 0.0, false, false}, world);
  EXPECT_GT(world::difference_blocks(player.feet(), {}).z, 40.0);
}

TEST(Player, SomeoneBuriedIsLiftedOut) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); }, plain});
  Player player(at_blocks(0.5, -20.4, 0.5), 0.0, 0.0, 0.0);
  player.advance(2.0, {}, world);
  EXPECT_NEAR(world::difference_blocks(player.feet(), {}).y, 0.0, 0.001);
  EXPECT_TRUE(player.on_ground());
}

TEST(Player, DirectionsFollowTheConventions) {
  TestWorld world;
  const auto flown = [&](double yaw_deg, Intent intent) {
    Player player({}, yaw_deg, 0.0, 0.0);
    player.set_mode(MoveMode::kFly);
    player.advance(1.0, intent, world);
    return glm::normalize(world::difference_blocks(player.feet(), {}));
  };
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::distance(a, b) < 1e-4;
  };
  EXPECT_TRUE(near(flown(0.0, {{0.0, 1.0}, 0.0, false, false}), {0, 0, 1}));
  EXPECT_TRUE(near(flown(90.0, {{0.0, 1.0}, 0.0, false, false}), {1, 0, 0}));
  EXPECT_TRUE(
      near(flown(0.0, {{1.0, 0.0}, 0.0, false, false}), {-1, 0, 0}));  // right of south is west
  EXPECT_TRUE(near(flown(0.0, {{0.0, 0.0}, 1.0, false, false}), {0, 1, 0}));
}

TEST(Player, WalksUpLedgesOfOneBlockButNotOfTwo) {
  for (const int height : {1, 2}) {
    TestWorld world;
    world.islands.push_back({[](double) { return still({}); },
                             [=](IVec3 v) {
                               return v.y < (v.z < 3 ? 0 : height) ? world::block::kStone
                                                                   : world::block::kAirBlock;
                             }});
    Player player(at_blocks(0.5, 0.01, 0.5), 0.0, 0.0, 0.0);
    for (int i = 0; i < 90; ++i) player.advance(1.0 / 60.0, {{0.0, 1.0}}, world);
    const glm::dvec3 feet = world::difference_blocks(player.feet(), {});
    EXPECT_NEAR(feet.y, height == 1 ? 1.0 : 0.0, 0.001);
    EXPECT_EQ(feet.z > 3.5, height == 1) << feet.z;
  }
}

TEST(Player, TheEyeFollowsAStepSmoothly) {
  // Stairs of one block each: no frame of a hundredth of a second may lift the eye by a quarter
  // block, and two seconds after the stairs it is at its height above the feet.
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); },
                           [](IVec3 v) {
                             const int top = std::clamp(v.z / 3, 0, 4);
                             return v.y < top ? world::block::kStone : world::block::kAirBlock;
                           }});
  Player player(at_blocks(0.5, 0.01, 0.5), 0.0, 0.0, 0.0);
  double last = world::difference_blocks(player.eye(world).position, {}).y;
  for (int frame = 0; frame < 500; ++frame) {
    player.advance(0.01, {{0.0, 1.0}}, world);
    const double height = world::difference_blocks(player.eye(world).position, {}).y;
    ASSERT_LT(height - last, 0.25) << frame;
    last = height;
  }
  EXPECT_NEAR(last, 4.0 + kEyeHeight, 0.01);
}

TEST(Player, WhoeverCrouchesStaysOnTheEdge) {
  for (const double spin : {0.0, 0.2}) {
    TestWorld world;
    world.islands.push_back({[=](double t) { return turning(at_blocks(3.0, 1.0, 2.0), spin, t); },
                             [](IVec3 v) {
                               return v.y == -1 && std::abs(v.x) < 3 && std::abs(v.z) < 3
                                          ? world::block::kStone
                                          : world::block::kAirBlock;
                             }});
    std::mt19937 random(5);
    Player player(at_blocks(3.0, 1.01, 2.0), 0.0, 0.0, 0.0);
    player.advance(0.5, {}, world);
    Intent outwards{{0.0, 1.0}};
    outwards.crouch = true;
    double farthest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      if (i % 50 == 0) player.turn(static_cast<double>(random() % 360), 0.0);
      player.advance(1.0 / 60.0, outwards, world);
      ASSERT_TRUE(player.on_ground()) << i;
      const glm::dvec3 feet =
          lattice_of(world.pose(0, player.tick_time_s()).value(), player.feet());
      farthest = std::max({farthest, std::abs(feet.x), std::abs(feet.z)});
    }
    EXPECT_GT(farthest, 2.9) << "never came to an edge";
    // Without crouching the same walk ends below.
    outwards.crouch = false;
    player.advance(2.5, outwards, world);
    EXPECT_FALSE(player.on_ground());
  }
}

TEST(Player, NoSolidStopsNoclipAndLeavingItInsideOneFreesThem) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); }, plain});
  Player player(at_blocks(0.5, 2.0, 0.5), 0.0, -90.0, 0.0);
  player.set_mode(MoveMode::kNoclip);
  player.advance(2.0, {{}, -1.0}, world);
  EXPECT_LT(world::difference_blocks(player.feet(), {}).y, -15.0);
  player.set_mode(MoveMode::kWalk);
  player.advance(1.0, {}, world);
  EXPECT_NEAR(world::difference_blocks(player.feet(), {}).y, 0.0, 0.001);
}

TEST(Player, FallingOffTheWorldEndsOnGroundThatHeld) {
  TestWorld world;
  const auto pose = [](double t) { return still(world::moved({}, {2.0 * t, 0.0, 0.0})); };
  world.islands.push_back({pose,
                           [](IVec3 v) {
                             return v.y == -1 && std::abs(v.x) < 8 && std::abs(v.z) < 8
                                        ? world::block::kStone
                                        : world::block::kAirBlock;
                           },
                           12.0});
  Player player(at_blocks(0.5, 0.01, 0.5), 0.0, 0.0, 0.0);
  player.advance(1.0, {}, world);
  ASSERT_TRUE(player.on_ground());
  for (int i = 0; i < 3000 && player.returns() == 0; ++i)
    player.advance(1.0 / 60.0, {{0.0, 1.0}, 0.0, false, true}, world);
  ASSERT_EQ(player.returns(), 1);
  EXPECT_GT(player.return_fade(), 0.9);
  player.advance(kReturnFade + 0.1, {}, world);
  EXPECT_EQ(player.return_fade(), 0.0);
  EXPECT_TRUE(player.on_ground());
  const glm::dvec3 feet = lattice_of(pose(player.tick_time_s()), player.feet());
  EXPECT_NEAR(feet.y, 0.0, 0.001);
  EXPECT_LT(std::max(std::abs(feet.x), std::abs(feet.z)), 8.0);
  // The ground taken away under every place they know: back to where they began.
  world.islands[0].block = [](IVec3) { return world::block::kAirBlock; };
  for (int i = 0; i < 3000 && player.returns() == 1; ++i) player.advance(1.0 / 60.0, {}, world);
  EXPECT_EQ(player.returns(), 2);
  EXPECT_LT(glm::length(world::difference_blocks(player.feet(), at_blocks(0.5, 0.01, 0.5))), 1.0);
}

/// A plate of 16 x 16 blocks that drifts.
TestWorld drifting_plate() {
  TestWorld world;
  world.islands.push_back({[](double t) {
                             return still(world::moved({}, {2.0 * t, 0.0, 0.0}));
                           },
                           [](IVec3 v) {
                             return v.y == -1 && std::abs(v.x) < 8 && std::abs(v.z) < 8
                                        ? world::block::kStone
                                        : world::block::kAirBlock;
                           },
                           12.0});
  return world;
}

TEST(Player, SavedInTheMiddleOfAFallTheyComeBackToWhereTheyStood) {
  const TestWorld world = drifting_plate();
  Player player(at_blocks(0.5, 0.01, 0.5), 0.0, 0.0, 0.0);
  player.advance(1.0, {}, world);
  ASSERT_TRUE(player.on_ground());
  for (int i = 0; i < 3000 && world::difference_blocks(player.feet(), {}).y > -20.0; ++i)
    player.advance(1.0 / 60.0, {{0.0, 1.0}, 0.0, false, true}, world);
  ASSERT_TRUE(player.state().safe);
  Player again(player.state(), player.tick_time_s());
  for (int i = 0; i < 3000 && again.returns() == 0; ++i) again.advance(1.0 / 60.0, {}, world);
  again.advance(1.0, {}, world);
  EXPECT_EQ(again.returns(), 1);
  EXPECT_TRUE(again.on_ground());
  EXPECT_EQ(again.frame_island(), 0u);
}

TEST(Player, WhoKnowsNoGroundFallsNoFurtherThanHome) {
  const TestWorld world = drifting_plate();
  PlayerState lost;
  lost.feet = at_blocks(3000.0, -200.0, 0.0);
  Player player(lost, 7.0);
  player.set_home({0, lattice_pos({0.5, 0.0, 0.5}) + LatticePos{0, kContactGap, 0}});
  for (int i = 0; i < 3000 && player.returns() == 0; ++i) player.advance(1.0 / 60.0, {}, world);
  player.advance(1.0, {}, world);
  EXPECT_EQ(player.returns(), 1);
  EXPECT_TRUE(player.on_ground());
  EXPECT_EQ(player.frame_island(), 0u);
}

TEST(Player, AFallOntoALowerIslandIsNoLoss) {
  TestWorld world;
  const auto floor_at = [](int x_low, int top) {
    return [=](IVec3 v) {
      return v.y < top && v.y > top - 4 && v.x >= x_low && v.x < x_low + 20
                 ? world::block::kStone
                 : world::block::kAirBlock;
    };
  };
  world.islands.push_back({[](double) { return still({}); }, floor_at(-10, 0), 30.0});
  world.islands.push_back(
      {[](double) { return still(at_blocks(0.0, -140.0, 0.0)); }, floor_at(10, 0), 60.0});
  Player player(at_blocks(8.5, 0.01, 0.5), 90.0, 0.0, 0.0);
  for (int i = 0; i < 600; ++i) player.advance(1.0 / 60.0, {{0.0, i < 60 ? 1.0 : 0.0}}, world);
  EXPECT_EQ(player.returns(), 0);
  EXPECT_EQ(player.frame_island(), 1u);
  EXPECT_TRUE(player.on_ground());
}

TEST(Player, SteppingToAnotherIslandKeepsTheVelocityInTheWorld) {
  // The second island slides past sideways; whoever comes onto it slides on it at first, against
  // its motion, and comes to rest on it.
  TestWorld world;
  const glm::dvec3 slide{0.0, 0.0, 3.0};
  world.islands.push_back({[](double) { return still({}); },
                           [](IVec3 v) {
                             return v.y == -1 && v.x < 2 ? world::block::kStone
                                                         : world::block::kAirBlock;
                           }});
  world.islands.push_back({[=](double t) { return still(world::moved({}, slide * t)); },
                           [](IVec3 v) {
                             return v.y == -1 && v.x >= 2 ? world::block::kStone
                                                          : world::block::kAirBlock;
                           }});
  Player player(at_blocks(0.0, 0.01, 0.5), 90.0, 0.0, 0.0);
  player.advance(0.5, {}, world);
  ASSERT_EQ(player.frame_island(), 0u);
  double world_speed = 0.0;
  for (int i = 0; i < 600 && player.frame_island() != 1u; ++i) {
    world_speed = player.velocity().z;
    player.advance(kTickSeconds, {{0.0, 1.0}}, world);
  }
  ASSERT_EQ(player.frame_island(), 1u);
  EXPECT_NEAR(player.velocity().z + slide.z, world_speed, 0.3);  // one tick's grip
  EXPECT_NEAR(player.velocity().x, 4.5, 0.3);
  player.advance(2.0, {}, world);
  EXPECT_NEAR(glm::length(player.velocity()), 0.0, 1e-9);
  EXPECT_EQ(player.frame_island(), 1u);
}

TEST(Player, SwimmersClimbOutOntoTheShore) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); },
                           [](IVec3 v) {
                             if (v.z >= 3)
                               return v.y < 0 ? world::block::kStone : world::block::kAirBlock;
                             return v.y < -6  ? world::block::kStone
                                    : v.y < 0 ? world::block::kWater
                                              : world::block::kAirBlock;
                           }});
  Player player(at_blocks(0.5, -4.0, 0.5), 0.0, 0.0, 0.0);
  player.advance(4.0, {{0.0, 1.0}, 0.0, true, false}, world);
  const glm::dvec3 feet = world::difference_blocks(player.feet(), {});
  EXPECT_GE(feet.y, 0.0);
  EXPECT_GT(feet.z, 3.5);
}

}  // namespace
}  // namespace skerry::game
