// What a scene does not have costs nothing: no pass, no memory, no pipeline.
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
  off.shadows = false;
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
  EXPECT_TRUE(has_pass("develop"));
  EXPECT_GT(renderer().pipelines_created(), pipelines);
}

TEST_F(Features, OnlyAsManyLayersArePeeledAsAskedFor) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  for (int layers = 1; layers <= 4; ++layers) {
    RenderSettings settings;
    settings.translucent_layers = layers;
    drawn(input(celestial_at(kNoon, 0.0)), settings, kSize);
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(has_pass("draw_translucent_" + std::to_string(k)), k < layers) << layers;
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
