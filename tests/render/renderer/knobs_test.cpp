// Knobs for measuring: each goes to a limit that is known, and its default is what is drawn today.
#include "tests/render/high_roof.h"

#include <algorithm>
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{160, 100};

/// A long wall, 4 blocks thick and high, on a plane of stone.
world::BlockId long_wall(int x, int y, int) {
  return y < 0 || (y < 4 && x >= 0 && x < 4) ? world::block::kStone : world::block::kAirBlock;
}

class Knobs : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  std::vector<std::uint8_t> pixels(const FrameInput& input, const RenderSettings& settings) {
    drawn(input, settings, kSize);
    return picture();
  }
  std::uint64_t bytes_of(const std::string& name) {
    for (const gpu::MemoryUse& use : device().memory_use())
      if (use.name == name) return use.bytes;
    return 0;
  }
  /// Root of the mean squared difference of all channels, 0..255.
  static double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
  }
};

// Across a straight edge the sun's share is that of its disc cut by a line, and the penumbra is as
// wide as the edge is far. From 8 taps on it is wide enough here for 32 of them.
TEST_F(Knobs, MoreShadowTapsComeNearerToTheSunsDisc) {
  add(high_roof, {-1, -1, -1}, {1, 1, 1});
  FrameInput input;
  input.islands = islands_;
  input.sky = sun_at(60.0, 90.0);
  const double edge = -60.0 / std::tan(M_PI / 3.0);  // of the shadow, x
  const double radius = 0.00465 * 60.0 / std::sin(M_PI / 3.0);
  input.camera = camera_at({edge, 2.5, -2.0}, 0.0, -70.0, 50.0);
  RenderSettings settings;
  settings.debug_view = DebugView::kShadow;
  input.reach_blocks = 200.0;
  settings.shadow_blur = 0.5f;
  const glm::dvec3 eye = blocks_at(input.camera.position);
  double last = 1.0;
  for (const int taps : {1, 4, 8, 16, 32}) {
    settings.shadow_taps = taps;
    const int taken = taps < 8 ? taps : 32;
    const std::vector<std::uint8_t> picture = pixels(input, settings);
    double squares = 0.0;
    int partly = 0;
    for (std::uint32_t i = 0; i < kSize.width * kSize.height; ++i) {
      const glm::dvec3 ray =
          ray_of(input.camera, i % kSize.width, i / kSize.width, kSize.width, kSize.height);
      const double x = eye.x - ray.x * eye.y / ray.y;
      const double share = picture[i * 4] / 255.0;
      EXPECT_NEAR(share * taken, std::round(share * taken), 0.1);
      const double expected = share_of_disc((edge - x) * std::sin(M_PI / 3.0) / radius);
      partly += expected > 0.0 && expected < 1.0 ? 1 : 0;
      squares += (share - expected) * (share - expected);
    }
    ASSERT_GT(partly, 1000);
    const double error = std::sqrt(squares / partly);
    if (taps > 8)
      EXPECT_EQ(error, last) << taps << " taps";
    else
      EXPECT_LT(error, 0.9 * last) << taps << " taps";
    last = error;
  }
  EXPECT_LT(last, 0.03) << "0.066 by 8 taps alone, 0.040 by 16";
}

TEST_F(Knobs, EveryNumberOfShadowCascadesCoversTheView) {
  add(long_wall, {-1, -1, -1}, {1, 1, 1});
  FrameInput input;
  input.islands = islands_;
  input.sky = sun_at(60.0, 90.0);
  input.camera = camera_at({-40.0, 30.0, -20.0}, 20.0, -45.0, 60.0);
  RenderSettings settings;
  input.reach_blocks = 120.0;
  const std::vector<std::uint8_t> four = pixels(input, settings);
  const std::uint64_t bytes = bytes_of("shadow maps");
  for (int count = 1; count <= 4; ++count) {
    settings.shadow_cascades = count;
    const std::vector<std::uint8_t> now = pixels(input, settings);
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(has_pass("draw_shadow_sun_" + std::to_string(i)), i < count) << count;
    renderer().finish();
    device().collect();
    EXPECT_EQ(bytes_of("shadow maps") * 4, bytes * static_cast<std::uint64_t>(count));
    // Texels of at most 0.14 blocks: only edges may move.
    EXPECT_LT(difference(now, four), count == 4 ? 1e-9 : 6.0) << count;
  }
}

TEST_F(Knobs, ASealedRoomIsBlackWithEveryNumberOfCascades) {
  add(
      [](int x, int y, int z) -> world::BlockId {
        const int least = std::min({x, y, z}), most = std::max({x, y, z});
        const bool outer = least >= 19 && most < 31, inner = least >= 20 && most < 30;
        return outer && !inner ? world::block::kStone : world::block::kAirBlock;
      },
      {0, 0, 0}, {1, 1, 1});
  FrameInput input;
  input.islands = islands_;
  RenderSettings settings;
  input.reach_blocks = 200.0;
  for (int count = 1; count <= 4; ++count) {
    settings.shadow_cascades = count;
    for (const double altitude : {60.0, 20.0}) {
      input.sky = sun_at(altitude, 130.0);
      for (const double pitch : {0.0, -60.0, 60.0}) {
        input.camera = camera_at({25.3, 24.1, 26.2}, 100.0, pitch, 90.0);
        EXPECT_EQ(drawn(input, settings, kSize).pixels.black, kSize.width * kSize.height)
            << count << " cascades, sun at " << altitude << ", pitch " << pitch;
      }
    }
    input.camera = camera_at({25.3, 50.0, 26.2}, 0.0, -89.0, 20.0);
    EXPECT_EQ(drawn(input, settings, kSize).pixels.black, 0u) << "the same walls from outside";
  }
}

TEST_F(Knobs, MoreTextureTapsComeNearerToTheLimit) {
  add([](int, int y, int) -> world::BlockId { return y < 0 ? world::block::kGrass : 0; },
      {-2, -1, -2}, {2, 0, 2});
  FrameInput input;
  input.islands = islands_;
  input.sky = sun_at(60.0, 90.0);
  input.camera = camera_at({0.3, 1.7, 0.4}, 33.0, -8.0);
  RenderSettings settings;
  settings.debug_view = DebugView::kNone;
  settings.texture_taps = 16;
  const std::vector<std::uint8_t> limit = pixels(input, settings);
  double last = 255.0;
  for (const int taps : {1, 2, 4, 8}) {
    settings.texture_taps = taps;
    const double error = difference(pixels(input, settings), limit);
    EXPECT_LT(error, last) << taps << " taps";
    last = error;
  }
}

}  // namespace
}  // namespace skerry::render
