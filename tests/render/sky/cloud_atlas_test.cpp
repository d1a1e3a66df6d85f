// Grids packed into bricks and cells: what is found in them is what the grid holds, everywhere.
#include "engine/render/sky/cloud_atlas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <map>
#include <random>

namespace skerry::render {
namespace {

constexpr std::uint32_t kMostTexels = 2048;

/// A grid made of samples, as a map; and the bricks that hold them.
struct MadeGrid {
  std::map<std::array<int, 3>, float> samples;
  std::map<std::array<int, 3>, std::array<float, 512>> bricks;
  void set(int x, int y, int z, float value) {
    samples[{x, y, z}] = value;
    const auto base = [](int v) { return (v >> 3) * 8; };
    auto& values = bricks.try_emplace({base(x), base(y), base(z)}).first->second;
    values[static_cast<std::size_t>((z & 7) + 8 * (y & 7) + 64 * (x & 7))] = value;
  }
  CloudVolumeDesc desc() const {
    CloudVolumeDesc out;
    for (const auto& [at, values] : bricks)
      out.bricks.push_back({{at[0], at[1], at[2]}, values.data()});
    return out;
  }
};

float texel_of(const CloudAtlas& atlas, glm::uvec3 at) {
  const std::size_t i = (std::size_t{at.z} * atlas.brick_texels.y + at.y) * atlas.brick_texels.x;
  float value = 0.0f;
  std::memcpy(&value, atlas.bricks.data() + (i + at.x) * 4, 4);
  return value;
}

std::array<int, 4> cell_of(const CloudAtlas& atlas, std::uint32_t level, glm::ivec3 at) {
  glm::uvec3 size = atlas.cells;
  std::size_t first = 0;
  for (std::uint32_t l = 0; l < level; ++l, size /= 2u)
    first += std::size_t{size.x} * size.y * size.z * 4;
  const glm::uvec3 p(at);
  const std::byte* texel =
      atlas.cell_texels.data() + first + ((std::size_t{p.z} * size.y + p.y) * size.x + p.x) * 4;
  std::array<int, 4> out{};
  for (std::size_t c = 0; c < 4; ++c) out[c] = static_cast<int>(texel[c]);
  return out;
}

/// The trilinear value at a place, by way of a 32-bit atlas, as the shaders look it up.
double looked_up(const CloudAtlas& atlas, const PackedVolume& v, glm::dvec3 at) {
  const glm::ivec3 cell(glm::floor((at - glm::dvec3(v.cell_low)) / 8.0));
  for (int axis = 0; axis < 3; ++axis)
    if (cell[axis] < 0 || cell[axis] >= v.cell_count[axis]) return 0.0;
  const std::array<int, 4> found = cell_of(atlas, 0, v.first_cell + cell);
  if (found[3] == 0) return 0.0;
  const glm::dvec3 inside = at - glm::dvec3(v.cell_low + cell * 8);
  const glm::ivec3 low(glm::floor(inside));
  const glm::dvec3 f = inside - glm::dvec3(low);
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2);
    const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(corner));
    const glm::ivec3 texel =
        glm::ivec3(found[0], found[1], found[2]) * 9 + glm::min(low + corner, glm::ivec3(8));
    sum += w.x * w.y * w.z * static_cast<double>(texel_of(atlas, glm::uvec3(texel)));
  }
  return sum * static_cast<double>(v.value_range);
}

double exact(const MadeGrid& grid, glm::dvec3 at) {
  const glm::ivec3 low(glm::floor(at));
  const glm::dvec3 f = at - glm::dvec3(low);
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, (i >> 1) & 1, i >> 2), p = low + corner;
    const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(corner));
    const auto found = grid.samples.find({p.x, p.y, p.z});
    const double value = found == grid.samples.end() ? 0.0 : static_cast<double>(found->second);
    sum += w.x * w.y * w.z * std::max(value, 0.0);
  }
  return sum;
}

