// Lamps behind stained glass, against Beer's law along each way.
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/render/light/lights.h"
#include "tests/render/extinction.h"
#include "tests/render/random_scenes.h"
#include "tests/render/renderer_on_gpu.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kPicture{80, 80};
constexpr glm::dvec3 kAbove{32.0, 40.0, 32.0};  // the camera, in the lattice

world::BlockId slab(int, int y, int) {
  return y == 0 ? world::block::kMarble : world::block::kAirBlock;
}

/// What panes leave on the way between two places, one small step after the other.
glm::dvec3 left_on_way(std::span<const shared::LightPane> panes, glm::dvec3 from, glm::dvec3 to) {
  constexpr int kSteps = 20000;
  const double step = glm::length(to - from) / kSteps;
  glm::dvec3 depth(0.0);
  for (int i = 0; i < kSteps; ++i) {
    const glm::vec3 at(glm::mix(from, to, (i + 0.5) / kSteps));
    for (const shared::LightPane& pane : panes) {
      if (!glm::all(glm::greaterThan(at, pane.low)) || !glm::all(glm::lessThan(at, pane.high)))
        continue;
      depth += step * extinction_of(static_cast<world::BlockId>(pane.block));
    }
  }
  return glm::exp(-depth);
}

shared::Light lamp_at(glm::vec3 place, std::uint32_t first_pane, std::uint32_t pane_count,
                      float intensity = 400.0f) {
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position = place;
  light.range = 60.0f;
  light.intensity = glm::vec3(intensity);
  light.first_pane = first_pane;
  light.pane_count = pane_count;
  return light;
}

class LightPanes : public RendererOnGpu {
 protected:
  std::vector<IslandPlacement> islands_{
      {{}, glm::angleAxis(0.7, glm::dvec3(0.0, 1.0, 0.0)), 300.0}};
  const std::vector<std::uint32_t> light_islands_{0};

  /// A night without moon, from above. Lights and panes in the lattice.
  FrameInput night(std::span<const shared::Light> lights,
                   std::span<const shared::LightPane> panes) {
    FrameInput in;
    in.islands = islands_;
    in.sky = celestial_at(0.0, 0.0);
    const glm::dvec3 eye = islands_[0].rotation * kAbove;
    in.camera = camera_at(eye, 0.0, -90.0, 60.0);
    lights_.assign(lights.begin(), lights.end());
    for (shared::Light& light : lights_) {
      light.position = glm::vec3(islands_[0].rotation * glm::dvec3(light.position) - eye);
      light.island_count = 1;
    }
    in.lights = lights_;
    in.light_islands = light_islands_;
    in.light_panes = panes;
    return in;
  }
  /// The place at this height that a pixel shows, in the lattice.
  glm::dvec3 place_of(const FrameInput& in, std::uint32_t pixel, double height) const {
    const glm::dvec3 ray = glm::conjugate(islands_[0].rotation) *
                           ray_of(in.camera, pixel % kPicture.width, pixel / kPicture.width,
                                  kPicture.width, kPicture.height);
    return kAbove + ray * ((height - kAbove.y) / ray.y);
  }

