#include "world/motion/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/world/made_islands.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

MotionState state_at(WorldPos origin, glm::dvec3 velocity = {}, double spin = 0.0,
                     double yaw = 0.0) {
  MotionState state;
  state.pose = {origin, glm::dquat{std::cos(0.5 * yaw), 0.0, std::sin(0.5 * yaw), 0.0}};
  state.velocity = velocity;
  state.spin = spin;
  return state;
}

std::vector<IVec3> cube(int half) {
  return voxels_in({-half, -half, -half}, {half, half, half});
}

std::unique_ptr<Shape> shape_of(World& world, std::uint64_t id) {
  return std::make_unique<Shape>(SolidGrid::of_island(world, id));
}

/// Momentum and energy of everything that moves.
struct Totals {
  glm::dvec3 momentum{};
  double energy = 0.0;
};
using Shapes = std::map<std::uint64_t, std::unique_ptr<Shape>>;

const Shape& shape_in(Shapes& shapes, World& world, std::uint64_t id) {
  std::unique_ptr<Shape>& shape = shapes[id];
  if (!shape) shape = shape_of(world, id);
  return *shape;
}

Totals totals(Shapes& shapes, World& world, const IslandMotion& motion) {
  Totals sum;
  for (const MovingIsland& m : motion.states()) {
    const Mass mass = shape_in(shapes, world, m.island).mass();
    const auto blocks = static_cast<double>(mass.blocks);
    sum.momentum += m.state.velocity * blocks;
    sum.energy += 0.5 * blocks * glm::dot(m.state.velocity, m.state.velocity) +
                  0.5 * mass.inertia * m.state.spin * m.state.spin;
  }
  return sum;
}

double overlap_of(Shapes& shapes, World& world, const IslandMotion& motion) {
  double sum = 0.0;
  const std::vector<MovingIsland> all = motion.states();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      sum += touch_of(shape_in(shapes, world, all[i].island), all[i].state.pose,
                      shape_in(shapes, world, all[j].island), all[j].state.pose)
                 .overlap;
  return sum;
}

TEST(Motion, WithoutEnginesAnIslandFliesStraightAndSlowsDown) {
  World world(empty_world());
  const std::uint64_t id = add_island(world, {}, cube(3));
  IslandMotion motion(world);
  motion.start(0.0);
  motion.add(id, state_at({}, {6.0, 0.0, 0.0}, 0.5));
  for (int i = 0; i < 10 * kMotionTicksPerSecond; ++i) motion.step();
  // v' = -k v: the way is v (1 - e^-kt) / k, but for steps of a tick.
  const double decay = std::exp(-10.0 * kAirDrag);
  const MotionState end = motion.states()[0].state;
  EXPECT_NEAR(end.velocity.x, 6.0 * decay, 0.01);
  EXPECT_NEAR(difference_blocks(end.pose.origin, {}).x, 6.0 * (1.0 - decay) / kAirDrag, 0.1);
  EXPECT_EQ(end.velocity.y, 0.0);
  const double yaw = 2.0 * std::atan2(end.pose.rotation.y, end.pose.rotation.w);
  EXPECT_NEAR(yaw, 0.5 * (1.0 - decay) / kAirDrag, 0.01);
  for (int i = 0; i < 90 * kMotionTicksPerSecond; ++i) motion.step();
  EXPECT_EQ(motion.states()[0].state.velocity, glm::dvec3{});  // at rest, and asleep
  EXPECT_EQ(motion.counts().awake, 0u);
}

