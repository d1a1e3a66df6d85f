// Which sections are left out because of what stands before them. A wall of its own island, and
// behind it or on both sides of it a section of another.
#include <cstring>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{128, 96};
constexpr std::uint32_t kWall = 0, kOther = 1;

class HiddenSections : public RendererOnGpu {
 protected:
  void SetUp() override {
    RendererOnGpu::SetUp();
    if (!HasFatalFailure()) add_wall();
  }
  void add_wall() {
    // 64 blocks wide and high, from z = 30 to 31.
    add([](int, int, int z) { return z == 30 ? world::block::kStone : world::block::kAirBlock; },
        {0, 0, 0}, {1, 1, 1}, kWall);
    islands_[kWall] = {fixed_at({-32.0, -32.0, 0.0}), {1.0, 0.0, 0.0, 0.0}, 60.0};
    settings_.occlusion = Occlusion::kAlways;
  }
  void put_blocks(std::initializer_list<glm::ivec3> blocks) {
    add(
        [&](int x, int y, int z) {
          const bool there = std::ranges::find(blocks, glm::ivec3(x, y, z)) != blocks.end();
          return there ? world::block::kBricks : world::block::kAirBlock;
        },
        {0, 0, 0}, {1, 1, 1}, kOther);
  }
  /// A frame that shows the wall alone, then one with the other island at its place.
  FrameReport shown_after_wall() {
    draw_with_other_at({0.0, 0.0, -5000.0});
    return draw_with_other_at({-32.0, -32.0, 0.0});
  }
  FrameReport draw_with_other_at(glm::dvec3 place) {
    islands_[kOther] = {fixed_at(place), {1.0, 0.0, 0.0, 0.0}, 60.0};
    FrameInput input;
    input.islands = islands_;
    input.sky = sun_at(40.0, 30.0);
    input.camera = camera_at({0.0, 0.0, -20.0}, 0.0, 0.0, 50.0);
    input.capture = true;
    return drawn(input, settings_, kSize);
  }
  std::size_t pixels_of(std::uint32_t island) {
    const Captured got = renderer().captured(Capture::kSurfaces);
    std::vector<std::uint32_t> words(got.texels.size() / 4);
    std::memcpy(words.data(), got.texels.data(), got.texels.size());
    return static_cast<std::size_t>(std::ranges::count_if(words, [&](std::uint32_t word) {
      return word != 0 && shared::surface_island(word) == island;
    }));
  }

  std::vector<IslandPlacement> islands_{2};
  RenderSettings settings_;
};

TEST_F(HiddenSections, AreNotDrawn) {
  put_blocks({{32, 32, 40}});
  const FrameReport report = shown_after_wall();
  EXPECT_LT(report.camera.quads, report.camera.quads_in_view);
  EXPECT_EQ(pixels_of(kOther), 0u);
}

// Its farthest corner is behind the wall, its nearest before it.
TEST_F(HiddenSections, AreDrawnWhenTheyReachBeforeTheWall) {
  put_blocks({{32, 32, 20}, {32, 32, 50}});
  const FrameReport report = shown_after_wall();
  EXPECT_EQ(report.camera.quads, report.camera.quads_in_view);
  EXPECT_GT(pixels_of(kOther), 4u);
}

// A row of blocks that ends beside the wall, by less than a square of the depths.
TEST_F(HiddenSections, AreDrawnWhenTheyReachBeyondItsEdge) {
  // The wall covers 64 blocks at a distance of 50; at 70 the same angle is 89.6.
  for (const int beyond : {0, 1, 2}) {
    restart();
    add_wall();
    add(
        [&](int x, int y, int z) {
          return y == 32 && z == 0 && x <= beyond ? world::block::kBricks : world::block::kAirBlock;
        },
        {0, 0, 0}, {1, 1, 1}, kOther);
    draw_with_other_at({0.0, 0.0, -5000.0});
    draw_with_other_at({44.0, -32.0, 50.0});
    const std::size_t got = pixels_of(kOther);
    settings_.occlusion = Occlusion::kOff;
    draw_with_other_at({44.0, -32.0, 50.0});
    EXPECT_EQ(got, pixels_of(kOther)) << beyond;
  }
}

// What the last frame showed is gone from view, and what it hid is not.
TEST_F(HiddenSections, AreDrawnByTheFirstFrameThatDoesNotHideThem) {
  put_blocks({{32, 32, 40}});
  shown_after_wall();
  islands_[kWall].origin = fixed_at({0.0, 0.0, -5000.0});
  draw_with_other_at({-32.0, -32.0, 0.0});
  EXPECT_GT(pixels_of(kOther), 2u);
}

TEST_F(HiddenSections, AreNotLookedForByDefaultWhereLittleIsInView) {
  settings_.occlusion = Occlusion::kAuto;
  shown_after_wall();
  EXPECT_FALSE(has_pass("cull_hidden"));
  settings_.occlusion = Occlusion::kAlways;
  shown_after_wall();
  EXPECT_TRUE(has_pass("cull_hidden"));
  settings_.gbuffer.depth = DepthStore::kD16;
  shown_after_wall();
  EXPECT_FALSE(has_pass("cull_hidden"));
}

}  // namespace
}  // namespace skerry::render
