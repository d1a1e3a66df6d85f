#include "engine/render/plan/in_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/render/random_scenes.h"
#include "world/mesh/mesh.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{640, 360};

/// @param range the first of those that the section has a quad in, alone.
shared::Section random_section(RandomPlaces& random, std::uint32_t islands, std::uint32_t range) {
  shared::Section s{};
  s.voxel_size_log2 = static_cast<std::uint32_t>(random.whole(0, 3));
  const std::int64_t edge = 64 << s.voxel_size_log2;
  for (int axis = 0; axis < 3; ++axis)
    s.origin[axis] = static_cast<int>(random.whole(-4, 3) * edge);
  s.island = static_cast<std::uint32_t>(random.whole(0, islands - 1));
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<std::uint32_t>(random.whole(0, 64));
    const auto high = static_cast<std::uint32_t>(random.whole(low, 64));
    s.bounds_min |= low << (7 * axis);
    s.bounds_max |= high << (7 * axis);
  }
  for (std::uint32_t r = range; r < shared::kRangeCount; ++r) s.range_end[r] = 1;
  return s;
}

/// A camera before two islands, one of whose sections counts among others that do not.
struct RandomView {
  RandomView(RandomPlaces& random, std::uint32_t range)
      : islands{{fixed_at(random.in_box(400.0)), random.turn(), 500.0},
                {fixed_at(random.in_box(400.0)), random.turn(), 500.0}} {
    input.camera.position = fixed_at(random.in_box(200.0));
    input.camera.yaw_deg = random.uniform(0.0, 360.0);
    input.camera.pitch_deg = random.uniform(-89.0, 89.0);
    input.camera.fov_deg = random.uniform(20.0, 110.0);
    input.islands = islands;
    tables = build_tables(input, {}, kSize, {});
    sections = {random_section(random, 2, 0), {}, random_section(random, 2, range)};
    for (const shared::Section& s : sections) boxes.push_back({s.bounds_min, s.bounds_max});
  }
  Box box() const {
    return box_of(sections[2], islands[sections[2].island], input.camera.position);
  }
  bool truly_in_view() const {
    return box_meets(box(), frustum_of(input.camera, kSize.width, kSize.height));
  }
  SceneFacts facts() const {
    SceneFacts out;
    out.sections = sections;
    out.translucent_boxes = boxes;
    return out;
  }

  std::vector<IslandPlacement> islands;
  FrameInput input;
  FrameTables tables;
  std::vector<shared::Section> sections;
  std::vector<VoxelBox> boxes;
};

/// Asks for every random view. @param answer whether the section is in it.
template <class Answer>
void expect_agreement(std::uint32_t range, Answer answer) {
  RandomPlaces random(8);
  int visible = 0, needless = 0;
  constexpr int kRounds = 4000;
  for (int i = 0; i < kRounds; ++i) {
    RandomView view(random, range);
    const bool told = answer(view);
    if (view.truly_in_view()) {
      EXPECT_TRUE(told) << "lost a section that can be seen, round " << i;
      ++visible;
    } else if (told) {
      ++needless;
    }
    view.sections[2] = {};
    EXPECT_FALSE(answer(view));
  }
  EXPECT_GT(visible, kRounds / 20);
  // Boxes near two planes' meeting line pass the plane tests without touching the frustum.
  EXPECT_LT(needless, kRounds / 25);
}

TEST(CutoutsInView, AgreeWithClippingEveryBox) {
  for (const std::uint32_t range : {shared::kRangeCutout, shared::kRangePlant})
    expect_agreement(range, [](const RandomView& view) {
      return cutouts_in_view(view.sections, view.tables.islands, view.tables.views[0]);
    });
}

TEST(IslandsInView, HoldEveryIslandOfASectionInView) {
  RandomPlaces random(11);
  int visible = 0, passed_over = 0;
  for (int i = 0; i < 4000; ++i) {
    RandomView view(random, 0);
    for (IslandPlacement& island : view.islands) {
      island.bounding_radius = 0.0;
      for (const shared::Section& s : view.sections)
        for (const glm::dvec3& corner : box_of(s, {.origin = {}, .rotation = {1, 0, 0, 0}}, {}))
          island.bounding_radius = std::max(island.bounding_radius, glm::length(corner));
    }
    const auto answer = [&] {
      return islands_in_view(view.facts(), view.islands, view.tables.views[0],
                             view.input.camera.position);
    };
    const std::vector<bool> shown = answer();
    if (view.truly_in_view()) {
      EXPECT_TRUE(shown[view.sections[2].island]) << "round " << i;
      ++visible;
    }
    passed_over += static_cast<int>(std::count(shown.begin(), shown.end(), false));
    for (shared::Section& s : view.sections) s = {};
    EXPECT_EQ(answer(), std::vector<bool>(2, false)) << "an island without a section shows nothing";
  }
  EXPECT_GT(visible, 200);
  EXPECT_GT(passed_over, 200);
}