TEST(Motion, TheWorldKnowsEveryTickOfALongFrame) {
  World world(empty_world()), other(empty_world());
  const std::uint64_t id = add_island(world, {}, cube(3));
  ASSERT_EQ(add_island(other, {}, cube(3)), id);
  std::vector<MovingIsland> moves;
  IslandMotion motion(world);
  motion.report_to(&moves);
  motion.start(1.0);
  motion.add(id, state_at({}, {6.0, 0.0, 0.0}, 0.5));
  std::map<std::int64_t, Pose> poses;
  for (int i = 0; i < 20; ++i) {
    motion.step();
    poses[motion.tick()] = motion.states()[0].state.pose;
  }
  for (const MovingIsland& move : moves)
    other.move_island(move.island, move.state.tick, move.state.pose);
  EXPECT_EQ(moves.size(), 21u);
  for (const auto& [tick, pose] : poses) {
    const double time_s = static_cast<double>(tick) * kMotionTickSeconds;
    EXPECT_NEAR(glm::length(difference_blocks(world.pose(id, time_s)->origin, pose.origin)), 0.0,
                1e-4)
        << tick;
    EXPECT_EQ(other.pose(id, time_s - 0.004)->origin, world.pose(id, time_s - 0.004)->origin);
  }
}

TEST(Motion, AllPosesAtOnceAreThoseOfEachIsland) {
  World world({.seed = 1, .offset_blocks = {std::int64_t{1} << 33, -700, 5}});
  const std::vector<IslandSpec> specs = world.islands_near(world.origin(), 1500.0, 0.0);
  ASSERT_GT(specs.size(), 20u);
  for (const int moved_islands : {0, 1, 3}) {
    for (int i = 0; i < moved_islands; ++i) {
      const IslandSpec& spec = specs[static_cast<std::size_t>(5 * i)];
      for (std::int64_t tick = 0; tick < 40; ++tick)
        world.move_island(
            spec.id, tick,
            state_at(moved(spec.origin, {0.5 * static_cast<double>(tick), 3.0, 0.0})).pose);
    }
    for (const double time_s : {0.0, 0.73, 4000.0}) {
      const IslandPoses poses = world.poses(time_s);
      int off_course = 0;
      for (const IslandSpec& spec : specs) {
        const Pose one = *world.pose(spec.id, time_s), of_all = poses.of(spec);
        EXPECT_EQ(difference_blocks(of_all.origin, one.origin), glm::dvec3(0.0));
        EXPECT_EQ(of_all.rotation, one.rotation);
        off_course += poses.is_off_course(spec.id);
      }
      EXPECT_EQ(off_course, moved_islands);
    }
  }
}

TEST(Motion, AnIslandTurnsAboutItsCentreOfMass) {
  World world(empty_world());
  const std::uint64_t id = add_island(world, {}, voxels_in({10, 0, 0}, {20, 1, 10}));
  IslandMotion motion(world);
  motion.start(0.0);
  motion.add(id, state_at({}, {}, 1.0));
  const glm::dvec3 centre{15.0, 0.5, 5.0};
  for (int i = 0; i < 200; ++i) {
    motion.step();
    const Pose pose = motion.states()[0].state.pose;
    const glm::dvec3 place = difference_blocks(pose.origin, {}) + pose.rotation * centre;
    ASSERT_LT(glm::length(place - centre), 200 * 2e-5);
  }
}

TEST(Motion, EnginesReachNoMoreThanTheLimit) {
  World world(empty_world());
  const std::uint64_t id = add_island(world, {}, cube(8));
  IslandMotion motion(world);
  motion.start(0.0);
  EXPECT_TRUE(motion.steer(id, {0.0, 0.0, 50.0}, 7.0));
  EXPECT_FALSE(motion.steer(id + 1, {1.0, 0.0, 0.0}, 0.0));
  for (int i = 0; i < 60 * kMotionTicksPerSecond; ++i) motion.step();
  const MotionState fast = motion.states()[0].state;
  const double radius = shape_of(world, id)->radius();
  EXPECT_LE(glm::length(fast.velocity) + std::abs(fast.spin) * radius, kMaxIslandSpeed);
  EXPECT_GT(std::abs(fast.spin), 0.3);
  EXPECT_TRUE(motion.steer(id, {}, 0.0));
  for (int i = 0; i < 120 * kMotionTicksPerSecond; ++i) motion.step();
  EXPECT_EQ(motion.counts().awake, 0u);
}

