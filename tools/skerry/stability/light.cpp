// Lights from a hundred-millionth of the sun to a hundred million suns.
#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "game/materials.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using world::block::kAirBlock;
using world::block::kLamp;
using world::block::kStone;

constexpr VkExtent2D kSize{96, 54};

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

/// How often a brighter light makes a channel darker, and what is not finite on the way.
struct Course {
  double falls = 0.0, non_finite = 0.0;
  std::vector<glm::vec3> last;
  std::vector<std::uint8_t> last_picture;

  void follow(const Frame& frame) {
    non_finite += non_finite_channels(frame.radiance) + frame.report.pixels.non_finite;
    for (std::size_t i = 0; i < last.size(); ++i)
      for (int c = 0; c < 3; ++c) falls += frame.radiance[i][c] < last[i][c];
    for (std::size_t i = 0; i < last_picture.size(); ++i) falls += frame.rgba[i] < last_picture[i];
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
  Course course;
  for (int decade = -8; decade <= 8; ++decade) {
    render::FrameInput in = input_of(islands);
    // A sky that does not change: only the light on surfaces does.
    in.sky = sun_towards({0.4, 0.8, -0.3});
    in.sky.sun_irradiance *= static_cast<float>(std::pow(10.0, decade));
    const auto frame = (*stage)->draw(in, {}, kSize);
    if (!frame) return frame.error();
    course.follow(*frame);
  }
  return Rows{
      {"channels that a brighter sun darkens, irradiance times 1e-8 to 1e8", 0.0, course.falls},
      {"channels or pixels not finite, sun times 1e-8 to 1e8", 0.0, course.non_finite}};
}

/// A wall of lamps at night: its radiance is albedo times emission and nothing else.
Result<Rows> emission(gpu::Device& device) {
  Course course;
  double off = 0.0;
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
    const auto frame = (*stage)->draw(in, {}, kSize);
    if (!frame) return frame.error();
    if (albedo.empty()) {  // an emission of 1 shows the albedo
      albedo = frame->radiance;
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
  return Rows{{"error of a lamp's radiance over two roundings, emission 6e-8 to 65504", 1.0, off},
              {"channels that a brighter lamp darkens", 0.0, course.falls},
              {"channels or pixels not finite, lamps 6e-8 to 65504", 0.0, course.non_finite}};
}

constexpr Case kCases[] = {{"light.sun", sun}, {"light.emission", emission}};

}  // namespace

std::span<const Case> light_cases() {
  return kCases;
}

}  // namespace skerry::tools::stability
