#include "world/motion/split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "tests/world/made_islands.h"
#include "world/motion/motion.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

using Voxels = std::set<IVec3>;

constexpr IVec3 kSteps[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

IVec3 plus(IVec3 a, IVec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// By definition, one voxel after the other.
std::vector<Voxels> components(Voxels left) {
  std::vector<Voxels> out;
  while (!left.empty()) {
    Voxels& part = out.emplace_back();
    std::vector<IVec3> open{*left.begin()};
    left.erase(left.begin());
    while (!open.empty()) {
      const IVec3 v = open.back();
      open.pop_back();
      part.insert(v);
      for (const IVec3& step : kSteps)
        if (const auto found = left.find(plus(v, step)); found != left.end()) {
          open.push_back(*found);
          left.erase(found);
        }
    }
  }
  return out;
}

Voxels voxels_of(const Fragment& fragment) {
  Voxels out;
  for (const auto& [at, bits] : fragment.bricks)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)
        for (int z = 0; z < 8; ++z)
          if (bits.at(x, y, z)) out.insert({at.x * 8 + x, at.y * 8 + y, at.z * 8 + z});
  return out;
}

/// Solid voxels of an island by id.
Voxels voxels_of(World& world, std::uint64_t id) {
  Voxels out;
  for (const IVec3& at : world.chunks(id, 0)) {
    const Chunk chunk = world.chunk_now(id, at);
    for (std::uint32_t i = 0; i < kChunkVoxels; ++i)
      if (is_solid(chunk.at(i))) out.insert(voxel_of(at, i));
  }
  return out;
}

SolidGrid grid_of(const Voxels& voxels) {
  const std::vector<IVec3> list(voxels.begin(), voxels.end());
  const auto chunks = std::make_shared<std::map<IVec3, Chunk>>(chunks_from(list, block::kStone));
  std::vector<IVec3> names;
  for (const auto& [at, chunk] : *chunks) names.push_back(at);
  return {names, [chunks](IVec3 at, std::span<BlockId> out) {
            const auto found = chunks->find(at);
            if (found == chunks->end()) return false;
            found->second.unpack(out);
            return true;
          }};
}

/// One connected blob, thin enough to break often: the largest part of random voxels.
Voxels random_island(std::uint64_t seed, int reach, int percent) {
  Rng rng(seed);
  Voxels voxels;
  for (const IVec3& v : voxels_in({-reach, -reach, -reach}, {reach, reach, reach}))
    if (rng.in(0, 99) < percent) voxels.insert(v);
  const std::vector<Voxels> parts = components(voxels);
  return *std::max_element(parts.begin(), parts.end(),
                           [](const Voxels& a, const Voxels& b) { return a.size() < b.size(); });
}

TEST(Split, FindsWhatAFloodFillFinds) {
  int broken = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Voxels island = random_island(seed, 10, 34);
    Rng rng(seed);
    for (int cut = 0; cut < 12 && island.size() > 50; ++cut) {
      auto victim = island.begin();
      std::advance(victim, rng.in(0, static_cast<int>(island.size()) - 1));
      const IVec3 removed = *victim;
      island.erase(victim);
      const SolidGrid grid = grid_of(island);
      const SplitSearch search = find_fragments(grid, {&removed, 1});
      std::vector<Voxels> parts = components(island);
      const auto largest =
          std::max_element(parts.begin(), parts.end(),
                           [](const Voxels& a, const Voxels& b) { return a.size() < b.size(); });
      const std::size_t largest_size = largest->size();
      ASSERT_EQ(search.fragments.size(), parts.size() - 1);
      Voxels fragments;
      for (const Fragment& fragment : search.fragments) {
        const Voxels voxels = voxels_of(fragment);
        EXPECT_NE(std::find(parts.begin(), parts.end(), voxels), parts.end());
        EXPECT_EQ(fragment.mass.blocks, voxels.size());
        EXPECT_LE(voxels.size(), largest_size);
        fragments.insert(voxels.begin(), voxels.end());
      }
      broken += parts.size() > 1;
      for (const IVec3& v : fragments) island.erase(v);
    }
  }
  EXPECT_GT(broken, 20);
}

