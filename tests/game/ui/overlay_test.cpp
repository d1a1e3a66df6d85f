#include "game/ui/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/readback.h"
#include "game/client/overlay_pass.h"
#include "game/ui/gui.h"

namespace skerry::game {
namespace {

OverlayFacts some_facts() {
  static const std::vector<float> frames(240, 16.0f);
  static const std::vector<std::string> lines{"seed 1", "x 12.5 y 80 z -3"};
  static const std::vector<gpu::PassTime> passes{{"sky", 1.25}, {"shadow_sun", 0.5}};
  static const std::vector<OverlayFacts::Count> counts{{"quads", 123456}};
  static const std::vector<gpu::MemoryUse> memory(40, {"quads", 1000});
  return {frames, lines, 1.75, passes, counts, memory, true, {}, {}};
}

ui::OverlayTriangles lay_out(ui::Gui& gui, const OverlayFacts& facts, std::uint32_t width,
                             std::uint32_t height, double seconds = 0.016) {
  gui.begin({width, height, seconds, nullptr});
  show_overlay(facts);
  return gui.end();
}

TEST(Overlay, LaysTrianglesOutWithinTheirClipsAndThePicture) {
  ui::Gui gui;
  ui::OverlayTriangles triangles;
  for (int frame = 0; frame < 3; ++frame) triangles = lay_out(gui, some_facts(), 1280, 720);
  ASSERT_GT(triangles.vertices.size(), 600u);  // a hundred glyphs at the least
  EXPECT_EQ(triangles.vertices.size() % 3, 0u);
  for (const shared::OverlayVertex& vertex : triangles.vertices) {
    ASSERT_LT(vertex.clip, triangles.clips.size());
    ASSERT_TRUE(vertex.uv.x >= 0.0f && vertex.uv.x <= 1.0f && vertex.uv.y >= 0.0f &&
                vertex.uv.y <= 1.0f);
    ASSERT_TRUE(vertex.position.x >= 0.0f && vertex.position.x <= 1280.0f) << vertex.position.x;
  }
}

TEST(Overlay, LeavesTheViewAndTheHotbarClearInASmallWindow) {
  ui::Gui gui;
  OverlayFacts facts = some_facts();
  static const std::vector<gpu::PassTime> passes(60, {"some_pass", 0.1});
  facts.passes = passes;
  ui::OverlayTriangles triangles;
  for (int frame = 0; frame < 3; ++frame) triangles = lay_out(gui, facts, 640, 360);
  for (const shared::OverlayVertex& vertex : triangles.vertices) {
    const glm::vec4 clip = triangles.clips[vertex.clip];
    const float x = std::clamp(vertex.position.x, clip.x, clip.z);
    const float y = std::clamp(vertex.position.y, clip.y, clip.w);
    ASSERT_TRUE(x <= 210.0f || x >= 430.0f) << x;  // a third of the width stays clear
    ASSERT_LE(y, 286.0f);                          // a message over the hotbar begins at 287
  }
}

TEST(Overlay, LongNamesLeaveTheValuesAsTheyAre) {
  // Where the glyphs are that can be seen whole, and how many are cut off.
  struct Glyphs {
    std::vector<std::pair<float, float>> values;  // corners in the columns of values
    int cut = 0;
  };
  const auto glyphs = [](const std::string& name, std::uint32_t width, std::uint32_t height) {
    ui::Gui gui;
    OverlayFacts facts = some_facts();
    const std::vector<gpu::PassTime> passes{{name, 123.456}, {"sky", 0.5}};
    const std::vector<gpu::MemoryUse> memory{{name, 1234567890}};
    facts.passes = passes;
    facts.memory = memory;
    facts.gpu_ms = 200.0;
    ui::OverlayTriangles triangles;
    for (int frame = 0; frame < 4; ++frame) triangles = lay_out(gui, facts, width, height);
    Glyphs found;
    const float edge = static_cast<float>(width) - 40.0f;  // the last letters of "123.456 ms"
    for (const shared::OverlayVertex& vertex : triangles.vertices) {
      const glm::vec4 clip = triangles.clips[vertex.clip];
      if (vertex.color >> 24 != 0xff) continue;  // lines and bars
      if (vertex.position.x > clip.z + 1.0f) ++found.cut;
      if (vertex.position.x > edge && vertex.position.x <= clip.z + 1.0f)
        found.values.emplace_back(vertex.position.x, vertex.position.y);
    }
    return found;
  };
  for (const auto& [width, height] : {std::pair(640u, 360u), {1280u, 720u}}) {
    const Glyphs brief = glyphs("cull", width, height);
    const Glyphs lengthy = glyphs("resolve_temporal_anti_aliasing_of_translucent", width, height);
    EXPECT_GE(brief.values.size(), 36u) << width;  // two glyphs of three values at least
    EXPECT_EQ(brief.values, lengthy.values) << width;
    EXPECT_EQ(brief.cut, 0) << width;
    EXPECT_EQ(lengthy.cut, 0) << width;
  }
}

TEST(Overlay, ShowsSquaresOfTheDisplaysOwnValuesWhileCalibrating) {
  ui::Gui gui;
  const auto colours = [&](const render::DisplaySettings& display) {
    OverlayFacts facts;
    facts.numbers = false;
    facts.calibration = display;
    ui::OverlayTriangles triangles;
    for (int frame = 0; frame < 3; ++frame) triangles = lay_out(gui, facts, 640, 480);
    std::set<std::uint32_t> seen;
    for (const shared::OverlayVertex& vertex : triangles.vertices) seen.insert(vertex.color);
    return seen;
  };
  const auto grey = [](std::uint32_t level) { return 0xff000000u | level * 0x010101u; };
  for (const std::uint32_t level : {0u, 1u, 2u, 4u, 8u, 16u, 224u, 254u, 255u})
    EXPECT_TRUE(colours({}).contains(grey(level))) << level;
  const std::set<std::uint32_t> lifted = colours({0.5f, 0.05f});
  EXPECT_TRUE(lifted.contains(grey(0)));  // black is never lifted
  EXPECT_FALSE(lifted.contains(grey(1)));
  EXPECT_TRUE(lifted.contains(grey(188)));  // sRGB of a half
}

TEST(Overlay, SurvivesAWindowOfOnePixelAndNothingToShow) {
  ui::Gui gui;
  for (int frame = 0; frame < 3; ++frame) {
    (void)lay_out(gui, {}, 1, 1, 0.0);
    (void)lay_out(gui, some_facts(), 1, 1, 10.0);
  }
}

TEST(Overlay, SpreadsAreOrderStatistics) {
  std::vector<float> frames;
  for (int i = 200; i > 0; --i) frames.push_back(static_cast<float>(i));
  const FrameSpread spread = spread_of_frames(frames);
  EXPECT_EQ(spread.median, 101.0f);
  EXPECT_EQ(spread.slowest_1_percent, 199.0f);
  EXPECT_EQ(spread_of_frames({}).median, 0.0f);
}

TEST(OverlayPass, BlendsExactlyInsideItsClip) {
  gpu::DeviceOptions options;
  options.validate = true;
  auto device = gpu::Device::create(options);
  if (!device) FAIL() << device.error().message;  // every platform of ours has a device
  constexpr std::uint32_t kSize = 16;
  constexpr unsigned char kCovered[4] = {255, 255, 255, 255}, kRed[4] = {255, 0, 0, 255};
  {
    auto pass = OverlayPass::create(**device, {{2, 2, kCovered}, {1, 1, kRed}});
    ASSERT_TRUE(pass) << pass.error().message;
    auto image = (*device)->create_image({.name = "canvas",
                                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                                          .extent = {kSize, kSize},
                                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    ASSERT_TRUE(image);
    // One half-transparent red triangle that covers everything, cut to x 4..12, y 2..6.
    ui::OverlayTriangles triangles;
    triangles.clips.emplace_back(4.0f, 2.0f, 12.0f, 6.0f);
    for (const glm::vec2 corner : {glm::vec2(-20, -20), glm::vec2(60, -20), glm::vec2(-20, 60)}) {
      triangles.vertices.push_back({corner, {0.5f, 0.5f}, 0x800000FFu, 0});
    }
    gpu::Pipelines pipelines(**device);
    gpu::FrameGraph graph(device->get());
    graph.begin();
    gpu::ImageRef canvas = graph.import(*image);
    graph.add_pass(
        "clear", [&](gpu::PassBuilder& b) { canvas = b.write(canvas, gpu::Use::kTransferWrite); },
        [&canvas](gpu::Commands& c) {
          c.clear(canvas, {{0.0f, 0.0f, 1.0f, 1.0f}});
        });
    const gpu::ImageRef cleared = canvas;
    auto drawn = (*pass)->add(graph, pipelines, cleared, {kSize, kSize}, triangles, 0);
    ASSERT_TRUE(drawn) << drawn.error().message;
    graph.compile();
    (*device)->run_now([&](VkCommandBuffer commands) { graph.execute(commands, 0); });
    const auto pixels = gpu::read_back(**device, *image, 4);
    ASSERT_TRUE(pixels);
    for (std::uint32_t y = 0; y < kSize; ++y) {
      for (std::uint32_t x = 0; x < kSize; ++x) {
        const bool inside = x >= 4 && x < 12 && y >= 2 && y < 6;
        // 128/255 of red over blue: 255 * 128/255 = 128 and 255 * 127/255 = 127.
        const std::array<int, 4> wanted =
            inside ? std::array{128, 0, 127, 255} : std::array{0, 0, 255, 255};
        for (std::size_t c = 0; c < 4; ++c) {
          const int got = static_cast<int>((*pixels)[(y * kSize + x) * 4 + c]);
          ASSERT_LE(std::abs(got - wanted[c]), 1) << x << "," << y << " channel " << c;
        }
      }
    }
  }
  EXPECT_EQ((*device)->validation_message_count(), 0);
}

}  // namespace
}  // namespace skerry::game
