// Lights from a hundred-millionth of the sun to a hundred million suns.
#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "engine/render/light/lights.h"
#include "game/view/materials.h"
#include "tools/measure/color.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using world::block::kAirBlock;
using world::block::kLamp;
using world::block::kStone;

constexpr VkExtent2D kLightSize{96, 54};

world::BlockId floor_with_pillars(int x, int y, int z) {
  return y < 0 || (y < 6 && x % 7 == 0 && z % 9 == 0) ? kStone : kAirBlock;
}

render::FrameInput input_of(std::span<const render::IslandPlacement> islands) {
  render::FrameInput in;
  in.camera = camera_at({30.5, 5.0, 2.5}, 0.0, -15.0);
  in.islands = islands;
  in.capture = true;
  return in;
}

/// Of a pixel of a picture, as 8 bits would encode it.
double luminance_of(const std::uint8_t* rgba) {
  const auto& linear = measure::linear_of_bytes();
  const glm::dvec3 colour{linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]};
  return 255.0 * measure::srgb_from_linear(measure::luminance(colour));
}

/// How often a brighter light makes a channel of radiance or a pixel's luminance darker, and what
/// is not finite on the way. A channel of the picture may fall, as what is brighter than white
/// takes its colour (docs/exposure.md); luminance may by one step, where that channel alone is
/// rounded.
struct Course {
  double falls = 0.0, non_finite = 0.0;
  double rises = 0.0;  ///< channels of radiance that were made brighter: what must not be none
  std::vector<glm::vec3> last;
  std::vector<std::uint8_t> last_picture;

  void follow(const Frame& frame) {
    non_finite += non_finite_channels(frame.radiance) + frame.report.pixels.non_finite;
    for (std::size_t i = 0; i < last.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        falls += frame.radiance[i][c] < last[i][c];
        // By more than half: a decade brighter, and no longer lost in what else is there.
        rises += frame.radiance[i][c] > 1.5f * last[i][c];
      }
    for (std::size_t i = 0; i < last_picture.size(); i += 4)
      falls += luminance_of(&frame.rgba[i]) < luminance_of(&last_picture[i]) - 1.0;
    last = frame.radiance;
    last_picture = frame.rgba;
  }
};

Result<Rows> sun(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  if (Result<void> added = (*stage)->add(floor_with_pillars, {0, -1, 0}, {1, 1, 1}); !added)
    return added.error();
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  render::FrameInput noon = input_of(islands);
  noon.sky = sun_towards({0.4, 0.8, -0.3});
  const auto sunlight = sunlight_of(**stage, noon, {}, kLightSize);
  if (!sunlight) return sunlight.error();
  Course course;
  for (int decade = -8; decade <= 8; ++decade) {
    render::FrameInput in = noon;
    // A sky that does not change: only the light on surfaces does.
    in.sky.sun_irradiance *= static_cast<float>(std::pow(10.0, decade));
    const auto frame = (*stage)->draw(in, {}, kLightSize);
    if (!frame) return frame.error();
    course.follow(*frame);
  }
  // Each lit surface rises in most of the decades; one is enough to tell that it is lit.
  const bool shown = sunlight->lit > 0.0 && course.rises > sunlight->lit;
  return Rows{{"channels that a brighter sun darkens, irradiance times 1e-8 to 1e8", 0.0,
               if_shown(shown, course.falls)},
              {"channels or pixels not finite, sun times 1e-8 to 1e8", 0.0,
               if_shown(shown, course.non_finite)}};
}

/// A wall of lamps at night: its radiance is albedo times emission and nothing else.
Result<Rows> emission(gpu::Device& device) {
  Course course;
  double off = 0.0, dark_albedo = 0.0;
  std::vector<glm::vec3> albedo;
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  for (const double emitted : {1.0, 6.0e-8, 1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 65504.0}) {
    std::vector<shared::Material> table = game::material_table();
    table[kLamp].emission = glm::packHalf1x16(static_cast<float>(emitted));
    const double exact =
        static_cast<double>(glm::unpackHalf1x16(static_cast<std::uint16_t>(table[kLamp].emission)));
    auto stage = Stage::create(device, table);
    if (!stage) return stage.error();
    const auto wall = [](int, int, int z) { return z >= 10 ? kLamp : kAirBlock; };
    if (Result<void> added = (*stage)->add(wall, {0, -1, 0}, {1, 1, 1}); !added)
      return added.error();
    render::FrameInput in = input_of(islands);
    in.sky = darkness();
    const auto frame = (*stage)->draw(in, {}, kLightSize);
    if (!frame) return frame.error();
    if (albedo.empty()) {  // an emission of 1 shows the albedo
      albedo = frame->radiance;
      for (const glm::vec3& a : albedo) dark_albedo += std::max({a.x, a.y, a.z}) < 1.0f / 64.0f;
      continue;
    }
    course.follow(*frame);
    for (std::size_t i = 0; i < albedo.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double wanted = static_cast<double>(albedo[i][c]) * exact;
        // A half's rounding, twice: 2^-11 relative, or half of the smallest step below 2^-14.
        const double allowed = std::max(wanted, std::ldexp(1.0, -14)) * std::ldexp(1.0, -10);
        off =
            std::max(off, std::abs(static_cast<double>(frame->radiance[i][c]) - wanted) / allowed);
      }
  }
  const bool shown = dark_albedo == 0.0 && course.rises > 0.0;
  return Rows{{"error of a lamp's radiance over two roundings, emission 6e-8 to 65504", 1.0,
               if_shown(shown, off)},
              {"pixels of lamps that are almost black, emission 1", 0.0, dark_albedo},
              {"channels that a brighter lamp darkens", 0.0, if_shown(shown, course.falls)},
              {"channels or pixels not finite, lamps 6e-8 to 65504", 0.0,
               if_shown(shown, course.non_finite)}};
}

