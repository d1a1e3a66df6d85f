#include "world/mesh/emitters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

/// A padded chunk to put blocks in; coordinates -1 .. 64.
class PaddedChunk {
 public:
  BlockId& at(glm::ivec3 v) {
    return voxels_[static_cast<std::size_t>((v.z + 1) + (v.x + 1) * kPaddedEdge +
                                            (v.y + 1) * kPaddedEdge * kPaddedEdge)];
  }
  std::vector<Emitter> emitters() {
    MeshScratch scratch;
    ChunkMesh mesh;
    mesh_chunk(voxels_, scratch, mesh);
    std::vector<Emitter> out;
    find_emitters(mesh, out);
    return out;
  }

 private:
  std::vector<BlockId> voxels_ = std::vector<BlockId>(kPaddedVoxels);
};

constexpr std::array<glm::ivec3, 6> kNormals{
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

TEST(Emitters, ALoneLampShinesFromItsMiddle) {
  PaddedChunk chunk;
  chunk.at({3, 4, 5}) = block::kLamp;
  const std::vector<Emitter> expected{{{3.5f, 4.5f, 5.5f}, block::kLamp, 6, false}};
  EXPECT_EQ(chunk.emitters(), expected);
}

TEST(Emitters, ABlockInAWallShinesFromUnderItsFace) {
  PaddedChunk chunk;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 2; ++z) chunk.at({x, y, z}) = block::kStone;
  chunk.at({1, 1, 1}) = block::kGlowstone;
  const std::vector<Emitter> expected{{{1.5f, 1.5f, 1.95f}, block::kGlowstone, 1, true}};
  EXPECT_EQ(chunk.emitters(), expected);
}

TEST(Emitters, WhatIsWalledInDoesNotShine) {
  PaddedChunk chunk;
  chunk.at({9, 9, 9}) = block::kLava;
  for (const glm::ivec3 normal : kNormals) chunk.at(glm::ivec3(9) + normal) = block::kStone;
  EXPECT_TRUE(chunk.emitters().empty());
}

TEST(Emitters, WaterAndPlantsLetABlockShineAndStoneOfTheNextChunkDoesNot) {
  PaddedChunk chunk;
  chunk.at({0, 63, 9}) = block::kLava;
  for (const glm::ivec3 normal : kNormals) chunk.at(glm::ivec3(0, 63, 9) + normal) = block::kStone;
  chunk.at({1, 63, 9}) = block::kWater;
  chunk.at({0, 63, 10}) = block::kTallGrass;
  const std::vector<Emitter> emitters = chunk.emitters();
  ASSERT_EQ(emitters.size(), 1u);
  EXPECT_EQ(emitters[0].faces, 2);
  EXPECT_FALSE(emitters[0].one_way);
}

TEST(Emitters, TorchesShineEachForItselfHoweverClose) {
  PaddedChunk chunk;
  for (const int x : {10, 11}) chunk.at({x, 4, 4}) = block::kTorch;
  const std::vector<Emitter> expected{{{10.5f, 4.5f, 4.5f}, block::kTorch, 1, false},
                                      {{11.5f, 4.5f, 4.5f}, block::kTorch, 1, false}};
  EXPECT_EQ(chunk.emitters(), expected);
}

TEST(Emitters, TouchingLampsInACellShineAsOneAndLampsApartDoNot) {
  PaddedChunk chunk;
  for (const int x : {2, 3, 5}) chunk.at({x, 4, 4}) = block::kLamp;
  const std::vector<Emitter> emitters = chunk.emitters();
  ASSERT_EQ(emitters.size(), 2u);
  EXPECT_EQ(emitters[0].faces, 10);
  EXPECT_EQ(emitters[1].faces, 6);
}

/// The faces of a voxel that are drawn, found the slow way.
std::vector<glm::ivec3> open_sides(PaddedChunk& chunk, glm::ivec3 voxel) {
  std::vector<glm::ivec3> open;
  for (const glm::ivec3 normal : kNormals)
    if (block_kind(chunk.at(voxel + normal)) != BlockKind::kOpaque) open.push_back(normal);
  return open;
}

/// What shines in one cell.
struct Expected {
  int faces = 0;
  std::set<std::array<int, 3>> ways;
  std::map<std::array<int, 3>, glm::vec3> places;  // by voxel
};