TEST(TranslucentArea, IsThereWhereClippingLeavesAnyBox) {
  expect_agreement(shared::kRangeTranslucent, [](const RandomView& view) {
    return translucent_area(view.facts(), view.tables).has_value();
  });
}

/// Points that lie evenly on a box's faces.
std::vector<glm::dvec3> points_of(const Box& box) {
  constexpr int kAlong = 24;
  std::vector<glm::dvec3> points;
  const glm::dvec3 x = box[1] - box[0], y = box[2] - box[0], z = box[4] - box[0];
  for (int i = 0; i <= kAlong; ++i)
    for (int j = 0; j <= kAlong; ++j)
      for (const double end : {0.0, 1.0}) {
        const double a = static_cast<double>(i) / kAlong, b = static_cast<double>(j) / kAlong;
        points.push_back(box[0] + a * x + b * y + end * z);
        points.push_back(box[0] + a * x + end * y + b * z);
        points.push_back(box[0] + end * x + a * y + b * z);
      }
  return points;
}

TEST(TranslucentArea, HoldsEveryPixelThatABoxCoversAndHardlyMore) {
  RandomPlaces random(9);
  double needed = 0.0, told = 0.0;
  int clipped = 0;
  for (int i = 0; i < 4000; ++i) {
    RandomView view(random, shared::kRangeTranslucent);
    const auto area = translucent_area(view.facts(), view.tables);
    if (!area) continue;
    ASSERT_TRUE(area->x < area->z && area->y < area->w && area->z <= kSize.width &&
                area->w <= kSize.height);
    const CameraView camera = view_of(view.input.camera, kSize.width, kSize.height);
    glm::dvec2 low(1e9), high(-1e9);
    for (const glm::dvec3& p : points_of(view.box())) {
      const double along = glm::dot(p, glm::dvec3(camera.forward));
      if (along < static_cast<double>(kNearPlane)) {
        ++clipped;
        continue;
      }
      const glm::dvec2 at(
          (0.5 + 0.5 * glm::dot(p, glm::dvec3(camera.right)) / (along * camera.tan_half_x)) *
              kSize.width,
          (0.5 - 0.5 * glm::dot(p, glm::dvec3(camera.up)) / (along * camera.tan_half_y)) *
              kSize.height);
      low = glm::min(low, at);
      high = glm::max(high, at);
      if (at.x < 0.0 || at.y < 0.0 || at.x > kSize.width || at.y > kSize.height) continue;
      ASSERT_TRUE(at.x >= area->x && at.x <= area->z && at.y >= area->y && at.y <= area->w)
          << "round " << i << ": (" << at.x << ", " << at.y << ")";
    }
    low = glm::max(low, glm::dvec2(0.0));
    high = glm::min(high, glm::dvec2(kSize.width, kSize.height));
    if (low.x < high.x && low.y < high.y)
      needed += (high.x - low.x + 8.0) * (high.y - low.y + 8.0),
          told += static_cast<double>(area->z - area->x) * (area->w - area->y);
  }
  EXPECT_GT(clipped, 1000) << "boxes about the eye are asked for, too";
  // Points on faces leave out what lies just before the eye.
  EXPECT_LT(told, 1.1 * needed);
}

TEST(VoxelBox, IsTheBoxOfWhatIsMeshed) {
  RandomPlaces random(10);
  for (int i = 0; i < 200; ++i) {
    std::vector<world::BlockId> voxels(world::kPaddedVoxels, world::kAir);
    const auto blocks = random.whole(1, 6);
    for (std::int64_t b = 0; b < blocks; ++b) {
      const auto along = [&] { return static_cast<std::size_t>(random.whole(1, 64)); };
      const std::size_t x = along(), y = along(), z = along();
      voxels[z + 66 * (x + 66 * y)] =
          random.whole(0, 1) == 0 ? world::block::kGlass : world::block::kWater;
    }
    world::MeshScratch scratch;
    world::ChunkMesh mesh;
    world::mesh_chunk(voxels, scratch, mesh);
    const VoxelBox box = box_of(mesh.quads);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(box.low_corner()[axis], mesh.bounds_min[static_cast<std::size_t>(axis)]);
      EXPECT_EQ(box.high_corner()[axis], mesh.bounds_max[static_cast<std::size_t>(axis)]);
    }
  }
}

}  // namespace
}  // namespace skerry::render