TEST(Split, ManyVoxelsTakenAtOnceLeaveManyFragments) {
  // A comb: teeth on a bar, and the bar is taken.
  Voxels comb;
  std::vector<IVec3> bar;
  for (int x = -40; x < 40; ++x) {
    bar.push_back({x, 0, 0});
    if (x % 2 == 0)
      for (int y = 1; y < 12 + x / 8; ++y) comb.insert({x, y, 0});
  }
  const SplitSearch search = find_fragments(grid_of(comb), bar);
  EXPECT_EQ(search.fragments.size(), 39u);  // the longest tooth remains
}

TEST(Split, MassIsThatOfTheVoxels) {
  const Voxels island = random_island(3, 12, 40);
  MassSum sum;
  const SolidGrid grid = grid_of(island);
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x)
      for (int z = -2; z < 2; ++z)
        if (const BitBrick* brick = grid.brick({x, y, z})) sum.add({x, y, z}, *brick, 1);
  const Mass mass = sum.mass();
  glm::dvec3 centre{};
  for (const IVec3& v : island) centre += glm::dvec3{v.x + 0.5, v.y + 0.5, v.z + 0.5};
  centre /= static_cast<double>(island.size());
  double inertia = 0.0;
  for (const IVec3& v : island)
    inertia += 1.0 / 6.0 + std::pow(v.x + 0.5 - centre.x, 2) + std::pow(v.z + 0.5 - centre.z, 2);
  EXPECT_EQ(mass.blocks, island.size());
  EXPECT_LT(glm::length(mass.centre - centre), 1e-9);
  EXPECT_NEAR(mass.inertia / inertia, 1.0, 1e-12);
}

TEST(Split, NotAVoxelMovesOrIsLostOrHeldTwice) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    World world(empty_world());
    const Voxels before = random_island(seed + 50, 14, 33);
    const std::uint64_t id =
        add_island(world, blocks(10.0, 20.0, 30.0), {before.begin(), before.end()});
    world.move_island(id, 0, {blocks(10.25, 20.5, 30.125), glm::dquat{0.6, 0.0, 0.8, 0.0}});
    const Pose pose = *world.pose(id, 0.0);
    Rng rng(seed);
    Voxels island = before;
    std::vector<std::uint64_t> ids{id};
    for (int cut = 0; cut < 40; ++cut) {
      auto victim = island.begin();
      std::advance(victim, rng.in(0, static_cast<int>(island.size()) - 1));
      const IVec3 removed = *victim;
      island.erase(victim);
      world.set_block(id, removed, kAir);
      SolidGrid grid = SolidGrid::of_island(world, id);
      for (const Fragment& fragment : find_fragments(grid, {&removed, 1}).fragments) {
        const Voxels moved_voxels = voxels_of(fragment);
        const BrokenOff off = break_off(world, id, *copy_piece(world, id, fragment), pose);
        EXPECT_EQ(off.mass.blocks, moved_voxels.size());
        const Voxels now = voxels_of(world, off.island);
        ASSERT_EQ(now.size(), moved_voxels.size());
        // The same places of the world, to the rounding of one lattice origin.
        const IslandSpec spec = *world.island(off.island);
        auto to = now.begin();
        for (auto from = moved_voxels.begin(); from != moved_voxels.end(); ++from, ++to) {
          const glm::dvec3 was = pose.rotation * glm::dvec3{from->x, from->y, from->z};
          const glm::dvec3 is = pose.rotation * glm::dvec3{to->x, to->y, to->z};
          const glm::dvec3 error = difference_blocks(spec.origin, pose.origin) + is - was;
          ASSERT_LT(glm::length(error), 2e-5);
        }
        for (const IVec3& v : moved_voxels) island.erase(v);
        ids.push_back(off.island);
      }
    }
    EXPECT_EQ(voxels_of(world, id), island);
    EXPECT_GT(ids.size(), 1u);
  }
}