TEST(Emitters, RandomChunksShineWithEveryDrawnFaceOnce) {
  constexpr std::array<BlockId, 9> kIds{
      kAir,          kAir,          block::kStone,     block::kLava,      block::kLamp,
      block::kTorch, block::kWater, block::kOakLeaves, block::kCrystalOre};
  std::mt19937 random(11);
  for (int round = 0; round < 3; ++round) {
    PaddedChunk chunk;
    std::discrete_distribution<std::size_t> pick(
        round == 0 ? std::initializer_list<double>{8, 8, 4, 1, 1, 1, 1, 1, 1}
                   : std::initializer_list<double>{0.2, 0.2, 9, 5, 5, 0.1, 0.1, 0.1, 5});
    for (int x = -1; x <= kChunkEdge; ++x)
      for (int y = -1; y <= kChunkEdge; ++y)
        for (int z = -1; z <= kChunkEdge; ++z) chunk.at({x, y, z}) = kIds[pick(random)];

    std::map<std::tuple<int, int, int, BlockId, int>, Expected> cells;
    for (int x = 0; x < kChunkEdge; ++x) {
      for (int y = 0; y < kChunkEdge; ++y) {
        for (int z = 0; z < kChunkEdge; ++z) {
          const BlockId id = chunk.at({x, y, z});
          if (block_types()[id].emission == 0.0f) continue;
          const bool plant = block_kind(id) == BlockKind::kPlant;
          const glm::ivec3 voxel{x, y, z};
          const std::vector<glm::ivec3> open =
              plant ? std::vector<glm::ivec3>{glm::ivec3(0)} : open_sides(chunk, voxel);
          if (open.empty()) continue;
          // A plant is a cell of its own: told apart by its place in the cell.
          Expected& cell = cells[{y / kEmitterCell, x / kEmitterCell, z / kEmitterCell, id,
                                  plant ? (y % 2 * 2 + x % 2) * 2 + z % 2 : 0}];
          glm::vec3 sum(0.0f);
          for (const glm::ivec3 way : open) {
            sum += glm::vec3(way);
            cell.ways.insert({way.x, way.y, way.z});
          }
          cell.faces += static_cast<int>(open.size());
          cell.places[{x, y, z}] =
              glm::vec3(voxel) + 0.5f + sum * (0.45f / static_cast<float>(open.size()));
        }
      }
    }
    const std::vector<Emitter> found = chunk.emitters();
    ASSERT_EQ(found.size(), cells.size());
    std::size_t i = 0;
    for (const auto& [key, cell] : cells) {
      const Emitter& emitter = found[i++];
      ASSERT_EQ(emitter.block, std::get<3>(key));
      EXPECT_EQ(emitter.faces, cell.faces);
      EXPECT_EQ(emitter.one_way,
                cell.ways.size() == 1 && block_kind(emitter.block) != BlockKind::kPlant);
      const glm::ivec3 voxel(glm::floor(emitter.place));
      const auto stands = cell.places.find({voxel.x, voxel.y, voxel.z});
      ASSERT_NE(stands, cell.places.end()) << "it stands in a block that does not shine";
      EXPECT_LT(glm::length(stands->second - emitter.place), 1e-4f);
    }
  }
}

TEST(Emitters, MergingKeepsTheLightAndErrsLittleFurtherAway) {
  // A pool of 12 x 12 lava blocks in a floor, seen from a wall: what merging changes there.
  PaddedChunk chunk;
  for (int x = 0; x < 40; ++x)
    for (int z = 0; z < 40; ++z) chunk.at({x, 8, z}) = block::kStone;
  for (int x = 8; x < 20; ++x)
    for (int z = 8; z < 20; ++z) {
      chunk.at({x, 7, z}) = block::kStone;
      chunk.at({x, 8, z}) = block::kLava;
    }
  const std::vector<Emitter> merged = chunk.emitters();
  EXPECT_EQ(merged.size(), 36u);
  // Irradiance of a wall at x = const, facing the pool.
  const auto arriving = [](glm::vec3 light, glm::vec3 point) {
    const glm::vec3 to = light - point;
    const float distance = glm::length(to);
    return std::max(0.0f, -to.x / distance) / (distance * distance);
  };
  for (const auto& [away, most] : {std::pair{2.0f, 0.05f}, {4.0f, 0.02f}, {8.0f, 0.006f}}) {
    const glm::vec3 point{20.0f + away, 10.0f, 14.0f};
    float of_merged = 0.0f, of_all = 0.0f;
    for (const Emitter& emitter : merged)
      of_merged += static_cast<float>(emitter.faces) * arriving(emitter.place, point);
    for (int x = 8; x < 20; ++x)
      for (int z = 8; z < 20; ++z)
        of_all +=
            arriving({static_cast<float>(x) + 0.5f, 8.95f, static_cast<float>(z) + 0.5f}, point);
    EXPECT_NEAR(of_merged / of_all, 1.0f, most) << away;
  }
}

}  // namespace
}  // namespace skerry::world
