// What a frame copies out, and that a broken texel stays where it is.
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{64, 48};
constexpr double kNoon = 12.0 * 3600.0;

world::BlockId ground(int, int y, int) {
  return y < 0 ? world::block::kGrass : world::block::kAirBlock;
}

class CaptureTest : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input() const {
    FrameInput in;
    in.islands = islands_;
    in.sky = celestial_at(kNoon, 0.0);
    in.camera = camera_at({15.0, 8.0, -3.0}, 0.0, -30.0);
    in.capture = true;
    return in;
  }
  template <class T>
  std::vector<T> texels(Capture what) {
    const Captured got = renderer().captured(what);
    std::vector<T> out(got.texels.size() / sizeof(T));
    std::memcpy(out.data(), got.texels.data(), out.size() * sizeof(T));
    return out;
  }
};

TEST_F(CaptureTest, DepthIsThatOfThePlaneBelow) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  FrameInput in = input();
  in.camera = camera_at({30.0, 8.0, 30.0}, 0.0, -90.0);  // straight down on y = 0
  drawn(in, {}, kSize);
  const std::vector<float> depths = texels<float>(Capture::kDepth);
  const std::vector<std::uint32_t> words = texels<std::uint32_t>(Capture::kSurfaces);
  ASSERT_EQ(depths.size(), 64u * 48u);
  ASSERT_EQ(words.size(), depths.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    EXPECT_NEAR(kNearPlane / depths[i], 8.0, 8.0 * 1e-6);
    EXPECT_EQ(shared::surface_block(words[i]), static_cast<std::uint32_t>(world::block::kGrass));
  }
  EXPECT_EQ(renderer().captured(Capture::kShadowMaps).layers, 4u);
}

TEST_F(CaptureTest, TheSkyHasNoWordOfTheFrameBefore) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  FrameInput in = input();
  in.capture = false;
  in.camera = camera_at({30.0, 8.0, 30.0}, 0.0, -90.0);  // words everywhere
  for (int frame = 0; frame < 4; ++frame) drawn(in, {}, kSize);
  in.capture = true;
  in.camera = camera_at({30.0, 8.0, -3.0}, 0.0, 5.0);
  drawn(in, {}, kSize);
  const std::vector<float> depths = texels<float>(Capture::kDepth);
  const std::vector<std::uint32_t> words = texels<std::uint32_t>(Capture::kSurfaces);
  ASSERT_EQ(words.size(), depths.size());
  int sky = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    EXPECT_EQ(words[i] != 0, depths[i] > 0.0f) << i;
    sky += depths[i] == 0.0f ? 1 : 0;
  }
  EXPECT_GT(sky, 64 * 48 / 4);
  EXPECT_LT(sky, 64 * 48);
}

TEST_F(CaptureTest, WithoutGeometryThereIsRadianceOnly) {
  drawn(input(), {}, kSize);
  EXPECT_EQ(texels<std::uint64_t>(Capture::kRadiance).size(), 64u * 48u);
  EXPECT_EQ(renderer().captured(Capture::kDepth).layers, 0u);
  EXPECT_EQ(renderer().captured(Capture::kShadowMaps).layers, 0u);
}

TEST_F(CaptureTest, TheWayByRadianceDoesNotChangeThePicture) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(input(), {}, kSize);
  const std::vector<std::uint8_t> by_radiance = picture();
  FrameInput plain = input();
  plain.capture = false;
  drawn(plain, {}, kSize);
  EXPECT_FALSE(has_pass("develop"));
  const std::vector<std::uint8_t> direct = picture();
  EXPECT_EQ(by_radiance, direct);
}

TEST_F(CaptureTest, ABrokenTexelOfRadianceBreaksOnePixel) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(input(), {}, kSize);
  const std::vector<std::uint8_t> clean = picture();
  for (const float value : {std::numeric_limits<float>::infinity(), std::nanf("")}) {
    FrameInput broken = input();
    broken.fault = {Fault::In::kLookedThrough, {5, 7}, value};
    drawn(broken, {}, kSize);
    const auto radiance = texels<std::uint64_t>(Capture::kRadiance);
    EXPECT_FALSE(std::isfinite(glm::unpackHalf4x16(radiance[7 * 64 + 5]).x));
    const std::vector<std::uint8_t> damaged = picture();
    for (std::size_t i = 0; i < clean.size(); ++i) {
      if (i / 4 == 7 * 64 + 5) continue;
      EXPECT_EQ(damaged[i], clean[i]);
    }
    EXPECT_EQ(renderer().report()->pixels.non_finite, 1u);
  }
}

}  // namespace
}  // namespace skerry::render
