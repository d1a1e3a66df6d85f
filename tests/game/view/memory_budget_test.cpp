// A world that is larger than the memory for it is shown with less, and play goes on.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/gpu/device/device.h"
#include "engine/gpu/transfer/readback.h"
#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{64, 36};
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

class SceneMemory : public gpu::GpuTest {
 protected:
  std::unique_ptr<SceneView> view(std::optional<std::uint32_t> budget_mib) {
    SceneOptions options;
    options.seed_text = "1";
    options.settings.view_distance = 1100;
    options.settings.view_detail = 1100;
    options.settings.render.shadow_size = 256;
    options.settings.render.indirect = render::Indirect::kOff;  // it has a limit of its own
    options.settings.memory_budget_mib = budget_mib;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    return made ? *std::move(made) : nullptr;
  }
  /// Of the world's tables on the device.
  std::uint64_t table_bytes() {
    std::uint64_t bytes = 0;
    for (const gpu::MemoryUse& use : device().memory_use())
      for (const char* name : {"quad arena", "section table", "occupancy grids", "occupancy tables",
                               "occupancy bricks"})
        if (use.name == name) bytes += use.bytes;
    return bytes;
  }
  /// One frame of a flight; false: it failed.
  static testing::AssertionResult frame(SceneView& view, const SceneView::Moment& moment) {
    if (const Result<void> done = view.stream(moment.camera, moment.world_time_s); !done)
      return testing::AssertionFailure() << done.error().message;
    if (const auto drawn = view.draw(moment, kSize); !drawn)
      return testing::AssertionFailure() << drawn.error().message;
    return testing::AssertionSuccess();
  }
  static bool settle(SceneView& view, const SceneView::Moment& moment) {
    for (int i = 0; i < 20000; ++i) {
      if (!frame(view, moment)) return false;
      if (view.complete()) return true;
    }
    return false;
  }
};

TEST_F(SceneMemory, AFlightThroughMoreThanItHoldsGoesOn) {
  SceneView::Moment moment;
  {
    const auto roomy = view(std::nullopt);
    moment.camera = roomy->start_camera();
    ASSERT_TRUE(settle(*roomy, moment));
    EXPECT_TRUE(roomy->notices().empty());
    ASSERT_GT(roomy->renderer().world_memory().used, 8 * kMiB) << "8 MiB would hold all of it";
  }
  const auto tight = view(8);
  bool told = false;
  for (int i = 0; i < 80; ++i) {
    moment.camera.position[0] += 30 * world::kUnitsPerBlock;
    ASSERT_TRUE(frame(*tight, moment)) << i;
    const render::Renderer::WorldMemory memory = tight->renderer().world_memory();
    ASSERT_LE(memory.used, memory.limit);
    ASSERT_LE(table_bytes(), 2 * 8 * kMiB) << "a table that has grown retires when frames are done";
    told |= !tight->notices().empty();
  }
  EXPECT_TRUE(settle(*tight, moment));
  EXPECT_TRUE(told);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(frame(*tight, moment));
  EXPECT_LE(table_bytes(), 8 * kMiB);
  EXPECT_GT(tight->renderer().geometry().quads_resident(), 10'000u);
}

TEST_F(SceneMemory, AStillOfMoreThanItHoldsIsTheSameEachTime) {
  std::vector<std::byte> first;
  for (int i = 0; i < 2; ++i) {
    const auto tight = view(8);
    SceneView::Moment moment;
    moment.camera = tight->start_camera();
    ASSERT_TRUE(tight->load_completely(moment.camera, 0.0));
    EXPECT_TRUE(tight->complete());
    EXPECT_FALSE(tight->notices().empty());
    ASSERT_TRUE(tight->draw(moment, kSize));
    tight->renderer().finish();
    const auto pixels = gpu::read_back(device(), tight->renderer().picture(), 4);
    ASSERT_TRUE(pixels);
    if (i == 0) first = *pixels;
    EXPECT_EQ(*pixels, first);
  }
}

TEST_F(SceneMemory, AFrameThatFindsNoMemoryTakesSomeFromTheWorld) {
  const auto shown = view(std::nullopt);
  SceneView::Moment moment;
  moment.camera = shown->start_camera();
  ASSERT_TRUE(settle(*shown, moment));
  const std::uint64_t before = shown->renderer().world_memory().used;
  // A larger picture, and not a byte for it.
  device().set_memory_budget(device().memory_total());
  const auto drawn = shown->draw(moment, {kSize.width * 4, kSize.height * 4});
  ASSERT_TRUE(drawn) << drawn.error().message;
  EXPECT_FALSE(shown->notices().empty());
  EXPECT_TRUE(settle(*shown, moment));
  EXPECT_GT(shown->renderer().geometry().quads_resident(), 10'000u) << "it was streamed in again";
  EXPECT_LT(shown->renderer().world_memory().used, before);
  device().set_memory_budget(UINT64_MAX);
}

}  // namespace
}  // namespace skerry::game
