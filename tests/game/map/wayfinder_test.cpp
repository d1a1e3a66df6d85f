#include "game/map/wayfinder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/player/world_surroundings.h"
#include "tests/world/made_islands.h"
#include "world/generate/biome.h"
#include "world/generate/shape.h"

namespace skerry::game {
namespace {

/// A player who stands at the spawn of a seed.
class WayfinderTest : public testing::Test {
 protected:
  WayfinderTest() {
    (void)world_.islands_near(spawn_.feet, 10.0, 0.0);
    const glm::dvec3 feet = world::difference_blocks(
        spawn_.feet, world_.pose(spawn_.island, 0.0).value_or(world::Pose{}).origin);
    for (const double down : {0.0, 1.0})
      world_.ensure_chunk(spawn_.island,
                          world::chunk_of({static_cast<int>(std::floor(feet.x)),
                                           static_cast<int>(std::floor(feet.y - down)),
                                           static_cast<int>(std::floor(feet.z))}));
    for (int i = 0; i < 30; ++i) wait(0.1);
  }
  void wait(double seconds) {
    around_.refresh(player_.feet(), 10.0, player_.tick_time_s());
    player_.advance(seconds, {}, around_);
  }
  world::WorldPos place_of(std::size_t i) {
    return wayfinder_.places(player_, player_.tick_time_s()).at(i).feet;
  }
  static double apart(world::WorldPos a, world::WorldPos b) {
    return glm::length(world::difference_blocks(a, b));
  }