TEST(CloudAtlas, HoldsWhatTheGridHoldsAcrossBricks) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(-0.5f, 3.0f);
  MadeGrid grid;
  for (int i = 0; i < 900; ++i)
    grid.set(static_cast<int>(random() % 40) - 19, static_cast<int>(random() % 23) - 30,
             static_cast<int>(random() % 30) + 3, value(random));
  const CloudVolumeDesc desc = grid.desc();
  const Result<CloudAtlas> atlas =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(atlas) << atlas.error().message;
  const PackedVolume& v = atlas->volumes[0];
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  double off = 0.0, largest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 at = glm::mix(glm::dvec3(v.low), glm::dvec3(v.high),
                                   glm::dvec3(share(random), share(random), share(random)));
    const double truth = exact(grid, at);
    off = std::max(off, std::abs(looked_up(*atlas, v, at) - truth));
    largest = std::max(largest, truth);
  }
  EXPECT_LT(off, 1e-5);
  EXPECT_GT(largest, 1.0);
}

TEST(CloudAtlas, NothingLiesBeyondTheSupportBox) {
  MadeGrid grid;
  grid.set(8, 16, -8, 1.0f);  // on the low corner of its brick: three cells before it hold a part
  const CloudVolumeDesc desc = grid.desc();
  const Result<CloudAtlas> atlas =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(atlas);
  const PackedVolume& v = atlas->volumes[0];
  EXPECT_EQ(v.low, glm::ivec3(7, 15, -9));
  EXPECT_EQ(v.high, glm::ivec3(9, 17, -7));
  EXPECT_EQ(atlas->brick_count, 8u) << "one, and what it reaches into of its seven neighbours";
  EXPECT_DOUBLE_EQ(looked_up(*atlas, v, {7.5, 15.5, -8.5}), 0.125);
}

TEST(CloudAtlas, MaximaOfCellsBoundEveryValueWithin) {
  std::mt19937 random(3);
  MadeGrid grid;
  for (int i = 0; i < 60; ++i)
    grid.set(static_cast<int>(random() % 90), static_cast<int>(random() % 90),
             static_cast<int>(random() % 90), static_cast<float>(random() % 1000) / 1000.0f);
  const CloudVolumeDesc desc = grid.desc();
  const Result<CloudAtlas> atlas =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(atlas);
  const PackedVolume& v = atlas->volumes[0];
  int empty = 0;
  for (std::uint32_t level = 0; level < shared::kCloudCellLevels; ++level) {
    const int edge = 8 << level;
    for (int i = 0; i < 3000; ++i) {
      const glm::ivec3 cell(random() % static_cast<unsigned>(v.cell_count.x),
                            random() % static_cast<unsigned>(v.cell_count.y),
                            random() % static_cast<unsigned>(v.cell_count.z));
      const glm::ivec3 coarse = cell >> static_cast<int>(level);
      const double most = cell_of(*atlas, level, v.first_cell / (edge / 8) + coarse)[3] / 255.0;
      const glm::dvec3 at =
          glm::dvec3(v.cell_low + cell * 8) + glm::dvec3(static_cast<double>(random() % 80)) / 10.0;
      EXPECT_LE(looked_up(*atlas, v, at), most * static_cast<double>(v.value_range) + 1e-6);
      empty += most == 0.0;
    }
  }
  EXPECT_GT(empty, 1000) << "there must be emptiness to skip";
}

TEST(CloudAtlas, LargeTilesTakeOneBrickAndTheirRim) {
  CloudVolumeDesc desc;
  desc.tiles.push_back({{0, 0, 0}, 128, 2.0f});
  const Result<CloudAtlas> atlas =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(atlas);
  // 17^3 cells, of which 15^3 lie within the tile with all that they read.
  EXPECT_EQ(atlas->brick_count, 17u * 17u * 17u - 15u * 15u * 15u + 1u);
  const PackedVolume& v = atlas->volumes[0];
  EXPECT_DOUBLE_EQ(looked_up(*atlas, v, {60.3, 61.9, 0.0}), 2.0);
  EXPECT_DOUBLE_EQ(looked_up(*atlas, v, {60.0, 61.0, -0.5}), 1.0);
  EXPECT_DOUBLE_EQ(looked_up(*atlas, v, {127.25, 61.0, 3.0}), 1.5);
}

