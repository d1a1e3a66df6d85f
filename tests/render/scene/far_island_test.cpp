// Islands from far away against the same islands block by block.
#include "world/generate/far_island.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "engine/render/scene/block_textures.h"
#include "world/generate/generate.h"
#include "world/islands/world.h"
#include "world/stream/stream.h"

namespace skerry::world {
namespace {

constexpr int kReach = 512;  // blocks on each side of the lattice's origin

/// What is seen of an island along one axis, a bit a block.
class Silhouette {
 public:
  void fill(int u, int v, int edge) {
    for (int i = 0; i < edge; ++i)
      for (int j = 0; j < edge; ++j) bits_->set(index(u + i, v + j));
  }
  double area() const { return static_cast<double>(bits_->count()); }
  /// Blocks that one of two shows and the other does not, over the blocks that both or one show.
  double difference(const Silhouette& other) const {
    return static_cast<double>((*bits_ ^ *other.bits_).count()) /
           static_cast<double>((*bits_ | *other.bits_).count());
  }

 private:
  static std::size_t index(int u, int v) {
    return static_cast<std::size_t>((u + kReach) * 2 * kReach + v + kReach);
  }
  using Bits = std::bitset<std::size_t{4} * kReach * kReach>;
  std::unique_ptr<Bits> bits_ = std::make_unique<Bits>();
};

struct Looks {
  std::array<Silhouette, 3> along;  // x, y, z
  glm::dvec3 colour{0.0};           // mean of what is seen from above, linear
};

glm::dvec3 mean_colour(BlockId id) {
  static const render::BlockTextures textures = render::block_textures();
  // The last mip has one texel a layer.
  const auto layer = static_cast<std::size_t>(block_types()[id].top);
  const std::byte* texel = &textures.texels.last(std::size_t{4} * textures.layers)[4 * layer];
  return {render::linear_from_srgb(texel[0]), render::linear_from_srgb(texel[1]),
          render::linear_from_srgb(texel[2])};
}

Looks of_blocks(const IslandSpec& spec) {
  Looks looks;
  const IslandGenerator generator(spec);
  std::map<std::pair<int, int>, std::pair<int, BlockId>> tops;
  std::vector<BlockId> padded(kPaddedVoxels), blocks(kChunkVoxels);
  for (const IVec3& chunk : generator.chunks(0)) {
    if (!generator.generate_padded(chunk, 0, padded)) continue;
    chunk_from_padded(padded).unpack(blocks);
    for (std::uint32_t i = 0; i < kChunkVoxels; ++i) {
      const BlockKind kind = block_kind(blocks[i]);
      if (kind == BlockKind::kAir || kind == BlockKind::kPlant) continue;
      const IVec3 v = voxel_of(chunk, i);
      looks.along[0].fill(v.y, v.z, 1);
      looks.along[1].fill(v.x, v.z, 1);
      looks.along[2].fill(v.x, v.y, 1);
      auto& top = tops.try_emplace({v.x, v.z}, v.y, blocks[i]).first->second;
      if (v.y > top.first) top = {v.y, blocks[i]};
    }
  }
  for (const auto& [place, top] : tops) looks.colour += mean_colour(top.second);
  looks.colour /= static_cast<double>(tops.size());
  return looks;
}

struct Rectangle {
  std::array<int, 3> low, extent;  // voxels; the extent along the face's axis is 1
  std::uint32_t face;
  BlockId id;
};

std::vector<Rectangle> rectangles_of(const ChunkMesh& mesh) {
  static constexpr std::array<std::size_t, 3> kAlongU{2, 0, 0}, kAlongV{1, 2, 1};
  std::vector<Rectangle> out;
  for (const shared::Quad& quad : mesh.quads) {
    Rectangle one{{},
                  {1, 1, 1},
                  shared::surface_face(quad.material),
                  static_cast<BlockId>(shared::surface_block(quad.material))};
    for (std::size_t axis = 0; axis < 3; ++axis)
      one.low[axis] = static_cast<int>(quad.geometry >> 6 * axis & 63u);
    one.extent[kAlongU[one.face / 2]] = static_cast<int>(quad.geometry >> 18 & 63u) + 1;
    one.extent[kAlongV[one.face / 2]] = static_cast<int>(quad.geometry >> 24 & 63u) + 1;
    out.push_back(one);
  }
  return out;
}

Looks of_section(const ChunkMesh& mesh, int level) {
  Looks looks;
  const int edge = 1 << level;
  double seen = 0.0;
  for (const Rectangle& one : rectangles_of(mesh)) {
    const std::size_t axis = one.face / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    for (int i = 0; i < one.extent[u]; ++i)
      for (int j = 0; j < one.extent[v]; ++j)
        looks.along[axis].fill((one.low[u] + i - 32) * edge, (one.low[v] + j - 32) * edge, edge);
    if (one.face != 2) continue;
    const double area = one.extent[0] * one.extent[2];
    looks.colour += area * mean_colour(one.id);
    seen += area;
  }
  looks.colour /= seen;
  return looks;
}

std::vector<IslandSpec> islands_of_seed_1() {
  return islands_within(1, {}, 1500.0);
}

ChunkMesh far_mesh(const IslandSpec& spec, int level) {
  ChunkMesh mesh;
  far_island(spec, far_voxel_log2(spec, level), mesh);
  return mesh;
}

// The fine island has trees, arches and ledges that the far one lacks: 28 blocks of height at most.
TEST(FarIsland, KeepsTheSilhouetteAndTheMeanColour) {
  std::array<double, 3> areas_far{}, areas_fine{};
  double differences = 0.0;
  glm::dvec3 errors(0.0), distances(0.0);
  const std::vector<IslandSpec> specs = islands_of_seed_1();
  for (const IslandSpec& spec : specs) {
    const Looks far = of_section(far_mesh(spec, kLevelCount), far_voxel_log2(spec, kLevelCount)),
                fine = of_blocks(spec);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double difference = far.along[axis].difference(fine.along[axis]);
      EXPECT_LT(difference, axis == 1 ? 0.4 : 0.55) << spec.id << " along " << axis;
      differences += difference / 3.0;
      areas_far[axis] += far.along[axis].area();
      areas_fine[axis] += fine.along[axis].area();
    }
    const glm::dvec3 error = far.colour - fine.colour;
    EXPECT_LT(glm::length(error), 0.25) << spec.id;
    errors += error;
    distances += glm::abs(error);
  }
  const auto count = static_cast<double>(specs.size());
  ASSERT_GT(count, 20.0);
  EXPECT_LT(differences / count, 0.28);
  EXPECT_NEAR(areas_far[0] / areas_fine[0], 0.9, 0.1);
  EXPECT_NEAR(areas_far[1] / areas_fine[1], 1.0, 0.04);
  EXPECT_NEAR(areas_far[2] / areas_fine[2], 0.9, 0.1);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_LT(std::abs(errors[channel] / count), 0.03) << channel;
    EXPECT_LT(distances[channel] / count, 0.06) << channel;
  }
}