TEST(Motion, AnIslandKeepsTheSpeedOfItsCourseWhenItLeavesIt) {
  World world({.seed = 4});
  for (const IslandSpec& spec : world.islands_near({}, 250.0, 50.0)) {
    IslandMotion motion(world, [&](std::uint64_t) {
      return std::make_unique<Shape>(
          SolidGrid({}, [](IVec3, std::span<BlockId>) { return false; }));
    });
    motion.start(50.0);
    const glm::dvec3 place{20.0, 3.0, -7.0};
    const auto before = *motion.motion_at(spec.id, place);
    ASSERT_TRUE(motion.disturb(spec.id));
    const auto after = *motion.motion_at(spec.id, place);
    EXPECT_EQ(after.pose.origin, pose_at(spec, 50.0).origin);
    // Both by differences over a tick, of places in 1/65536 block.
    EXPECT_LT(glm::length(after.velocity - before.velocity), 1e-5);
    EXPECT_EQ(after.spin, spec.spin_rad_per_s);
    EXPECT_EQ(world.pose(spec.id, 50.0)->origin, after.pose.origin);
  }
}

TEST(Motion, WhatWasSavedGoesOnAsIfItHadNot) {
  const auto scene = [](World& world) {
    std::vector<std::uint64_t> ids;
    for (int i = 0; i < 6; ++i) ids.push_back(add_island(world, {}, cube(2 + i % 3)));
    return ids;
  };
  World once(empty_world()), twice(empty_world()), again(empty_world());
  const std::vector<std::uint64_t> ids = scene(once);
  scene(twice);
  scene(again);
  IslandMotion whole(once), first(twice);
  Rng rng(9);
  for (IslandMotion* motion : {&whole, &first}) motion->start(3.0);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const glm::dvec3 place{12.0 * static_cast<double>(i % 3), 0.0,
                           12.0 * static_cast<double>(i / 3)};
    const auto real = [&] { return rng.in(-4000, 4000) / 1000.0; };
    const MotionState state =
        state_at(moved({}, place), {real(), 0.1 * real(), real()}, real() / 9);
    whole.add(ids[i], state);
    first.add(ids[i], state);
  }
  for (int i = 0; i < 400; ++i) whole.step();
  for (int i = 0; i < 150; ++i) first.step();
  IslandMotion second(again);
  second.start(static_cast<double>(first.tick()) / kMotionTicksPerSecond);
  EXPECT_EQ(second.tick(), first.tick());
  for (const MovingIsland& m : first.states()) second.add(m.island, m.state);
  for (int i = 0; i < 250; ++i) second.step();
  const auto a = whole.states(), b = second.states();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].state, b[i].state) << i;
}

/// Islands thrown at one another: momentum stays, energy shrinks, none overlaps, none passes.
TEST(Motion, CollisionsKeepMomentumAddNoEnergyAndLeaveNoOverlap) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    World world(empty_world());
    Shapes shapes;
    IslandMotion motion(world);
    motion.start(0.0);
    Rng rng(seed);
    const auto real = [&](double most) { return rng.in(-1000, 1000) * most / 1000.0; };
    for (int i = 0; i < 9; ++i) {
      const int half = rng.in(1, 5);
      auto voxels = voxels_in({-half, -half, -half}, {half, half, half},
                              [&](IVec3) { return rng.in(0, 9) < 8; });
      const std::uint64_t id = add_island(world, {}, voxels);
      const glm::dvec3 place{18.0 * (i % 3 - 1), real(2.0), 18.0 * (i / 3 - 1)};
      motion.add(id, state_at(moved({}, place), -0.5 * place + glm::dvec3{real(2), 0, real(2)},
                              real(0.8), real(3.0)));
    }
    constexpr double kKept = 1.0 / (1.0 + kAirDrag * kMotionTickSeconds);
    Totals before = totals(shapes, world, motion);
    std::size_t touched = 0;
    for (int tick = 0; tick < 480; ++tick) {
      motion.step();
      touched += motion.counts().touching;
      const Totals after = totals(shapes, world, motion);
      // Islands that fall asleep give up what is below the speed of rest.
      ASSERT_LT(glm::length(after.momentum - before.momentum * kKept), 9 * 1000.0 / 256.0);
      ASSERT_LE(after.energy, before.energy * (1.0 + 1e-9));
      before = after;
      if (tick % 16 == 0) {
        ASSERT_EQ(overlap_of(shapes, world, motion), 0.0) << seed << " " << tick;
      }
    }
    EXPECT_GT(touched, 10u) << seed;
  }
}