  world::World world_{{.seed = 4}};
  world::Spawn spawn_ = world_.spawn();
  WorldSurroundings around_{world_};
  Player player_{spawn_.feet, 0.0, 0.0, 0.0};
  Wayfinder wayfinder_{world_, {}, std::nullopt};
};

TEST_F(WayfinderTest, AWaypointMovesWithItsIsland) {
  ASSERT_TRUE(player_.frame_island());
  ASSERT_TRUE(wayfinder_.mark(player_, "here"));
  EXPECT_TRUE(wayfinder_.take_changed());
  EXPECT_FALSE(wayfinder_.take_changed());
  const auto places = wayfinder_.places(player_, player_.tick_time_s());
  ASSERT_EQ(places.size(), 2u);  // the ground stood on, and the waypoint
  EXPECT_EQ(places[0].kind, ui::PlaceKind::kGround);
  EXPECT_EQ(places[1].name, "here");
  const world::WorldPos before = places[1].feet;
  EXPECT_LT(apart(before, player_.feet()), 1e-3);
  for (int i = 0; i < 100; ++i) wait(0.5);
  // Who stands still stays on it, wherever the island has gone.
  EXPECT_GT(apart(before, player_.feet()), 0.01);
  EXPECT_LT(apart(place_of(1), player_.feet()), 1e-3);
}

TEST_F(WayfinderTest, TravelEndsOnTheGroundThatWasMarked) {
  ASSERT_TRUE(wayfinder_.mark(player_, "ground"));
  const Spot marked = wayfinder_.journal().waypoints[0].spot;
  player_.set_mode(MoveMode::kFly);
  around_.refresh(player_.feet(), 10.0, player_.tick_time_s());
  for (int i = 0; i < 40; ++i) {
    around_.refresh(player_.feet(), 50.0, player_.tick_time_s());
    player_.advance(0.1, {.rise = 1.0}, around_);
  }
  EXPECT_GT(apart(player_.feet(), place_of(1)), 10.0);
  wayfinder_.travel(marked, player_, around_);
  EXPECT_EQ(player_.mode(), MoveMode::kWalk);
  EXPECT_LT(apart(player_.feet(), place_of(1)), 1e-3);
  for (int i = 0; i < 10; ++i) wait(0.1);
  EXPECT_TRUE(player_.on_ground());
  EXPECT_LT(apart(player_.feet(), place_of(1)), 0.1);
}

TEST_F(WayfinderTest, TravelIntoTheAirFlies) {
  player_.set_mode(MoveMode::kFly);
  for (int i = 0; i < 40; ++i) {
    around_.refresh(player_.feet(), 50.0, player_.tick_time_s());
    player_.advance(0.1, {.rise = 1.0}, around_);
  }
  ASSERT_TRUE(wayfinder_.mark(player_, "air"));
  const Spot air = wayfinder_.journal().waypoints[0].spot;
  wayfinder_.travel({std::nullopt, {0, 0, 0}, spawn_.feet}, player_, around_);
  EXPECT_EQ(player_.mode(), MoveMode::kFly);
  EXPECT_LT(apart(player_.feet(), spawn_.feet), 1e-3);
  player_.set_mode(MoveMode::kWalk);
  wayfinder_.travel(air, player_, around_);
  EXPECT_EQ(player_.mode(), MoveMode::kFly);
  EXPECT_GT(apart(player_.feet(), spawn_.feet), 10.0);
}

TEST_F(WayfinderTest, APlaceOnAnIslandThatIsGoneStaysWhereItWas) {
  Journal journal;
  journal.waypoints.push_back({"gone", {12345, {1, 2, 3}, world::blocks(7, 8, 9)}});
  const Wayfinder other(world_, journal, std::nullopt);
  const auto places = other.places(player_, 5.0);
  EXPECT_EQ(places.back().feet, world::blocks(7, 8, 9));
}

TEST_F(WayfinderTest, AnIslandThatIsNotKnownYetIsFound) {
  ASSERT_TRUE(wayfinder_.mark(player_, "here"));
  world::World fresh({.seed = 4});
  const Wayfinder again(fresh, wayfinder_.journal(), std::nullopt);
  const double time_s = player_.tick_time_s() + 200.0;
  const auto pose = world_.pose(*player_.frame_island(), time_s);
  const world::WorldPos there =
      world::moved(pose->origin, pose->rotation * lattice_blocks(player_.state().lattice));
  EXPECT_LT(apart(again.places(player_, time_s).back().feet, there), 1e-3);
}

TEST_F(WayfinderTest, WaypointsAreRenamedRemovedAndNotMoreThanFit) {
  while (wayfinder_.journal().waypoints.size() < kMaxWaypoints)
    ASSERT_TRUE(wayfinder_.mark(player_, "w"));
  EXPECT_FALSE(wayfinder_.mark(player_, "one more"));
  wayfinder_.rename(3, std::string(1000, 'n'));
  EXPECT_EQ(wayfinder_.journal().waypoints[3].name, std::string(kMaxWaypointBytes, 'n'));
  EXPECT_TRUE(fits_file(wayfinder_.journal()));
  wayfinder_.remove(2);
  wayfinder_.remove(999);
  EXPECT_EQ(wayfinder_.journal().waypoints.size(), kMaxWaypoints - 1);
  EXPECT_EQ(wayfinder_.journal().waypoints[2].name.size(), kMaxWaypointBytes);
  wayfinder_.make_home(wayfinder_.journal().waypoints[0].spot);
  EXPECT_EQ(wayfinder_.places(player_, 0.0).front().kind, ui::PlaceKind::kHome);
}

TEST_F(WayfinderTest, GroundIsDiscoveredOnceAndHeightsAreOfGroundStoodOn) {
  const auto found = wayfinder_.note(player_);
  ASSERT_EQ(found.size(), 2u);
  const auto spec = world_.island(*player_.frame_island());
  EXPECT_EQ(found[0].number, spec->archetype);
  EXPECT_EQ(found[1].number, spec->biome);
  EXPECT_TRUE(wayfinder_.note(player_).empty());
  const std::int64_t height = std::lround(world::difference_blocks(player_.feet(), {}).y);
  EXPECT_EQ(wayfinder_.journal().found.highest, height);
  EXPECT_EQ(wayfinder_.journal().found.deepest, height);
  player_.set_mode(MoveMode::kFly);
  for (int i = 0; i < 20; ++i) {
    around_.refresh(player_.feet(), 50.0, player_.tick_time_s());
    player_.advance(0.1, {.rise = 1.0}, around_);
    EXPECT_TRUE(wayfinder_.note(player_).empty());
  }
  EXPECT_EQ(wayfinder_.journal().found.highest, height);
}

}  // namespace
}  // namespace skerry::game
