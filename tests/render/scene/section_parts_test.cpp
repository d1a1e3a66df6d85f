#include "engine/render/scene/section_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <span>
#include <tuple>

#include "engine/render/scene/voxel_box.h"

namespace skerry::render {
namespace {

/// Random quads within a chunk, in ranges as a mesher orders them.
std::vector<shared::Quad> random_quads(std::size_t count, shared::Section& section) {
  std::mt19937 random(7);
  const auto below = [&](std::uint32_t limit) {
    return static_cast<std::uint32_t>(random() % limit);
  };
  std::vector<shared::Quad> quads;
  for (std::uint32_t range = 0; range < shared::kRangeCount; ++range) {
    const bool plant = range == shared::kRangePlant;
    const std::uint32_t face =
        plant ? 6 + below(2) : (range > shared::kRangePlant ? range - 1 : range) % 6;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t x = below(64), y = below(64), z = below(64);
      const std::uint32_t room = 64 - std::max({x, y, z});
      const std::uint32_t u = plant ? 0 : below(room), v = plant ? 0 : below(room);
      quads.push_back(
          {x | y << 6 | z << 12 | u << 18 | v << 24, below(1000) | face << shared::kFaceShift});
    }
    section.range_end[range] = static_cast<std::uint32_t>(quads.size());
  }
  return quads;
}

using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // range, geometry, material

std::multimap<Key, int> keys_of(const shared::Section& section,
                                std::span<const shared::Quad> quads) {
  std::multimap<Key, int> out;
  std::uint32_t range = 0;
  for (std::uint32_t i = 0; i < quads.size(); ++i) {
    while (i >= section.range_end[range]) ++range;
    out.emplace(Key{range, quads[i].geometry, quads[i].material}, 0);
  }
  return out;
}

/// Whether some quads are in a list in the order in which they come.
bool is_in_order(std::span<const shared::Quad> some, std::span<const shared::Quad> all) {
  auto at = all.begin();
  return std::ranges::all_of(some, [&](const shared::Quad& quad) {
    at = std::find_if(at, all.end(), [&](const shared::Quad& other) {
      return other.geometry == quad.geometry && other.material == quad.material;
    });
    if (at == all.end()) return false;
    ++at;
    return true;
  });
}

TEST(SectionParts, TogetherHaveEveryQuadInItsRange) {
  shared::Section section{};
  section.origin = {64, -128, 192};
  section.island = 5;
  const std::vector<shared::Quad> quads = random_quads(300, section);
  std::multimap<Key, int> together;
  std::size_t parts = 0;
  std::vector<shared::Quad> sorted;
  for (const SectionPart& part : parts_of(section, quads, sorted)) {
    ++parts;
    EXPECT_EQ(part.section.origin, section.origin);
    EXPECT_EQ(part.section.island, 5u);
    ASSERT_EQ(part.section.range_end[shared::kRangeCount - 1], part.quads.size());
    together.merge(keys_of(part.section, part.quads));
    EXPECT_TRUE(is_in_order(part.quads, quads));
    const VoxelBox box = box_of(part.quads);
    EXPECT_EQ(part.section.bounds_min, box.low);
    EXPECT_EQ(part.section.bounds_max, box.high);
    const auto cell = [](const shared::Quad& q) {
      return std::tuple{(q.geometry & 63) / 16, (q.geometry >> 6 & 63) / 16,
                        (q.geometry >> 12 & 63) / 16};
    };
    for (const shared::Quad& quad : part.quads) EXPECT_EQ(cell(quad), cell(part.quads.front()));
  }
  EXPECT_EQ(parts, 64u);
  EXPECT_EQ(together, keys_of(section, quads));
}

TEST(SectionParts, ASmallMeshStaysWhole) {
  shared::Section section{};
  section.bounds_max = 64;
  const std::vector<shared::Quad> quads = random_quads(3, section);
  std::vector<shared::Quad> sorted;
  const std::vector<SectionPart> parts = parts_of(section, quads, sorted);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].section.bounds_max, 64u);
  EXPECT_EQ(keys_of(parts[0].section, parts[0].quads), keys_of(section, quads));
}

// A plant stands from corner to corner of its voxel.
TEST(SectionParts, ABoxHoldsPlants) {
  const shared::Quad plant{3u | 9u << 6 | 20u << 12, 6u << shared::kFaceShift};
  const VoxelBox box = box_of(std::span(&plant, 1));
  EXPECT_EQ(box.low, 3u | 9u << 7 | 20u << 14);
  EXPECT_EQ(box.high, 4u | 10u << 7 | 21u << 14);
}

}  // namespace
}  // namespace skerry::render
