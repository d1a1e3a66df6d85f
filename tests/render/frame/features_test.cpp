// What a scene does not have costs nothing: no pass, no memory, no pipeline.
#include "engine/render/scene/cull_pass.h"

#include <algorithm>
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{64, 48};
constexpr double kNoon = 12.0 * 3600.0;

world::BlockId ground(int, int y, int) {
  return y < 0 ? world::block::kGrass : world::block::kAirBlock;
}
world::BlockId pond(int x, int y, int z) {
  const bool in_pond = y == -1 && x >= 10 && x < 20 && z >= 10 && z < 20;
  return in_pond ? static_cast<world::BlockId>(world::block::kWater) : ground(x, y, z);
}

class Features : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input(const Celestial& sky) const {
    FrameInput in;
    in.islands = islands_;
    in.sky = sky;
    in.camera = camera_at({15.0, 8.0, -3.0}, 0.0, -30.0);  // towards the pond
    return in;
  }
  bool has_memory(const std::string& name) {
    const std::vector<gpu::MemoryUse> use = device().memory_use();
    return std::any_of(use.begin(), use.end(),
                       [&](const gpu::MemoryUse& one) { return one.name == name; });
  }
};

TEST_F(Features, ANightWithoutMoonHasNoShadowPassMapOrPipeline) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(input(celestial_at(0.0, 0.0)), {}, kSize);
  EXPECT_FALSE(has_pass("shadow"));
  EXPECT_FALSE(has_memory("shadow maps"));
  const int pipelines = renderer().pipelines_created();

  restart();
  add(ground, {0, -1, 0}, {1, 0, 1});
  RenderSettings off;
  off.shadow_enabled = false;
  drawn(input(celestial_at(kNoon, 0.0)), off, kSize);
  EXPECT_FALSE(has_pass("shadow"));
  EXPECT_FALSE(has_memory("shadow maps"));
  EXPECT_EQ(renderer().pipelines_created(), pipelines);

  drawn(input(celestial_at(kNoon, 0.0)), {}, kSize);
  EXPECT_TRUE(has_pass("draw_shadow_sun_0"));
  EXPECT_TRUE(has_memory("shadow maps"));
  EXPECT_GT(renderer().pipelines_created(), pipelines);
}

TEST_F(Features, ShadowMapsAreGivenBackAtNightfall) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(input(celestial_at(kNoon, 0.0)), {}, kSize);
  ASSERT_TRUE(has_memory("shadow maps"));
  // Frames in flight may still use them.
  for (int i = 0; i < 4; ++i) drawn(input(celestial_at(0.0, 0.0)), {}, kSize);
  device().collect();
  EXPECT_FALSE(has_memory("shadow maps"));
}

TEST_F(Features, EachBodyHasShadowPassesOnlyWhileItShines) {
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(input(celestial_at(kNoon, 0.5)), {}, kSize);
  EXPECT_TRUE(has_pass("draw_shadow_sun"));
  EXPECT_FALSE(has_pass("draw_shadow_moon"));
  drawn(input(celestial_at(0.0, 0.5)), {}, kSize);
  EXPECT_FALSE(has_pass("draw_shadow_sun"));
  EXPECT_TRUE(has_pass("draw_shadow_moon"));
}

TEST_F(Features, WithoutTranslucentBlocksNothingIsDrawnForThem) {
  const FrameInput noon = input(celestial_at(kNoon, 0.0));
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(noon, {}, kSize);
  EXPECT_FALSE(has_pass("translucent"));
  EXPECT_FALSE(has_pass("develop"));
  EXPECT_FALSE(has_memory("radiance"));
  const int pipelines = renderer().pipelines_created();

  restart();
  add(pond, {0, -1, 0}, {1, 0, 1});
  FrameInput away = noon;
  away.camera.yaw_deg = 180.0;
  drawn(away, {}, kSize);  // the pond is there, but behind
  EXPECT_FALSE(has_pass("translucent"));
  EXPECT_FALSE(has_pass("develop"));
  EXPECT_EQ(renderer().pipelines_created(), pipelines);

  drawn(noon, {}, kSize);
  EXPECT_TRUE(has_pass("draw_translucent_0"));
  EXPECT_TRUE(has_pass("refresh_picture"));
  EXPECT_TRUE(has_memory("radiance"));
  EXPECT_GT(renderer().pipelines_created(), pipelines);
}

