// A world that is larger than the memory for it is shown with less, and play goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

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
  SceneMemory() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  std::unique_ptr<SceneView> view(std::optional<std::uint32_t> budget_mib,
                                  render::Indirect indirect = render::Indirect::kOff) {
    SceneOptions options;
    options.seed_text = "1";
    options.settings.view_distance = 1100;
    options.settings.view_detail = 1100;
    options.settings.render.shadow_size = 256;
    options.settings.render.indirect = indirect;
    options.settings.memory_budget_mib = budget_mib;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    return made ? *std::move(made) : nullptr;
  }
  /// Of the world's tables on the device.
  std::uint64_t table_bytes() {
    std::uint64_t bytes = 0;
    for (const char* name : {"quad arena", "section table", "occupancy grids", "occupancy tables",
                             "occupancy bricks", "light of the sky"})
      bytes += bytes_of(name);
    return bytes;
  }
  std::uint64_t bytes_of(std::string_view name) {
    std::uint64_t bytes = 0;
    for (const gpu::MemoryUse& use : device().memory_use())
      if (use.name == name) bytes += use.bytes;
    return bytes;
  }
  /// One frame of a flight; false: it failed.
  static testing::AssertionResult frame(SceneView& view, const SceneView::Moment& moment) {
    if (const Result<void> done = view.stream(moment, 1.0 / 60.0); !done)
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

/// An island within view distance.
struct Around {
  double blocks = 0.0;  ///< from the camera to its bounding sphere
  bool resident = false;
};
std::vector<Around> islands_around(SceneView& view, const SceneView::Moment& moment) {
  const world::WorldPos camera{moment.camera.position[0], moment.camera.position[1],
                               moment.camera.position[2]};
  std::vector<Around> out;
  for (const world::IslandSpec& spec :
       view.world().islands_near(camera, view.settings().view_distance, moment.world_time_s)) {
    const world::Pose pose = world::pose_at(spec, moment.world_time_s);
    out.push_back(
        {glm::length(world::difference_blocks(pose.origin, camera)) - spec.bounding_radius,
         view.streamer().settled(spec.id)});
  }
  return out;
}

/// Finest level of detail of each resident island, by its slot.
std::map<std::uint32_t, std::uint32_t> levels_of(const render::GeometryStore& geometry) {
  std::map<std::uint32_t, std::uint32_t> out;
  for (const shared::Section& record : geometry.records()) {
    if (record.range_end[shared::kRangeCount - 1] == 0) continue;
    const auto [entry, added] = out.emplace(record.island, record.voxel_size_log2);
    entry->second = std::min(entry->second, record.voxel_size_log2);
  }
  return out;
}

// Quads, occupancy and the light of the sky share 32 MiB in a flight over more than they hold.
TEST_F(SceneMemory, AFlightWith32MiBKeepsWhatIsNearInFullDetail) {
  if (!long_tests()) GTEST_SKIP() << "two minutes: tools/test --long";
  constexpr std::uint32_t kBudget = 32;
  const auto tight = view(kBudget, render::Indirect::kFull);
  SceneView::Moment moment;
  moment.camera = tight->start_camera();
  std::vector<std::string> said;
  const auto listen = [&] {
    for (std::string& line : tight->notices()) said.push_back(std::move(line));
  };
  for (int i = 0; i < 40; ++i) {
    moment.camera.position[0] += 60 * world::kUnitsPerBlock;
    ASSERT_TRUE(frame(*tight, moment)) << i;
    const render::Renderer::WorldMemory memory = tight->renderer().world_memory();
    ASSERT_EQ(memory.limit, kBudget * kMiB);
    ASSERT_LE(memory.used, memory.limit);
    ASSERT_LE(table_bytes(), 2 * kBudget * kMiB)
        << "a table that has grown retires when frames are done";
    listen();
  }
  ASSERT_TRUE(settle(*tight, moment));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(frame(*tight, moment));
  listen();
  EXPECT_LE(table_bytes(), kBudget * kMiB);
  EXPECT_GT(bytes_of("light of the sky"), 0u);
  EXPECT_GT(bytes_of("occupancy bricks"), 0u);
  // The player has been told how far there is full detail: less than was asked for.
  double view_blocks = 0.0, detail_blocks = 0.0;
  for (const std::string& line : said)
    std::sscanf(line.c_str(),
                "the memory for the world is full: it is shown %lf blocks far, %lf of",
                &view_blocks, &detail_blocks);
  ASSERT_GT(detail_blocks, 0.0);
  ASSERT_LT(detail_blocks, tight->settings().view_detail);
  // All that lies within is resident in full detail, and what is coarser lies beyond. Islands near
  // a limit keep their state.
  std::size_t near_islands = 0, far_islands = 0;
  for (const Around& island : islands_around(*tight, moment)) {
    if (island.blocks < 0.95 * view_blocks) {
      EXPECT_TRUE(island.resident) << island.blocks;
    }
    near_islands += island.resident && island.blocks < 0.95 * detail_blocks;
    far_islands += island.resident && island.blocks > 1.05 * detail_blocks;
  }
  const std::map<std::uint32_t, std::uint32_t> levels = levels_of(tight->renderer().geometry());
  const auto in_full = static_cast<std::size_t>(
      std::ranges::count_if(levels, [](const auto& island) { return island.second == 0; }));
  EXPECT_GT(near_islands, 0u);
  EXPECT_GT(far_islands, 0u);
  EXPECT_GE(in_full, near_islands);
  EXPECT_GE(levels.size() - in_full, far_islands);
}

TEST_F(SceneMemory, AStillOfMoreThanItHoldsIsTheSameEachTime) {
  std::vector<std::byte> first;
  for (int i = 0; i < 2; ++i) {
    const auto tight = view(8);
    SceneView::Moment moment;
    moment.camera = tight->start_camera();
    ASSERT_TRUE(tight->load_completely(moment));
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
  const std::uint64_t most = device().memory_total();
  device().set_allocation_gate([&](const std::string&, std::uint64_t bytes) {
    return device().memory_total() + bytes <= most;
  });
  const auto drawn = shown->draw(moment, {kSize.width * 4, kSize.height * 4});
  ASSERT_TRUE(drawn) << drawn.error().message;
  EXPECT_FALSE(shown->notices().empty());
  EXPECT_TRUE(settle(*shown, moment));
  EXPECT_GT(shown->renderer().geometry().quads_resident(), 10'000u) << "it was streamed in again";
  EXPECT_LT(shown->renderer().world_memory().used, before);
  device().set_allocation_gate({});
}

}  // namespace
}  // namespace skerry::game
