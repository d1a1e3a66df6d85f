// A picture must not depend on what the process has drawn before.
#include "game/view/scene_cache.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "engine/gpu/transfer/readback.h"
#include "game/view/scene_view.h"
#include "tests/game/view/roof.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{160, 90};

class SceneCacheFrames : public gpu::GpuTest {
 protected:
  using Picture = std::vector<std::byte>;

  /// A seed's spawn at noon.
  static SceneOptions scene(const char* seed) {
    SceneOptions options;
    options.seed_text = seed;
    options.settings.view_distance = 160;
    options.settings.view_detail = 96;
    options.settings.exposure_ev = 12.0;
    return options;
  }
  std::unique_ptr<SceneView> open(const SceneOptions& options, SceneCache* cache) {
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options, cache);
    EXPECT_TRUE(made) << made.error().message;
    return *std::move(made);
  }
  static Picture draw(gpu::Device& device, SceneView& view) {
    SceneView::Moment moment;
    moment.camera = view.start_camera();
    EXPECT_TRUE(view.load_completely(moment));
    EXPECT_TRUE(view.draw(moment, kSize));
    view.renderer().finish();
    auto picture = gpu::read_back(device, view.renderer().picture(), 4);
    EXPECT_TRUE(picture);
    return *std::move(picture);
  }
  Picture draw(const SceneOptions& options, SceneCache* cache) {
    return draw(device(), *open(options, cache));
  }
  /// Puts a roof over the camera, which takes most of the sky from the ground about it.
  static void add_roof(SceneView& view) { test::put_roof(view, 3, -8, 8, world::block::kStone); }
};

TEST_F(SceneCacheFrames, PicturesAreThoseOfAViewThatSharesNothing) {
  const SceneOptions first = scene("1"), second = scene("4");
  SceneOptions turned = first;  // the same islands, seen otherwise
  turned.settings.render.indirect = render::Indirect::kSky;
  const Picture first_alone = draw(first, nullptr), second_alone = draw(second, nullptr),
                turned_alone = draw(turned, nullptr);
  ASSERT_FALSE(first_alone == second_alone);
  ASSERT_FALSE(first_alone == turned_alone);

  SceneCache cache(device());
  EXPECT_TRUE(draw(first, &cache) == first_alone);
  EXPECT_EQ(cache.light->stats().found, 0u);
  const std::size_t of_first = cache.light->stats().missed;
  ASSERT_GT(of_first, 0u);
  EXPECT_TRUE(draw(second, &cache) == second_alone);
  EXPECT_TRUE(draw(turned, &cache) == turned_alone);
  const world::LightCache::Stats before = cache.light->stats();
  EXPECT_TRUE(draw(first, &cache) == first_alone);
  EXPECT_EQ(cache.light->stats().missed, before.missed);
  EXPECT_EQ(cache.light->stats().found, before.found + of_first);
}

TEST_F(SceneCacheFrames, AnEditIsSeen) {
  Picture roofed_alone, open_alone;
  {
    const auto view = open(scene("1"), nullptr);
    open_alone = draw(device(), *view);
    add_roof(*view);
    roofed_alone = draw(device(), *view);
  }
  ASSERT_FALSE(open_alone == roofed_alone);

  SceneCache cache(device());
  {
    const auto view = open(scene("1"), &cache);
    EXPECT_TRUE(draw(device(), *view) == open_alone);
    const std::size_t missed = cache.light->stats().missed;
    add_roof(*view);
    EXPECT_TRUE(draw(device(), *view) == roofed_alone);
    EXPECT_GT(cache.light->stats().missed, missed);
  }
  EXPECT_TRUE(draw(scene("1"), &cache) == open_alone);
}

TEST_F(SceneCacheFrames, ASecondViewOfASceneMakesNoProgram) {
  SceneCache cache(device());
  draw(scene("1"), &cache);
  const int used = cache.pipelines.used();
  ASSERT_GT(used, 0);
  const auto view = open(scene("1"), &cache);
  draw(device(), *view);
  EXPECT_EQ(cache.pipelines.used(), used);
  EXPECT_EQ(view->renderer().report()->programs_made, 0);
}

}  // namespace
}  // namespace skerry::game
