// What glows has a shape of its own: a torch's stick is wood, a crystal has edges.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/render/light/lights.h"
#include "game/scene_file/emission.h"
#include "tests/render/renderer_on_gpu.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{160, 160};
constexpr glm::dvec3 kVoxel{32.0, 0.0, 32.0};  // of the block that glows

struct Area {
  int left, top, right, bottom;  // pixels, the last ones included
};

class Glow : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  std::vector<shared::Light> lamps_;

  /// One block on stone, on a night without a moon.
  FrameInput night(world::BlockId block, glm::dvec3 eye, double yaw, double pitch) {
    add(
        [block](int x, int y, int z) {
          return y < 0                          ? world::BlockId{world::block::kStone}
                 : x == 32 && y == 0 && z == 32 ? block
                                                : world::BlockId{world::block::kAirBlock};
        },
        {0, -1, 0}, {1, 1, 1});
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 200.0;
    in.sky = sun_at(-60.0, 0.0);
    in.camera = camera_at(eye, yaw, pitch, 40.0);
    in.exposure_ev = -3.0f;
    return in;
  }
  /// The block's own lamp.
  void light(FrameInput& in, world::BlockId block, glm::dvec3 eye) {
    const game::BlockEmission emission = game::emission_table()[block];
    shared::Light lamp{};
    lamp.kind = shared::kLightPoint;
    lamp.position = glm::vec3(kVoxel + 0.5 + glm::dvec3(emission.offset) - eye);
    lamp.intensity = emission.face_intensity;
    lamp.range = game::light_range(emission.face_intensity);
    const Result<shared::Light> taken = checked_light(lamp);
    ASSERT_TRUE(taken) << taken.error().message;
    lamps_ = {*taken};
    in.lights = lamps_;
  }
  static RenderSettings settings(int rate) {
    RenderSettings out;
    out.shading_rate = rate;
    return out;
  }
  /// Colours of the last frame, 0 .. 255.
  std::vector<glm::dvec3> colours(const Area& area) {
    const std::vector<std::uint8_t> all = picture();
    std::vector<glm::dvec3> out;
    for (int y = area.top; y <= area.bottom; ++y)
      for (int x = area.left; x <= area.right; ++x) {
        const std::size_t at =
            4 * (static_cast<std::size_t>(y) * kSize.width + static_cast<std::size_t>(x));
        out.emplace_back(all[at], all[at + 1], all[at + 2]);
      }
    return out;
  }
};

double brightness(const glm::dvec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}
std::vector<double> brightness(const std::vector<glm::dvec3>& colours) {
  std::vector<double> out;
  for (const glm::dvec3& c : colours) out.push_back(brightness(c));
  std::sort(out.begin(), out.end());
  return out;
}
glm::dvec3 mean(const std::vector<glm::dvec3>& colours) {
  return std::accumulate(colours.begin(), colours.end(), glm::dvec3(0.0)) /
         static_cast<double>(colours.size());
}
/// Standard deviation over the mean.
double contrast(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double v : values) {
    sum += v;
    squares += v * v;
  }
  const auto n = static_cast<double>(values.size());
  return std::sqrt(std::max(0.0, squares / n - sum * sum / n / n)) / (sum / n);
}

// Seen from two blocks away, a block is 110 pixels high.
constexpr glm::dvec3 kBeforeTorch{32.5, 0.5, 30.5};
constexpr Area kStick{76, 91, 84, 130}, kFlame{76, 55, 84, 72};

TEST_F(Glow, ATorchsStickIsWoodAndItsFlameIsBrighter) {
  FrameInput in = night(world::block::kTorch, kBeforeTorch, 0.0, 0.0);
  light(in, world::block::kTorch, kBeforeTorch);
  for (const int rate : {1, 4}) {
    drawn(in, settings(rate), kSize);
    const std::vector<glm::dvec3> stick = colours(kStick), flame = colours(kFlame);
    const glm::dvec3 wood = mean(stick);
    std::printf("stick %.0f %.0f %.0f, contrast %.3f; flame %.0f\n", wood.x, wood.y, wood.z,
                contrast(brightness(stick)), brightness(mean(flame)));
    EXPECT_GT(contrast(brightness(stick)), 0.12) << "grain, and darker farther from the flame";
    EXPECT_GT(wood.x, 1.2 * wood.y);
    EXPECT_GT(wood.y, 1.2 * wood.z);
    EXPECT_GT(brightness(mean(flame)), 1.2 * brightness(wood));
  }
}

TEST_F(Glow, AStickThatNothingLightsIsBlack) {
  const FrameInput in = night(world::block::kTorch, kBeforeTorch, 0.0, 0.0);
  for (const int rate : {1, 4}) {
    const std::vector<glm::vec4> seen = radiance(in, settings(rate), kSize);
    const auto most = [&](const Area& area) {
      float out = 0.0f;
      for (int y = area.top; y <= area.bottom; ++y)
        for (int x = area.left; x <= area.right; ++x) {
          const glm::vec4& c =
              seen[static_cast<std::size_t>(y) * kSize.width + static_cast<std::size_t>(x)];
          out = std::max({out, c.x, c.y, c.z});
        }
      return out;
    };
    EXPECT_LT(most(kStick), 1e-3f);
    EXPECT_GT(most(kFlame), 5.0f);
  }
}

TEST_F(Glow, ACrystalHasEdgesAndFacets) {
  for (const world::BlockId crystal : {world::block::kCrystalBlue, world::block::kCrystalViolet}) {
    const glm::dvec3 eye{31.0, 2.0, 31.0};
    const FrameInput in = night(crystal, eye, 45.0, -38.0);
    for (const int rate : {1, 4}) {
      drawn(in, settings(rate), kSize);
      // The corner at the top is in the middle: three faces, and the edges between them.
      const std::vector<double> all = brightness(colours({60, 70, 100, 110}));
      std::printf("crystal: darkest twentieth %.0f, median %.0f\n", all[all.size() / 20],
                  all[all.size() / 2]);
      EXPECT_LT(all[all.size() / 20], 0.6 * all[all.size() / 2]);
      EXPECT_GT(all[all.size() / 2], 128.0);
    }
    restart();
  }
}

}  // namespace
}  // namespace skerry::render