TEST(Motion, TheFastestIslandDoesNotPassThroughTheThinnestWall) {
  for (int i = 0; i < 24; ++i) {
    World world(empty_world());
    IslandMotion motion(world);
    motion.start(0.0);
    const std::uint64_t wall = add_island(world, {}, voxels_in({-12, -12, 0}, {12, 12, 1}));
    const std::uint64_t bullet = add_island(world, {}, {{0, 0, 0}});
    const glm::dvec3 from{0.37 * i - 4.0, 0.61 * (i % 7) - 2.0, -30.0 - 0.05 * i};
    motion.add(wall, state_at({}, {0.0, 0.0, -kMaxIslandSpeed}));
    motion.add(bullet, state_at(moved({}, from), {0.0, 0.0, kMaxIslandSpeed}, 0.0, 0.2 * i));
    for (int tick = 0; tick < 180; ++tick) motion.step();
    double z[2] = {};
    for (const MovingIsland& m : motion.states())
      z[m.island == bullet] = difference_blocks(m.state.pose.origin, {}).z;
    EXPECT_LT(z[1], z[0] + 0.6) << i;
  }
}

TEST(Motion, AnOverlapThatWasBuiltIsPushedApartSlowly) {
  World world(empty_world());
  Shapes shapes;
  IslandMotion motion(world);
  motion.start(0.0);
  const std::uint64_t a = add_island(world, {}, cube(4)), b = add_island(world, {}, cube(4));
  motion.add(a, state_at({}, {0.0, 0.0, 0.01}));
  motion.add(b, state_at(blocks(7.0, 0.3, 0.1)));
  double overlap = overlap_of(shapes, world, motion);
  EXPECT_GT(overlap, 10.0);
  for (int tick = 0; tick < 600; ++tick) {
    motion.step();
    const double now = overlap_of(shapes, world, motion);
    ASSERT_LE(now, overlap * (1.0 + 1e-9));
    overlap = now;
    for (const MovingIsland& m : motion.states()) ASSERT_LT(glm::length(m.state.velocity), 2.0);
  }
  EXPECT_EQ(overlap, 0.0);
}

TEST(Motion, AHitTakesAnIslandFromItsCourseAndATouchDoesNot) {
  for (const bool hard : {true, false}) {
    World world(empty_world());
    IslandMotion motion(world);
    motion.start(0.0);
    const std::uint64_t still = add_island(world, {}, cube(6));
    const std::uint64_t flying = add_island(world, {}, hard ? cube(3) : cube(1));
    motion.add(flying, state_at(blocks(0.0, 0.0, -14.0), {0.0, 0.0, hard ? 6.0 : 1.0}));
    for (int tick = 0; tick < 20 * kMotionTicksPerSecond; ++tick) motion.step();
    EXPECT_EQ(motion.states().size(), hard ? 2u : 1u);
    EXPECT_EQ(difference_blocks(world.pose(still, 20.0)->origin, {}).z > 0.1, hard);
    // Either way the other did not go through.
    EXPECT_LT(
        difference_blocks(world.pose(flying, 20.0)->origin, world.pose(still, 20.0)->origin).z,
        hard ? -8.9 : -6.9);
  }
}

