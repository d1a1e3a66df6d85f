// Sun through panes of glass, against Beer's law along each ray.
#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "tests/render/extinction.h"
#include "tests/render/random_scenes.h"
#include "tests/render/renderer_on_gpu.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{96, 96};
constexpr double kSun = 3000.0;      // irradiance
constexpr int kLow = 9, kHigh = 15;  // y of panes; the floor's surface is at y = 1

struct Pane {
  glm::ivec3 low, high;  // before `high`
  world::BlockId block;
};
using Panes = std::vector<Pane>;

world::BlockId block_at(const Panes& panes, glm::ivec3 voxel,
                        world::BlockId floor = world::block::kStone) {
  if (voxel.y == 0) return floor;
  for (const Pane& pane : panes)
    if (glm::all(glm::greaterThanEqual(voxel, pane.low)) &&
        glm::all(glm::lessThan(voxel, pane.high)))
      return pane.block;
  return world::block::kAirBlock;
}

/// What glass leaves on a ray: the blocks that it passes, a small step after the other.
glm::dvec3 left_on_ray(const Panes& panes, glm::dvec3 from, glm::dvec3 direction) {
  constexpr double kStep = 1.0 / 64.0;
  const double end = (kHigh + 1.0 - from.y) / direction.y;
  glm::dvec3 depth(0.0);
  for (double t = (kLow - 1.0 - from.y) / direction.y; t < end; t += kStep) {
    const world::BlockId block =
        block_at(panes, glm::ivec3(glm::floor(from + direction * (t + 0.5 * kStep))));
    if (world::is_glass(block)) depth += kStep * extinction_of(block);
  }
  return glm::exp(-depth);
}

class ThroughGlass : public RendererOnGpu {
 protected:
  std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  world::BlockId floor_ = world::block::kStone;
  double lowest_ = 1.0;  // height of the floor's other side, if it is seen

  glm::dvec3 in_lattice(glm::dvec3 world) const {
    return glm::conjugate(islands_[0].rotation) * world;
  }
  /// From under the panes straight down.
  FrameInput view(glm::dvec3 to_sun) const {
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 200.0;
    in.sky = celestial_at(0.5 * kDaySeconds, 0.0);
    in.sky.to_sun = glm::normalize(to_sun);
    in.sky.sun_irradiance = glm::vec3(kSun);
    const glm::dvec3 eye = islands_[0].rotation * glm::dvec3(32.0, 8.0, 32.0);
    in.camera = camera_at(eye, 0.0, -90.0, 70.0);
    return in;
  }
  void show(const Panes& panes) {
    restart();
    add(
        [&](int x, int y, int z) {
          return block_at(panes, {x, y, z}, floor_);
        },
        {0, 0, 0}, {1, 1, 1});
  }

  struct Judged {
    double error = 0.0;  // largest, of what comes through
    int pixels = 0, dim = 0;
  };
  /// What comes through to a pixel's place at a height, for each pixel.
  std::vector<glm::dvec3> expected_at(double height, const Panes& panes, const FrameInput& in) {
    const glm::dvec3 to_sun = in_lattice(in.sky.to_sun);
    const glm::dvec3 eye = in_lattice(islands_[0].rotation * glm::dvec3(32.0, 8.0, 32.0));
    std::vector<glm::dvec3> out(kSize.width * kSize.height);
    for (std::uint32_t i = 0; i < out.size(); ++i) {
      const glm::dvec3 ray = in_lattice(
          ray_of(in.camera, i % kSize.width, i / kSize.width, kSize.width, kSize.height));
      out[i] = left_on_ray(panes, eye + ray * ((height - eye.y) / ray.y), to_sun);
    }
    return out;
  }
  /// @return of pixels about which no edge of a pane is seen. What a floor of glass sends lies
  /// between what its two sides get.
  Judged judge(const Panes& panes, const FrameInput& in) {
    show({});
    const std::vector<glm::vec4> without = radiance(in, {}, kSize);
    show(panes);
    const std::vector<glm::vec4> with = radiance(in, {}, kSize);
    const std::vector<glm::dvec3> expected = expected_at(1.0, panes, in),
                                  below = expected_at(lowest_, panes, in);
    Judged out;
    for (std::uint32_t y = 2; y + 2 < kSize.height; ++y)
      for (std::uint32_t x = 2; x + 2 < kSize.width; ++x) {
        const std::uint32_t i = y * kSize.width + x;
        double differs = 0.0;
        for (const int dy : {-2, 0, 2})
          for (const int dx : {-2, 0, 2}) {
            const std::uint32_t beside = i + static_cast<std::uint32_t>(dx + dy * int(kSize.width));
            for (const std::vector<glm::dvec3>* side : {&expected, &below}) {
              const glm::dvec3 off = glm::abs((*side)[beside] - (*side)[i]);
              differs = std::max({differs, off.x, off.y, off.z});
            }
          }
        if (differs > 0.04) continue;
        ++out.pixels;
        out.dim += expected[i].x < 0.3;
        for (int c = 0; c < 3; ++c) {
          const double seen = double{with[i][c]} / double{without[i][c]};
          out.error = std::max({out.error, seen - std::max(expected[i][c], below[i][c]),
                                std::min(expected[i][c], below[i][c]) - seen});
        }
      }
    return out;
  }
};