TEST(Split, WhatWasDugMeanwhileIsLeftOut) {
  World world(empty_world());
  const std::uint64_t id = add_island(world, {}, voxels_in({-8, 0, 0}, {5, 1, 1}));
  const IVec3 removed{1, 0, 0};
  world.set_block(id, removed, kAir);
  SolidGrid grid = SolidGrid::of_island(world, id);
  const SplitSearch search = find_fragments(grid, {&removed, 1});
  ASSERT_EQ(search.fragments.size(), 1u);
  ASSERT_EQ(search.fragments[0].mass.blocks, 3u);
  world.set_block(id, {2, 0, 0}, kAir);
  world.set_block(id, {3, 0, 0}, block::kTorch);
  const auto piece = copy_piece(world, id, search.fragments[0]);
  ASSERT_TRUE(piece);
  const BrokenOff off = break_off(world, id, *piece, *world.pose(id, 0.0));
  EXPECT_EQ(off.mass.blocks, 1u);
  EXPECT_EQ(off.mass.centre.x, 1.5) << "4.5, from where the middle of the fragment was";
  EXPECT_EQ(world.chunk_now(id, {0, 0, 0}).at(3, 0, 0), block::kTorch);
  EXPECT_FALSE(copy_piece(world, id, search.fragments[0]));
  EXPECT_EQ(world.added_islands().size(), 2u);
}

TEST(Split, AllChunksOfAWaterColumnCountAsChanged) {
  World world(empty_world());
  std::vector<IVec3> voxels = voxels_in({-8, 0, 0}, {3, 1, 1});
  const std::uint64_t id = add_island(world, {}, voxels);
  for (int y = 1; y < 150; ++y) world.set_block(id, {2, y, 0}, block::kWater);
  const IVec3 removed{1, 0, 0};
  world.set_block(id, removed, kAir);
  SolidGrid grid = SolidGrid::of_island(world, id);
  const SplitSearch search = find_fragments(grid, {&removed, 1});
  ASSERT_EQ(search.fragments.size(), 1u);
  const auto piece = copy_piece(world, id, search.fragments[0]);
  ASSERT_TRUE(piece);
  const BrokenOff off = break_off(world, id, *piece, *world.pose(id, 0.0));
  EXPECT_EQ(off.changed, (std::vector<IVec3>{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}));
}

TEST(Split, WhatStandsOnAFragmentGoesAlong) {
  World world(empty_world());
  std::vector<IVec3> voxels = voxels_in({-4, 0, 0}, {5, 1, 1});
  for (const IVec3& v : voxels_in({-4, -3, -3}, {-1, 0, 3})) voxels.push_back(v);
  const std::uint64_t id = add_island(world, {}, voxels);
  world.set_block(id, {3, 1, 0}, block::kFern);
  world.set_block(id, {4, 1, 0}, block::kWater);
  world.set_block(id, {4, 2, 0}, block::kWater);
  world.set_block(id, {-2, 1, 0}, block::kTorch);
  world.set_block(id, {1, 0, 0}, kAir);
  const IVec3 removed{1, 0, 0};
  SolidGrid grid = SolidGrid::of_island(world, id);
  const SplitSearch search = find_fragments(grid, {&removed, 1});
  ASSERT_EQ(search.fragments.size(), 1u);
  const BrokenOff off =
      break_off(world, id, *copy_piece(world, id, search.fragments[0]), *world.pose(id, 0.0));
  // [2, 5) had its middle at 3.5: the new lattice begins at 3.
  EXPECT_EQ(world.chunk_now(off.island, {0, 0, 0}).at(0, 1, 0), block::kFern);
  EXPECT_EQ(world.chunk_now(off.island, {0, 0, 0}).at(1, 2, 0), block::kWater);
  EXPECT_EQ(world.chunk_now(id, {0, 0, 0}).at(4, 2, 0), kAir);
  EXPECT_EQ(world.chunk_now(id, {0, 0, 0}).at(3, 1, 0), kAir);
  EXPECT_EQ(world.chunk_now(id, {-1, 0, 0}).at(62, 1, 0), block::kTorch);
}