TEST(Motion, AnIslandWhoseShapeIsNotKnownYetIsABallThatStands) {
  World world(empty_world());
  bool known = false;
  IslandMotion motion(world, [&](std::uint64_t id) {
    return known ? shape_of(world, id) : std::unique_ptr<Shape>();
  });
  motion.start(0.0);
  const std::uint64_t id = add_island(world, {}, voxels_in({4, 0, 0}, {8, 2, 4}));
  motion.add(id, state_at({}, {1.0, 0.0, 0.0}, 0.3));
  for (int i = 0; i < 20; ++i) motion.step();
  EXPECT_EQ(motion.states()[0].state.pose.origin, WorldPos{});
  EXPECT_EQ(motion.states()[0].state.velocity, (glm::dvec3{1.0, 0.0, 0.0}));
  known = true;
  motion.step();
  EXPECT_NE(motion.states()[0].state.pose.origin, WorldPos{});
}

TEST(Motion, AnIslandOnItsCourseDoesNotPassThroughOneAtRest) {
  World world(empty_world());
  const auto stored = std::make_shared<const StoredVoxels>(chunks_from(cube(4), block::kStone));
  IslandSpec spec;
  spec.id = world.unused_id();
  spec.drift_amplitude = {0.0, 0.0, 16.0};  // at most 1.7 blocks/s
  spec.drift_period_s = 60.0;
  world.add_island(fitted(spec, *stored), stored);
  const std::uint64_t course = spec.id;
  const std::uint64_t resting = add_island(world, {}, cube(2));
  IslandMotion motion(world);
  motion.start(0.0);
  motion.add(resting, state_at(blocks(0.0, 0.0, 12.0)));
  Shapes shapes;
  bool hit = false;
  for (int tick = 0; tick < 30 * kMotionTicksPerSecond; ++tick) {
    motion.step();
    const double now = static_cast<double>(motion.tick()) * kMotionTickSeconds;
    const Touch touch = touch_of(shape_in(shapes, world, course), *world.pose(course, now),
                                 shape_in(shapes, world, resting), *world.pose(resting, now));
    if (!touch.contacts.empty()) {
      ASSERT_LT(touch.contacts.front().depth, 0.4);
    }
    hit |= difference_blocks(world.pose(resting, now)->origin, blocks(0.0, 0.0, 12.0)).z > 1.0;
  }
  EXPECT_TRUE(hit) << "it is pushed along";
}

TEST(Motion, TheClockFollowsATimeThatGoesBack) {
  World world(empty_world());
  const std::uint64_t id = add_island(world, {}, cube(3));
  IslandMotion motion(world);
  motion.start(1000.0);
  motion.add(id, state_at({}, {2.0, 0.0, 0.0}));
  for (int i = 0; i <= 60; ++i) motion.advance_to(50.0 + i / 60.0);
  EXPECT_EQ(motion.tick(), 51 * kMotionTicksPerSecond);
  EXPECT_GT(difference_blocks(world.pose(id, 51.0)->origin, {}).x, 1.5);
}

TEST(Motion, HowAPlaceMovesIsNotToldBeforeTheCentreIsKnown) {
  World world(empty_world());
  bool known = false;
  IslandMotion motion(world, [&](std::uint64_t id) {
    return known ? shape_of(world, id) : std::unique_ptr<Shape>();
  });
  motion.start(0.0);
  const std::uint64_t id = add_island(world, {}, voxels_in({4, 0, 0}, {8, 2, 4}));
  motion.add(id, state_at({}, {1.0, 0.0, 0.0}, 0.3));
  EXPECT_FALSE(motion.motion_at(id, {6.0, 1.0, 2.0}));
  known = true;
  motion.step();
  const auto moves = motion.motion_at(id, {6.0, 1.0, 2.0});
  ASSERT_TRUE(moves);
  EXPECT_NEAR(moves->velocity.x, 1.0, 0.01);
  EXPECT_NEAR(moves->velocity.z, 0.0, 0.01);
}

