// The outline and the cracks of a picked block in whole pictures.
#include <algorithm>

#include "engine/render/surface/marker_pass.h"
#include "tests/render/renderer_on_gpu.h"
#include "tests/same_bits.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{160, 120};

world::BlockId ground_and_pillar(int x, int y, int z) {
  const bool pillar = x == 8 && z == 8 && y < 3;
  return y < 0 || pillar ? world::block::kStone : world::block::kAirBlock;
}

class MarkerTest : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input() const {
    FrameInput in;
    in.islands = islands_;
    in.sky = celestial_at(12.0 * 3600.0, 0.0);
    in.camera = camera_at({8.5, 2.0, 4.0}, 0.0, -20.0);  // looks at the pillar's foot
    return in;
  }
  std::vector<std::uint8_t> picture_of(const FrameInput& in, const RenderSettings& settings = {}) {
    drawn(in, settings, kSize);
    return picture();
  }
  /// Pixels that differ, as a box and a count.
  struct Difference {
    int count = 0, low_x = 1 << 20, high_x = -1, low_y = 1 << 20, high_y = -1;
  };
  static Difference difference(const std::vector<std::uint8_t>& a,
                               const std::vector<std::uint8_t>& b) {
    Difference found;
    for (std::size_t i = 0; i < a.size(); i += 4) {
      if (std::equal(a.begin() + static_cast<long>(i), a.begin() + static_cast<long>(i) + 4,
                     b.begin() + static_cast<long>(i)))
        continue;
      const int x = static_cast<int>(i / 4 % kSize.width),
                y = static_cast<int>(i / 4 / kSize.width);
      ++found.count;
      found.low_x = std::min(found.low_x, x), found.high_x = std::max(found.high_x, x);
      found.low_y = std::min(found.low_y, y), found.high_y = std::max(found.high_y, y);
    }
    return found;
  }
  static BlockMarker block_at(int x, int y, int z, float dug = 0.0f) {
    return {0, glm::dvec3(x, y, z), glm::dvec3(x + 1, y + 1, z + 1), dug};
  }
};

TEST_F(MarkerTest, NothingPickedCostsNoPassAndNoPixel) {
  add(ground_and_pillar, {0, -1, 0}, {1, 1, 1});
  drawn(input(), {}, kSize);
  EXPECT_FALSE(has_pass("marker"));
  FrameInput behind = input();
  behind.marker = block_at(8, 1, -5);  // behind the eye's back
  behind.camera.pitch_deg = 0.0;
  drawn(behind, {}, kSize);
  FrameInput aside = input();
  aside.marker = block_at(60, 1, 8);
  drawn(aside, {}, kSize);
  EXPECT_FALSE(has_pass("marker"));
}

TEST_F(MarkerTest, TheOutlineGoesAroundTheBlockAndNowhereElse) {
  add(ground_and_pillar, {0, -1, 0}, {1, 1, 1});
  const auto plain = picture_of(input());
  FrameInput in = input();
  in.marker = block_at(8, 1, 8);
  const auto marked = picture_of(in);
  EXPECT_TRUE(has_pass("draw_marker"));
  const Difference lines = difference(plain, marked);
  // The front face, four blocks away, is 1/4 block a block deep: its half edge of 0.5 / 4 over the
  // tangent of the half field of view is 0.5 / 4 / 0.7002 * 60 = 10.7 pixels; lines and rims add
  // up to 3.
  EXPECT_GT(lines.count, 60);
  EXPECT_NEAR(lines.high_x - lines.low_x, 21.4 + 4.0, 5.0);
  EXPECT_LT(lines.high_y - lines.low_y, 36);
  // The middle of the face is as it was.
  const std::size_t middle =
      4 * (static_cast<std::size_t>((lines.low_y + lines.high_y) / 2) * kSize.width +
           static_cast<std::size_t>((lines.low_x + lines.high_x) / 2));
  EXPECT_EQ(plain[middle], marked[middle]);
}

TEST_F(MarkerTest, WhatIsNearerHidesTheOutline) {
  add(ground_and_pillar, {0, -1, 0}, {1, 1, 1});
  const auto plain = picture_of(input());
  FrameInput in = input();
  in.marker = block_at(8, 0, 12);  // behind the pillar, in the air
  const Difference seen = difference(plain, picture_of(in));
  in.marker = block_at(8, -3, 8);  // under the ground
  EXPECT_EQ(difference(plain, picture_of(in)).count, 0);
  in.marker = block_at(8, 0, 12);
  in.camera.position[0] += 4 * 65536;  // from beside the pillar all of it is in view
  FrameInput beside = in;
  beside.marker.reset();
  const Difference free = difference(picture_of(beside), picture_of(in));
  EXPECT_LT(seen.count, free.count);
}

TEST_F(MarkerTest, CracksGrowWithDiggingAndStayOnTheBlock) {
  add(ground_and_pillar, {0, -1, 0}, {1, 1, 1});
  FrameInput in = input();
  in.marker = block_at(8, 1, 8);
  const auto outlined = picture_of(in);
  const Difference box = difference(picture_of(input()), outlined);
  int before = 0;
  for (const float dug : {0.1f, 0.4f, 0.7f, 1.0f}) {
    in.marker->dug = dug;
    const Difference cracks = difference(outlined, picture_of(in));
    EXPECT_GT(cracks.count, before) << dug;
    EXPECT_GE(cracks.low_x, box.low_x);
    EXPECT_LE(cracks.high_x, box.high_x);
    EXPECT_GE(cracks.low_y, box.low_y);
    EXPECT_LE(cracks.high_y, box.high_y);
    before = cracks.count;
  }
}

TEST_F(MarkerTest, EveryWayToAPictureHasItAndTwiceTheSame) {
  add(ground_and_pillar, {0, -1, 0}, {1, 1, 1});
  RenderSettings plain, bloom, samples;
  bloom.bloom.intensity = 0.2f;
  samples.aa_samples = 4;
  for (const RenderSettings& settings : {plain, bloom, samples}) {
    FrameInput in = input();
    const auto without = picture_of(in, settings);
    in.marker = block_at(8, 1, 8, 0.5f);
    const auto with = picture_of(in, settings);
    EXPECT_GT(difference(without, with).count, 60);
    EXPECT_EQ(with, picture_of(in, settings));
  }
  RenderSettings debug;
  debug.debug_view = DebugView::kNormal;
  FrameInput in = input();
  in.marker = block_at(8, 1, 8);
  drawn(in, debug, kSize);
  EXPECT_FALSE(has_pass("marker"));
}

TEST(MarkerConstants, FitBesideTheEyeAndOnEitherSideOfTheWorld) {
  // The same block seen from the same place, at the world's middle and at its edge, on an island
  // that is turned: the same numbers to the bit.
  const auto at = [](std::int64_t offset) {
    const IslandPlacement island{{offset + 700, offset - 300, offset},
                                 glm::angleAxis(0.7, glm::dvec3(0.0, 1.0, 0.0)),
                                 100.0};
    Camera camera;
    camera.position = {offset + 2 * 65536, offset + 65536, offset - 65536};
    camera.yaw_deg = 20.0;
    return marker_constants({0, {1.0, 0.0, 1.0}, {2.0, 1.0, 2.0}, 0.25f}, island, camera, kSize);
  };
  const auto middle = at(0), edge = at(std::int64_t{1} << 55);
  ASSERT_TRUE(middle && edge);
  EXPECT_TRUE(same_bits(*middle, *edge));
  EXPECT_LE(sizeof(shared::MarkerConstants), 128u);  // push constants
}

}  // namespace
}  // namespace skerry::render
