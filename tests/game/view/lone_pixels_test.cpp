// Where faces meet, rasterisers round and quads overlap a little. No pixel may stand out by that.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/gpu/transfer/readback.h"
#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"
#include "tests/render/random_scenes.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{640, 360};

/// Pixels of less than half the brightness of each of their eight neighbours.
int lone_pixels(const std::vector<std::byte>& picture) {
  const auto brightness = [&](std::uint32_t x, std::uint32_t y) {
    const std::size_t at = (std::size_t{y} * kSize.width + x) * 4;
    int sum = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      sum += std::to_integer<int>(picture[at + channel]);
    return sum;
  };
  int count = 0;
  for (std::uint32_t y = 1; y + 1 < kSize.height; ++y)
    for (std::uint32_t x = 1; x + 1 < kSize.width; ++x) {
      int least = 3 * 255;
      for (std::uint32_t i = 0; i < 9; ++i)
        if (i != 4) least = std::min(least, brightness(x + i % 3 - 1, y + i / 3 - 1));
      count += least > 40 && 2 * brightness(x, y) < least;
    }
  return count;
}

class LonePixels : public gpu::GpuTest {
 protected:
  LonePixels() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  /// Of views over a rocky lake in the shade.
  int count(std::uint32_t layers) {
    SceneOptions options;
    options.seed_text = "5";
    options.settings.view_distance = 100;
    options.settings.exposure_ev = -4.4;
    options.settings.render.water_layers = layers;
    options.settings.render.leave_out.add(render::Feature::kCutouts);  // leaves are of lone pixels
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    SceneView& view = **made;
    SceneView::Moment moment;
    moment.time_of_day_s = 16.5 * 3600.0;
    const render::FixedPos middle = render::fixed_at({40.5, 14.3, 40.5});
    moment.camera.position = middle;
    EXPECT_TRUE(view.load_completely(moment));
    render::RandomPlaces random(1);
    int found = 0;
    for (int i = 0; i < 5; ++i) {
      moment.camera.position = render::sum(middle, render::fixed_at(random.in_box(0.7)));
      moment.camera.yaw_deg = random.uniform(170.0, 260.0);
      moment.camera.pitch_deg = random.uniform(-50.0, -15.0);
      EXPECT_TRUE(view.draw(moment, kSize));
      view.renderer().finish();
      const auto picture = gpu::read_back(device(), view.renderer().picture(), 4);
      EXPECT_TRUE(picture);
      found += lone_pixels(*picture);
    }
    return found;
  }
};

TEST_F(LonePixels, ThereAreNoneWhereFacesMeet) {
  EXPECT_EQ(count(1), 0);
  EXPECT_EQ(count(4), 0);
}

}  // namespace
}  // namespace skerry::game