TEST_F(ThroughGlass, ColoursTheSunAsBeersLawSays) {
  RandomPlaces random(71);
  constexpr std::array kGlasses{world::block::kRedGlass, world::block::kGreenGlass,
                                world::block::kSkyGlass, world::block::kGlass};
  for (int scene = 0; scene < 4; ++scene) {
    SCOPED_TRACE(scene);
    Panes panes;
    for (int i = 0; i < 12; ++i) {
      const auto at = [&](int low, int high) { return static_cast<int>(random.whole(low, high)); };
      const glm::ivec3 low(at(16, 40), at(kLow, kHigh - 2), at(16, 40));
      panes.push_back({low, low + glm::ivec3(at(2, 14), at(1, 2), at(2, 14)),
                       kGlasses[static_cast<std::size_t>(at(0, 3))]});
    }
    islands_[0].rotation = glm::angleAxis(0.4 * scene, glm::dvec3(0.0, 1.0, 0.0));
    const double angle = glm::radians(10.0 + 15.0 * scene), about = random.uniform(0.0, 6.28);
    const Judged judged = judge(panes, view({std::sin(angle) * std::cos(about), std::cos(angle),
                                             std::sin(angle) * std::sin(about)}));
    EXPECT_LT(judged.error, 0.03);
    EXPECT_GT(judged.pixels, 2000);
    EXPECT_GT(judged.dim, 300);
  }
}

TEST_F(ThroughGlass, ColoursTheSunOnGlassToo) {
  floor_ = world::block::kWhiteGlass;
  lowest_ = 0.0;
  constexpr std::array kGlasses{world::block::kRedGlass, world::block::kGreenGlass,
                                world::block::kSkyGlass, world::block::kAirBlock};
  RandomPlaces random(72);
  for (int scene = 0; scene < 3; ++scene) {
    SCOPED_TRACE(scene);
    // Squares of 6 blocks, many of which touch others.
    Panes panes;
    for (int x = 14; x < 50; x += 6)
      for (int z = 14; z < 50; z += 6) {
        const glm::ivec3 low(x, static_cast<int>(random.whole(10, 11)), z);
        panes.push_back({low, low + glm::ivec3(6, 1, 6),
                         kGlasses[static_cast<std::size_t>(random.whole(0, 3))]});
      }
    islands_[0].rotation = glm::angleAxis(0.4 * scene, glm::dvec3(0.0, 1.0, 0.0));
    const double angle = glm::radians(8.0 + 14.0 * scene), about = random.uniform(0.0, 6.28);
    const Judged judged = judge(panes, view({std::sin(angle) * std::cos(about), std::cos(angle),
                                             std::sin(angle) * std::sin(about)}));
    EXPECT_LT(judged.error, 0.03);
    EXPECT_GT(judged.pixels, 1500);
    EXPECT_GT(judged.dim, 300);
  }
}

TEST_F(ThroughGlass, TakesNothingOnTheLitSideOfAPane) {
  floor_ = world::block::kRedGlass;
  show({});
  const double angle = glm::radians(50.0);
  const FrameInput in = view({std::sin(angle), std::cos(angle), 0.0});
  RenderSettings white;
  white.shadow_enabled = false;
  const std::vector<glm::vec4> without = radiance(in, white, kSize);
  const std::vector<glm::vec4> with = radiance(in, {}, kSize);
  int whole = 0, coloured = 0;
  float most = 0.0f;
  for (std::size_t i = 0; i < with.size(); ++i) {
    const float share = with[i].y / without[i].y;
    most = std::max(most, share);
    whole += share > 0.99f;
    coloured += share < 0.9f;
  }
  EXPECT_LT(most, 1.001f);
  EXPECT_GT(whole, 300) << "of the frame, which covers what is lit through the pane";
  EXPECT_GT(coloured, 50) << "of the glass, whose far side is lit through it";
}

TEST_F(ThroughGlass, LeavesTheEdgesOfShadowsTheirColour) {
  // A wall with a window of red glass: nothing green or blue comes through, at its edges neither.
  const auto walled = [](int x, int y, int z) -> world::BlockId {
    if (y == 0) return world::block::kStone;
    if (y != 12) return world::block::kAirBlock;
    const bool window = x >= 28 && x < 36 && z >= 28 && z < 36;
    return window ? world::block::kRedGlass : world::block::kStone;
  };
  restart();
  add(walled, {0, 0, 0}, {1, 1, 1});
  const double angle = glm::radians(12.0);
  const FrameInput in = view({std::sin(angle), std::cos(angle), 0.0});
  const auto& red = world::block_types()[world::block::kRedGlass];
  const float most = std::exp(-(red.absorption[1] - red.absorption[0]));
  int lit = 0;
  float whitest = 0.0f;
  const std::vector<glm::vec4> seen = radiance(in, {}, kSize);
  float brightest = 0.0f;
  for (const glm::vec4& pixel : seen) brightest = std::max(brightest, pixel.x);
  for (const glm::vec4& pixel : seen) {
    if (pixel.x < 0.05f * brightest) continue;
    ++lit;
    whitest = std::max(whitest, pixel.y / pixel.x);
  }
  EXPECT_GT(lit, 500);
  EXPECT_LT(whitest, 1.6f * most);
}

TEST_F(ThroughGlass, IsLeftOutWithoutGlass) {
  show({});
  const FrameInput in = view({0.0, 1.0, 0.0});
  radiance(in, {}, kSize);
  EXPECT_FALSE(has_pass("draw_glass"));
  EXPECT_FALSE(has_pass("find_media_light"));
  show({{{20, 10, 20}, {40, 11, 40}, world::block::kGlass}});
  radiance(in, {}, kSize);
  EXPECT_TRUE(has_pass("draw_glass"));
  EXPECT_TRUE(has_pass("find_media_light"));
  EXPECT_FALSE(has_pass("list_glass")) << "clear glass colours nothing";
  show({{{20, 2, 20}, {40, 3, 40}, world::block::kRedGlass}});
  radiance(in, {}, kSize);
  EXPECT_TRUE(has_pass("list_glass"));
  EXPECT_TRUE(has_pass("find_layer_light"));
}

}  // namespace
}  // namespace skerry::render