  /// Between what random panes leave of a lamp's light on the slab and Beer's law, as a share of
  /// the light without them.
  /// @param lowest height of a side of the slab that is seen; if it is not the upper one, both
  /// count.
  double largest_error(RandomPlaces& random, const RenderSettings& settings, float intensity,
                       double lowest = 1.0) {
    std::vector<shared::LightPane> panes;
    constexpr std::array kGlasses{world::block::kRedGlass, world::block::kGreenGlass,
                                  world::block::kSkyGlass};
    for (std::uint32_t i = 0; i < 9; ++i) {
      const glm::vec3 low(random.uniform(10.0, 44.0), random.uniform(1.0, 10.0),
                          random.uniform(10.0, 44.0));
      panes.push_back({low, kGlasses[i % 3],
                       low + glm::vec3(random.uniform(1.0, 12.0), random.uniform(0.2, 2.0),
                                       random.uniform(1.0, 12.0)),
                       0});
    }
    // Of another light, which comes first: the count of lights says where panes begin.
    shared::Light dark = lamp_at({5.0f, 30.0f, 5.0f}, 0, 0);
    dark.intensity = glm::vec3(1e-6f);
    const std::vector<shared::Light> through{dark, lamp_at({32.0f, 14.0f, 32.0f}, 3, 6, intensity)},
        past{dark, lamp_at({32.0f, 14.0f, 32.0f}, 0, 0, intensity)};
    const std::vector<glm::vec4> without = radiance(night(past, {}), settings, kPicture);
    const FrameInput in = night(through, panes);
    const std::vector<glm::vec4> with = radiance(in, settings, kPicture);
    double error = 0.0;
    int dim = 0, clear = 0;
    for (std::uint32_t i = 0; i < with.size(); i += 13) {
      if (without[i].x <= 0.0f) continue;  // beside the slab
      const auto left = [&](double height) {
        return left_on_way(std::span(panes).subspan(3), place_of(in, i, height),
                           {32.0, 14.0, 32.0});
      };
      const glm::dvec3 upper = left(1.0), lower = lowest < 1.0 ? left(lowest) : upper;
      dim += upper.x < 0.5;
      clear += upper.x > 0.999;
      for (int c = 0; c < 3; ++c) {
        const double seen = double{with[i][c]} / double{without[i][c]};
        error = std::max(
            {error, std::min(upper[c], lower[c]) - seen, seen - std::max(upper[c], lower[c])});
      }
    }
    EXPECT_GT(dim, 5);
    EXPECT_GT(clear, 20);
    return error;
  }

 private:
  std::vector<shared::Light> lights_;
};

TEST_F(LightPanes, ColourLampsAsBeersLawSays) {
  ASSERT_TRUE(renderer().occupancy());
  add(slab, {0, 0, 0}, {1, 1, 1});
  add_occupancy(slab, {0, 0, 0}, {1, 1, 1});
  RandomPlaces random(5);
  RenderSettings per_pixel;
  per_pixel.shading_rate = 1;
  for (const bool every : {false, true}) {
    SCOPED_TRACE(every ? "walls are looked for before all lights" : "before the strongest");
    per_pixel.lights_shadows = every ? kEveryLight : 2;
    for (int scene = 0; scene < 3; ++scene) {
      SCOPED_TRACE(scene);
      EXPECT_LT(largest_error(random, per_pixel, 400.0f), 0.005);
    }
  }
}

/// What a slab of glass sends is what its two sides get.
TEST_F(LightPanes, ColourLampsOnGlassToo) {
  const auto glass = [](int, int y, int) -> world::BlockId {
    return y == 0 ? world::block::kWhiteGlass : world::block::kAirBlock;
  };
  add(glass, {0, 0, 0}, {1, 1, 1});
  add_occupancy(glass, {0, 0, 0}, {1, 1, 1});
  RandomPlaces random(6);
  // So bright that no star counts.
  EXPECT_LT(largest_error(random, {}, 20'000.0f, 0.0), 0.01);
}

TEST_F(LightPanes, NeedNoOtherProgramWhereThereAreNone) {
  add(slab, {0, 0, 0}, {1, 1, 1});
  const std::vector<shared::Light> lights{lamp_at({32.0f, 14.0f, 32.0f}, 0, 0)};
  const std::vector<shared::LightPane> far{
      {glm::vec3(10.0f), world::block::kRedGlass, glm::vec3(12.0f), 0}};
  drawn(night(lights, {}), {}, kPicture);
  const std::vector<std::uint8_t> before = picture();
  EXPECT_EQ(drawn(night(lights, far), {}, kPicture).programs_made, 0);
  EXPECT_EQ(picture(), before);
}

}  // namespace
}  // namespace skerry::render