// Everything a frame can consist of either runs or is named with a reason.
TEST_F(Features, WhateverDoesNotRunIsExplained) {
  const std::vector<std::string> known{"bake_sky",         "cull_sections",   "cull_emit",
                                       "draw_geometry",    "draw_shadow_sun", "draw_shadow_moon",
                                       "classify_tiles",   "shade_surfaces",  "shade_sky",
                                       "draw_translucent", "develop",         "shade_translucent"};
  const auto expect_explained = [&](const char* scene) {
    for (const std::string& pass : known) {
      const std::vector<gpu::LeftOut>& out = renderer().graph().left_out();
      const bool named = std::any_of(out.begin(), out.end(), [&](const gpu::LeftOut& one) {
        return one.name.starts_with(pass) && !one.why.empty();
      });
      EXPECT_TRUE(named || has_pass(pass)) << pass << " in " << scene;
    }
  };
  const auto why = [&](std::string_view name) -> std::string {
    for (const gpu::LeftOut& one : renderer().graph().left_out())
      if (one.name == name) return one.why;
    return {};
  };
  drawn(input(celestial_at(kNoon, 0.0)), {}, kSize);
  expect_explained("an empty world");
  add(ground, {0, -1, 0}, {1, 0, 1});
  drawn(input(celestial_at(0.0, 0.0)), {}, kSize);
  expect_explained("a night without moon");
  EXPECT_EQ(why("sun"), why("draw_shadow_sun"));
  EXPECT_NE(why("moon"), "");
  EXPECT_NE(why("haze"), "");
  EXPECT_NE(why("cutouts"), "");
  EXPECT_EQ(why("stars"), "");
  const FrameInput noon = input(celestial_at(kNoon, 0.0));
  drawn(noon, {}, kSize);
  expect_explained("a day with nothing translucent");
  EXPECT_NE(why("water"), "");
  drawn(noon, {}, kSize);
  expect_explained("a second frame in which nothing moves");
  EXPECT_NE(why("draw_shadow_sun_0"), "");
  EXPECT_NE(why("bake_sky"), "");
  RenderSettings off;
  off.shadow_enabled = false;
  drawn(noon, off, kSize);
  expect_explained("a day without shadows");
  off.debug_view = DebugView::kNormal;
  drawn(noon, off, kSize);
  expect_explained("a debug view");
}

// Leaves stand behind the camera: the light sees them, the picture does not.
TEST_F(Features, CutOutsAreDrawnOnlyIntoViewsThatHaveThem) {
  const auto leaves_behind = [](int x, int y, int z) -> world::BlockId {
    if (y < 0) return world::block::kGrass;
    return y < 3 && x < 4 && z < 4 ? world::block::kOakLeaves : world::block::kAirBlock;
  };
  add(ground, {0, -1, 0}, {1, 0, 3});
  add(leaves_behind, {0, 0, 0}, {1, 1, 1});
  FrameInput in = input(celestial_at(0.0, 0.0));
  in.camera = camera_at({15.0, 8.0, 70.0}, 0.0, -30.0);
  const FrameReport night = drawn(in, {}, kSize);
  EXPECT_EQ(night.counts.draws, 1u) << "opaque quads of the picture";
  in.sky = celestial_at(kNoon, 0.0);
  EXPECT_GT(drawn(in, {}, kSize).counts.draws, 1u + 4u) << "leaves in shadow maps";
  in.sky = celestial_at(0.0, 0.0);
  in.camera.yaw_deg = 180.0;
  EXPECT_EQ(drawn(in, {}, kSize).counts.draws, 2u);
  RenderSettings without;
  without.leave_out.add(Feature::kCutouts);
  EXPECT_EQ(drawn(in, without, kSize).counts.draws, 1u);
}

TEST(DrawBound, IsCheckedAgainstTheDevice) {
  gpu::DeviceLimits limits;
  limits.max_draw_count = 65535;
  EXPECT_TRUE(check_draws({65535, 65535, 0}, limits));
  const Result<void> refused = check_draws({3, 65536, 0}, limits);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("65535"), std::string::npos);
}