TEST(Motion, AnIslandSavedBeforeItsCentreIsKnownGoesOnAsItWould) {
  glm::dvec3 velocity[2];
  for (const bool saved : {false, true}) {
    World world(empty_world());
    bool known = false;
    const IslandMotion::Shapes shapes = [&](std::uint64_t id) {
      return known ? shape_of(world, id) : std::unique_ptr<Shape>();
    };
    const auto stored = std::make_shared<const StoredVoxels>(
        chunks_from(voxels_in({10, 0, 0}, {14, 2, 4}), block::kStone));
    IslandSpec spec;
    spec.id = world.unused_id();
    spec.spin_rad_per_s = 0.25;
    world.add_island(fitted(spec, *stored), stored);
    IslandMotion first(world, shapes), second(world, shapes);
    first.start(5.0);
    ASSERT_TRUE(first.disturb(spec.id));
    const MotionState then = first.states()[0].state;
    EXPECT_TRUE(then.of_origin);
    second.start(5.0);
    second.add(spec.id, then);
    known = true;
    IslandMotion& motion = saved ? second : first;
    motion.step();
    EXPECT_FALSE(motion.states()[0].state.of_origin);
    velocity[saved] = motion.states()[0].state.velocity;
  }
  EXPECT_EQ(velocity[0], velocity[1]);
  EXPECT_GT(glm::length(velocity[1]), 0.25 * 11.0) << "the centre goes round";
}

TEST(Motion, AnIslandThatComesNearAgainNeedsNoNewShape) {
  World world(empty_world());
  const auto stored = std::make_shared<const StoredVoxels>(chunks_from(cube(4), block::kStone));
  IslandSpec spec;
  spec.id = world.unused_id();
  spec.drift_amplitude = {0.0, 0.0, 16.0};
  spec.drift_period_s = 20.0;
  world.add_island(spec = fitted(spec, *stored), stored);
  const std::uint64_t flying = add_island(world, {}, cube(2));
  int asked = 0;
  IslandMotion motion(world, [&](std::uint64_t id) {
    asked += id == spec.id;
    return shape_of(world, id);
  });
  motion.start(0.0);
  const WorldPos place = blocks(6.0, 0.0, 17.0);
  motion.add(flying, state_at(place));
  bool near = false;
  int came = 0;
  for (int tick = 0; tick < 60 * kMotionTicksPerSecond; ++tick) {
    motion.step();
    const Pose pose = pose_at(spec, static_cast<double>(motion.tick()) * kMotionTickSeconds);
    const double apart = glm::length(difference_blocks(pose.origin, place));
    if (apart < spec.bounding_radius + 3.0) {
      came += !near;
      near = true;
    }
    if (apart > spec.bounding_radius + 12.0) near = false;
  }
  EXPECT_GT(came, 1);
  EXPECT_EQ(asked, 1);
}

TEST(Shape, FollowsEditsAsIfMadeAnew) {
  World world(empty_world());
  const std::uint64_t id = add_island(world, {}, cube(9));
  Shape shape(SolidGrid::of_island(world, id));
  Rng rng(4);
  for (int i = 0; i < 400; ++i) {
    const IVec3 v{rng.in(-12, 12), rng.in(-12, 12), rng.in(-12, 12)};
    const bool solid = rng.in(0, 1) == 1;
    world.set_block(id, v, solid ? BlockId{block::kStone} : kAir);
    shape.edit({&v, 1}, solid);
  }
  const auto anew = shape_of(world, id);
  EXPECT_EQ(shape.mass().blocks, anew->mass().blocks);
  EXPECT_EQ(shape.mass().centre, anew->mass().centre);
  EXPECT_EQ(shape.mass().inertia, anew->mass().inertia);
  EXPECT_EQ(shape.surface(), anew->surface());
  EXPECT_EQ(shape.radius(), anew->radius());
}

}  // namespace
}  // namespace skerry::world