/// A large part and a smaller one on one neck: the search walks as much of the large one as of the
/// smaller, and a cut that breaks nothing looks at next to nothing.
TEST(Split, WorkFollowsTheSmallerPart) {
  const auto voxels = voxels_in({-64, -32, -64}, {64, 32, 65}, [](IVec3 v) {
    return v.z < 0 || v.z > 0 || (v.x == 0 && v.y == 0);
  });
  World world(empty_world());
  std::vector<IVec3> some = voxels;
  std::erase_if(some, [](IVec3 v) { return v.z > 16; });  // the smaller part: 131,072 blocks
  const std::uint64_t id = add_island(world, {}, some);
  SolidGrid grid = SolidGrid::of_island(world, id);
  grid.complete();
  const IVec3 surface{-64, 31, -64}, neck{0, 0, 0};
  grid.set(surface, false);
  const SplitSearch nothing = find_fragments(grid, {&surface, 1});
  EXPECT_TRUE(nothing.fragments.empty());
  EXPECT_LT(nothing.bricks_looked_at, 10u);
  grid.set(neck, false);
  const SplitSearch search = find_fragments(grid, {&neck, 1});
  ASSERT_EQ(search.fragments.size(), 1u);
  EXPECT_EQ(search.fragments[0].mass.blocks, 131'072u);
  // Its bricks, some of them in several pieces, and as many of the other.
  EXPECT_LE(search.bricks_looked_at, 3u * 16 * 8 * 3);
}

TEST(Split, APieceFliesOnAsItsVoxelsDid) {
  World world(empty_world());
  const auto bar = voxels_in({-20, 0, 0}, {21, 1, 1});
  const std::uint64_t id = add_island(world, {}, bar);
  IslandMotion motion(world);
  motion.start(0.0);
  MotionState state;
  state.pose = {{}, glm::dquat{0.6, 0.0, 0.8, 0.0}};
  state.velocity = {1.0, 0.5, -0.25};
  state.spin = 0.2;
  motion.add(id, state);
  motion.step();
  // Ends of what will be two pieces, before ...
  const glm::dvec3 left{-19.5, 0.5, 0.5}, right{20.5, 0.5, 0.5};
  const glm::dvec3 v_left = motion.motion_at(id, left)->velocity;
  const glm::dvec3 v_right = motion.motion_at(id, right)->velocity;
  EXPECT_NEAR(glm::length(v_right - v_left), 40.0 * 0.2 * 0.998, 0.02);
  const IVec3 cut{5, 0, 0};
  world.set_block(id, cut, kAir);
  motion.edited(id, {&cut, 1}, false);
  SolidGrid grid = SolidGrid::of_island(world, id);
  const SplitSearch search = find_fragments(grid, {&cut, 1});
  ASSERT_EQ(search.fragments.size(), 1u);
  const glm::dvec3 middle = search.fragments[0].mass.centre;
  const auto at = *motion.motion_at(id, middle);
  const BrokenOff off = break_off(world, id, *copy_piece(world, id, search.fragments[0]), at.pose);
  MotionState piece;
  piece.pose = {world.island(off.island)->origin, at.pose.rotation};
  piece.velocity = at.velocity;
  piece.spin = at.spin;
  motion.add(off.island, piece);
  std::vector<IVec3> gone;
  for (const IVec3& v : voxels_of(search.fragments[0])) gone.push_back(v);
  motion.edited(id, gone, false);
  // ... and after.
  const glm::dvec3 shift = glm::floor(middle);
  EXPECT_LT(glm::length(motion.motion_at(id, left)->velocity - v_left), 1e-12);
  EXPECT_LT(glm::length(motion.motion_at(off.island, right - shift)->velocity - v_right), 1e-12);
}

}  // namespace
}  // namespace skerry::world