TEST_F(Features, DrawsHaveRoomForWhatIsResident) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  const GeometryStore& store = renderer().geometry();
  const DrawLimits most = store.most_draws();
  EXPECT_GE(most[0], store.sections_resident());
  EXPECT_LE(most[0], 3 * store.sections_resident()) << "six faces make three runs at most";
  EXPECT_EQ(most[1], 0u) << "there is no leaf";
  EXPECT_GE(most[2], 1u);
  const FrameReport report = drawn(input(celestial_at(kNoon, 0.0)), {}, kSize);
  EXPECT_GT(report.camera.draws, 0u);
  EXPECT_LE(report.camera.draws, most[0] + most[2]);
}

TEST_F(Features, OnlyAsManyLayersArePeeledAsAskedFor) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  for (int layers = 1; layers <= 4; ++layers) {
    RenderSettings settings;
    settings.water_layers = layers;
    drawn(input(celestial_at(kNoon, 0.0)), settings, kSize);
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(has_pass("draw_translucent_" + std::to_string(k)), k < layers) << layers;
  }
}

// Words are not cleared: what an earlier frame left there must not be seen.
TEST_F(Features, NothingIsSeenOfTheFrameBefore) {
  const auto panes = [](int x, int y, int z) {
    const bool pane = y >= 0 && y < 12 && z == 24 && x % 8 < 5;
    return pane ? static_cast<world::BlockId>(world::block::kGlass) : pond(x, y, z);
  };
  RenderSettings settings;
  settings.water_layers = 3;
  settings.clouds.coverage = 0.5f;
  const auto picture_towards = [&](double yaw) {
    FrameInput in = input(celestial_at(kNoon, 0.0));
    in.camera = camera_at({15.0, 8.0, -3.0}, yaw, -20.0);
    drawn(in, settings, kSize);
    return picture();
  };
  const std::vector<double> yaws{0.0, -20.0, 35.0, 10.0};
  add(panes, {0, -1, 0}, {1, 0, 1});
  std::vector<std::vector<std::uint8_t>> in_turn;
  for (const double yaw : yaws) in_turn.push_back(picture_towards(yaw));
  for (std::size_t i = 0; i < yaws.size(); ++i) {
    restart();
    add(panes, {0, -1, 0}, {1, 0, 1});
    EXPECT_EQ(in_turn[i], picture_towards(yaws[i])) << yaws[i];
    EXPECT_TRUE(has_pass("shade_translucent"));
  }
}

TEST_F(Features, AnEmptyWorldIsSkyAndNothingElse) {
  FrameInput in = input(celestial_at(kNoon, 0.5));
  in.islands = {};
  const FrameReport report = drawn(in, {}, kSize);
  const std::vector<std::string> first{"clear_pixel_stats", "bake_sky", "shade_sky", "read_stats",
                                       "stats_to_cpu"};
  EXPECT_EQ(renderer().graph().pass_names(), first);
  EXPECT_EQ(renderer().pipelines_created(), 2);
  EXPECT_EQ(report.camera.sections_in, 0u);
  EXPECT_EQ(report.pixels.black, 0u);
  EXPECT_FALSE(has_memory("shadow maps"));
  drawn(in, {}, kSize);
  EXPECT_FALSE(has_pass("bake_sky")) << "the sun has not moved";
}

TEST_F(Features, RemovedGeometryLeavesNoTrace) {
  const FrameInput noon = input(celestial_at(kNoon, 0.0));
  drawn(noon, {}, kSize);
  const std::vector<std::uint8_t> empty = picture();
  add(pond, {0, -1, 0}, {1, 0, 1});
  drawn(noon, {}, kSize);
  EXPECT_NE(picture(), empty);
  renderer().geometry().remove(renderer().mesh_uploader(), SectionId{0});
  drawn(noon, {}, kSize);
  EXPECT_EQ(picture(), empty);
  EXPECT_FALSE(has_pass("cull"));
  EXPECT_EQ(renderer().geometry().quads_resident(), 0u);
}

}  // namespace
}  // namespace skerry::render