// Areas of all islands together against the first far level, which is judged by their blocks.
TEST(FarIsland, KeepsItsSizeAtEveryLevel) {
  std::array<std::array<double, 3>, kFarLevelCount> areas{};
  for (const IslandSpec& spec : islands_within(3, {}, 2500.0))
    for (int i = 0; i < kFarLevelCount; ++i) {
      const Looks looks =
          of_section(far_mesh(spec, kLevelCount + i), far_voxel_log2(spec, kLevelCount + i));
      for (std::size_t axis = 0; axis < 3; ++axis)
        areas[static_cast<std::size_t>(i)][axis] += looks.along[axis].area();
    }
  for (std::size_t i = 1; i < areas.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(areas[i][axis] / areas[0][axis], 1.0, axis == 1 ? 0.12 : 0.15)
          << "level 5 + " << i << ", " << axis;
}

// Along each line of voxels a face that looks one way is followed by one that looks the other way.
TEST(FarIsland, IsAClosedSurfaceWithinItsBounds) {
  for (const IslandSpec& spec : islands_within(7, {}, 3000.0)) {
    for (int level = kLevelCount; level < kLevelCount + kFarLevelCount; ++level) {
      const ChunkMesh mesh = far_mesh(spec, level);
      ASSERT_FALSE(mesh.quads.empty()) << spec.id;
      ASSERT_EQ(mesh.range_end.back(), mesh.quads.size());
      // Planes of the faces that look along minus and along plus, by axis and line.
      std::map<std::array<int, 3>, std::array<std::vector<int>, 2>> lines;
      std::array<int, 3> low{64, 64, 64}, high{};
      for (const Rectangle& one : rectangles_of(mesh)) {
        const std::size_t axis = one.face / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
        for (int i = 0; i < one.extent[u]; ++i)
          for (int j = 0; j < one.extent[v]; ++j)
            lines[{static_cast<int>(axis), one.low[u] + i, one.low[v] + j}][one.face % 2 == 0]
                .push_back(one.low[axis] + (one.face % 2 == 0 ? 1 : 0));
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], one.low[a]);
          high[a] = std::max(high[a], one.low[a] + one.extent[a]);
        }
      }
      for (auto& [line, planes] : lines) {
        for (std::vector<int>& of : planes) std::ranges::sort(of);
        ASSERT_EQ(planes[0].size(), planes[1].size()) << spec.id;
        for (std::size_t i = 0; i < planes[0].size(); ++i) {
          EXPECT_LT(planes[0][i], planes[1][i]);
          if (i + 1 < planes[0].size()) {
            EXPECT_LT(planes[1][i], planes[0][i + 1]);
          }
        }
      }
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_EQ(mesh.bounds_min[a], low[a]);
        EXPECT_EQ(mesh.bounds_max[a], high[a]);
      }
    }
  }
}

TEST(FarIsland, TakesFewQuadsAndFewerWithDistance) {
  std::array<std::size_t, kFarLevelCount> quads{};
  const std::vector<IslandSpec> specs = islands_of_seed_1();
  for (const IslandSpec& spec : specs)
    for (int i = 0; i < kFarLevelCount; ++i)
      quads[static_cast<std::size_t>(i)] += far_mesh(spec, kLevelCount + i).quads.size();
  EXPECT_LT(quads[0], 250 * specs.size());
  for (std::size_t i = 1; i < quads.size(); ++i) EXPECT_LE(quads[i], quads[i - 1]);
  EXPECT_LT(quads.back(), 150 * specs.size());
}

// Worlds are shared by their seeds: the same quads in every build.
TEST(FarIsland, IsTheSameInEveryBuild) {
  std::uint64_t hash = 0;
  const auto mix = [&hash](std::uint64_t value) { hash = hash * 0x9e3779b97f4a7c15u + value + 1; };
  for (const IslandSpec& spec : islands_of_seed_1()) {
    for (int level = kLevelCount; level < kLevelCount + kFarLevelCount; ++level) {
      const ChunkMesh mesh = far_mesh(spec, level);
      for (const std::uint32_t end : mesh.range_end) mix(end);
      for (const shared::Quad& quad : mesh.quads) mix(quad.geometry), mix(quad.material);
    }
  }
  EXPECT_EQ(hash, 0x4c084c1dd24fccaeu) << std::hex << "0x" << hash;
}

}  // namespace
}  // namespace skerry::world
