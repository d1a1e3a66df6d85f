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
    Rectangle one{{}, {1, 1, 1}, shared::surface_face(quad.material),
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

std::vector<IslandSpec> islands_of_seed_1() { return islands_within(1, {}, 1500.0); }

TEST(FarIsland, KeepsTheSilhouetteAndTheMeanColour) {
  double differences = 0.0, areas_far = 0.0, areas_fine = 0.0, worst_colour = 0.0;
  int count = 0;
  glm::dvec3 colour_error(0.0);
  for (const IslandSpec& spec : islands_of_seed_1()) {
    const int level = far_voxel_log2(spec, kLevelCount);
    ChunkMesh mesh;
    far_island(spec, level, mesh);
    const Looks far = of_section(mesh, level), fine = of_blocks(spec);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      differences += far.along[axis].difference(fine.along[axis]);
      areas_far += far.along[axis].area();
      areas_fine += fine.along[axis].area();
      EXPECT_LT(far.along[axis].difference(fine.along[axis]), 0.6) << spec.id << " axis " << axis;
      ++count;
    }
    const glm::dvec3 error = far.colour - fine.colour;
    colour_error += error;
    worst_colour = std::max(worst_colour, glm::length(error));
    std::printf("id %llx arch %u biome %u R %d: diff %.2f %.2f %.2f area %.2f %.2f %.2f colour %.3f %.3f %.3f vs %.3f %.3f %.3f quads %zu\n", (unsigned long long)spec.id, spec.archetype, spec.biome, spec.box_max.x - 10, far.along[0].difference(fine.along[0]), far.along[1].difference(fine.along[1]), far.along[2].difference(fine.along[2]),
      far.along[0].area()/fine.along[0].area(), far.along[1].area()/fine.along[1].area(), far.along[2].area()/fine.along[2].area(), far.colour.x, far.colour.y, far.colour.z, fine.colour.x, fine.colour.y, fine.colour.z, mesh.quads.size());
  }
  std::printf("mean diff %.3f area %.3f worst colour %.3f\n", differences / count, areas_far / areas_fine, worst_colour);
}

}  // namespace
}  // namespace skerry::world