TEST(CloudAtlas, PrecisionsRoundByHalfAStep) {
  MadeGrid grid;
  for (int i = 0; i < 512; ++i) grid.set(i & 7, (i >> 3) & 7, i >> 6, static_cast<float>(i) / 300);
  const CloudVolumeDesc desc = grid.desc();
  const Result<CloudAtlas> bytes =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k8, kMostTexels);
  const Result<CloudAtlas> floats =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(bytes && floats);
  ASSERT_EQ(bytes->bricks.size() * 4, floats->bricks.size());
  for (std::size_t i = 0; i < bytes->bricks.size(); ++i) {
    float value = 0.0f;
    std::memcpy(&value, floats->bricks.data() + i * 4, 4);
    EXPECT_NEAR(static_cast<float>(bytes->bricks[i]) / 255.0f, value, 0.5001f / 255.0f);
  }
}

TEST(CloudAtlas, AnAbsurdDensityTakesNoDigitsFromTheOthers) {
  MadeGrid grid;
  for (int i = 0; i < 100; ++i) grid.set(i % 10, i / 10, 0, 1.0f);
  grid.set(40, 0, 0, 1e30f);
  CloudVolumeDesc desc = grid.desc();
  const Result<CloudAtlas> dense =
      pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(dense);
  EXPECT_EQ(dense->volumes[0].value_range, 1e4f);
  EXPECT_NEAR(looked_up(*dense, dense->volumes[0], {4.5, 4.5, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(looked_up(*dense, dense->volumes[0], {40.0, 0.0, 0.0}), 1e4, 1e-2);
  desc.role = CloudRole::kEmission;
  const Result<CloudAtlas> hot = pack_clouds(std::span(&desc, 1), CloudPrecision::k32, kMostTexels);
  ASSERT_TRUE(hot);
  EXPECT_EQ(hot->volumes[0].value_range, 1e30f) << "a glow is relative to its largest value";
}

TEST(CloudAtlas, RefusesWhatCannotBeDrawn) {
  CloudVolumeDesc far;
  far.tiles.push_back({{0, 0, 0}, 8, 1.0f});
  far.tiles.push_back({{1 << 20, 1 << 20, 0}, 8, 1.0f});
  EXPECT_FALSE(pack_clouds(std::span(&far, 1), CloudPrecision::k8, kMostTexels));
  CloudVolumeDesc flat;
  flat.tiles.push_back({{0, 0, 0}, 8, 1.0f});
  flat.blocks_from_index[1] = glm::dvec4(0.0);
  EXPECT_FALSE(pack_clouds(std::span(&flat, 1), CloudPrecision::k8, kMostTexels));
  // Each box is small enough, but the image that would hold both is as wide as one and as high as
  // the other.
  std::vector<CloudVolumeDesc> wide_and_high(2);
  for (CloudVolumeDesc& desc : wide_and_high) desc.tiles.push_back({{0, 0, 0}, 8, 1.0f});
  wide_and_high[0].tiles.push_back({{16000, 0, 40}, 8, 1.0f});
  wide_and_high[1].tiles.push_back({{0, 16000, 40}, 8, 1.0f});
  for (const CloudVolumeDesc& desc : wide_and_high)
    EXPECT_TRUE(pack_clouds(std::span(&desc, 1), CloudPrecision::k8, kMostTexels));
  EXPECT_FALSE(pack_clouds(wide_and_high, CloudPrecision::k8, kMostTexels));
  std::vector<CloudVolumeDesc> many(shared::kMaxCloudVolumes + 1);
  EXPECT_TRUE(pack_clouds(many, CloudPrecision::k8, kMostTexels)) << "there is nothing in them";
  for (CloudVolumeDesc& desc : many) desc.tiles.push_back({{0, 0, 0}, 8, 1.0f});
  EXPECT_FALSE(pack_clouds(many, CloudPrecision::k8, kMostTexels));
  CloudVolumeDesc nothing;
  nothing.tiles.push_back({{0, 0, 0}, 8, -1.0f});
  const Result<CloudAtlas> empty =
      pack_clouds(std::span(&nothing, 1), CloudPrecision::k8, kMostTexels);
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->brick_count, 0u);
}

}  // namespace
}  // namespace skerry::render