shared::Light lamp(std::uint32_t kind, float intensity, float range) {
  shared::Light light{};
  light.kind = kind;
  light.position = {1.0f, -2.0f, 6.0f};
  light.range = range;
  light.intensity = glm::vec3(intensity);
  light.axis = {0.0f, -1.0f, 0.3f};
  light.size = 0.5f;
  light.cos_inner = 0.9f;
  light.cos_outer = 0.2f;
  return light;
}

/// Draws frames at night, each under a light of its own that is to be no darker than the last.
Result<Course> follow_lights(gpu::Device& device, const std::vector<shared::Light>& asked) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  if (Result<void> added = (*stage)->add(floor_with_pillars, {0, -1, 0}, {1, 1, 1}); !added)
    return added.error();
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  Course course;
  for (const shared::Light& one : asked) {
    const Result<shared::Light> light = render::checked_light(one);
    if (!light) return light.error();
    render::FrameInput in = input_of(islands);
    in.sky = darkness();
    in.lights = std::span<const shared::Light>(&*light, 1);
    const auto frame = (*stage)->draw(in, {}, kLightSize);
    if (!frame) return frame.error();
    course.follow(*frame);
  }
  return course;
}

Result<Rows> lamps(gpu::Device& device) {
  Course by_intensity, by_range;
  double unlit_kinds = 0.0;
  for (std::uint32_t kind = 0; kind < shared::kLightKindCount; ++kind) {
    std::vector<shared::Light> brighter, wider;
    for (int decade = -8; decade <= 8; decade += 2)
      brighter.push_back(lamp(kind, static_cast<float>(std::pow(10.0, decade)), 20.0f));
    for (int decade = -6; decade <= 6; decade += 2)
      wider.push_back(lamp(kind, 1.0f, static_cast<float>(std::pow(10.0, decade))));
    const Result<Course> intensities = follow_lights(device, brighter);
    if (!intensities) return intensities.error();
    const Result<Course> ranges = follow_lights(device, wider);
    if (!ranges) return ranges.error();
    by_intensity.falls += intensities->falls;
    by_intensity.non_finite += intensities->non_finite;
    by_range.falls += ranges->falls;
    by_range.non_finite += ranges->non_finite;
    // A directional light's range says where it ends, not how bright it is.
    const bool by_distance = kind != shared::kLightDirectional;
    unlit_kinds += intensities->rises == 0.0 || (by_distance && ranges->rises == 0.0);
  }
  const bool shown = unlit_kinds == 0.0;
  return Rows{{"channels that a brighter light darkens, five kinds, 1e-8 to 1e8", 0.0,
               if_shown(shown, by_intensity.falls)},
              {"channels or pixels not finite, lights 1e-8 to 1e8", 0.0,
               if_shown(shown, by_intensity.non_finite)},
              {"channels that a longer range darkens, 1e-6 to 1e6 blocks", 0.0,
               if_shown(shown, by_range.falls)},
              {"channels or pixels not finite, ranges 1e-6 to 1e6 blocks", 0.0,
               if_shown(shown, by_range.non_finite)},
              {"kinds of light that brighten nothing", 0.0, unlit_kinds}};
}

/// Every light of a million reaches every pixel.
Result<Rows> million_lamps(gpu::Device& device) {
  constexpr VkExtent2D kFewPixels{32, 18};
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  if (Result<void> added = (*stage)->add(floor_with_pillars, {0, -1, 0}, {1, 1, 1}); !added)
    return added.error();
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  const std::vector<shared::Light> lights(1000000, lamp(shared::kLightPoint, 1e4f, 500.0f));
  render::FrameInput in = input_of(islands);
  in.sky = darkness();
  in.lights = lights;
  double non_finite = 0.0, dark = 0.0;
  for (int frame_index = 0; frame_index < 2; ++frame_index) {  // lists fit the second at best
    const auto frame = (*stage)->draw(in, {}, kFewPixels);
    if (!frame) return frame.error();
    non_finite += non_finite_channels(frame->radiance) + frame->report.pixels.non_finite;
    if (frame->radiance[kFewPixels.width * kFewPixels.height - 1] == glm::vec3(0.0f)) ++dark;
  }
  return Rows{{"channels or pixels not finite, a million lights in a pixel", 0.0,
               if_shown(dark == 0.0, non_finite)},
              {"frames that a million lights leave dark", 0.0, dark}};
}

constexpr Case kLightCases[] = {{"light.sun", sun},
                                {"light.emission", emission},
                                {"light.lamps", lamps},
                                {"light.million_lamps", million_lamps}};

}  // namespace

std::span<const Case> light_cases() {
  return kLightCases;
}

}  // namespace skerry::tools::stability
