// Numbers that are none, put into one texel or one table entry: they must stay where they are.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "engine/render/air/air.h"
#include "engine/render/air/sky_scattering.h"
#include "engine/render/sky/sky_model.h"
#include "game/view/materials.h"
#include "shaders/shared/sky.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using render::Fault;
using render::FrameInput;
using world::block::kAirBlock;
using world::block::kGlass;
using world::block::kLamp;
using world::block::kStone;

constexpr VkExtent2D kFiniteSize{160, 90};
constexpr float kBroken[] = {std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity(),
                             std::numeric_limits<float>::quiet_NaN()};

/// A floor, a lamp on it, and a pane of glass before it all.
world::BlockId finite_room(int x, int y, int z) {
  if (y < 0) return kStone;
  if (z == 6 && y < 8 && x >= 20 && x < 28) return kGlass;
  return x == 24 && y == 0 && z == 20 ? kLamp : kAirBlock;
}

const std::vector<render::IslandPlacement>& finite_island() {
  static const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  return islands;
}

FrameInput input_of(bool capture = true) {
  FrameInput in;
  in.camera = camera_at({24.5, 3.0, 1.5}, 0.0, -4.0);
  in.islands = finite_island();
  in.sky = sun_towards({0.4, 0.8, -0.5});
  in.exposure_ev = -0.5f;
  in.capture = capture;
  return in;
}

Result<std::unique_ptr<Stage>> room_stage(gpu::Device& device,
                                          std::span<const shared::Material> materials = {}) {
  auto stage = Stage::create(device, materials);
  if (!stage) return stage;
  if (Result<void> added = (*stage)->add(finite_room, {0, -1, 0}, {1, 1, 1}); !added)
    return added.error();
  return stage;
}

/// How far a fault got, against the same frame without it.
struct Damage {
  double non_finite = 0.0;  ///< channels of radiance
  double outside = 0.0;     ///< pixels that differ although nothing they read was broken
  double inside = 0.0;      ///< pixels that differ and may
};

void compare(const Frame& clean, const Frame& broken,
             const std::function<bool(std::uint32_t x, std::uint32_t y)>& may_differ,
             Damage& damage) {
  for (std::uint32_t y = 0; y < clean.size.height; ++y)
    for (std::uint32_t x = 0; x < clean.size.width; ++x) {
      const std::size_t i = std::size_t{y} * clean.size.width + x;
      const bool same = std::equal(&clean.rgba[4 * i], &clean.rgba[4 * i] + 4, &broken.rgba[4 * i]);
      if (!same) ++(may_differ(x, y) ? damage.inside : damage.outside);
    }
}

Rows rows_of(const std::string& what, const Damage& damage) {
  // A fault that shows nowhere has not been put in: that proves nothing.
  const bool shown = damage.inside > 0.0;
  return {{"channels not finite, " + what, 0.0, if_shown(shown, damage.non_finite)},
          {"pixels damaged out of reach, " + what, 0.0, if_shown(shown, damage.outside)}};
}

/// Radiance before glass is looked through, and after: one pixel each.
Result<Rows> radiance(gpu::Device& device) {
  auto stage = room_stage(device);
  if (!stage) return stage.error();
  const auto clean = (*stage)->draw(input_of(), {}, kFiniteSize);
  if (!clean) return clean.error();
  Rows rows;
  for (const auto& [in, what] :
       {std::pair{Fault::In::kShaded, "a texel of radiance behind glass"},
        std::pair{Fault::In::kLookedThrough, "a texel of radiance before it is developed"}}) {
    Damage damage;
    for (const float value : kBroken) {
      const glm::uvec2 texel{80, 44};
      FrameInput broken = input_of();
      broken.fault = Fault{in, texel, value};
      const auto frame = (*stage)->draw(broken, {}, kFiniteSize);
      if (!frame) return frame.error();
      compare(
          *clean, *frame, [&](auto x, auto y) { return x == texel.x && y == texel.y; }, damage);
      // Behind glass the pass must mend it. Developing ends in eight bits, which are always finite.
      if (in == Fault::In::kShaded) damage.non_finite += non_finite_channels(frame->radiance);
    }
    const Rows more = rows_of(std::string(what) + ", +-Inf, NaN", damage);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  rows.erase(rows.begin() + 2);  // the developed picture has no radiance
  return rows;
}

/// Radiance before bloom is taken from it: what is no number must not glow.
Result<Rows> bloom(gpu::Device& device) {
  auto stage = room_stage(device);
  if (!stage) return stage.error();
  render::RenderSettings settings;
  settings.bloom = {1.0f, 1.0f, 6};
  const glm::uvec2 texel{80, 44};
  FrameInput input = input_of();
  // The texel is black in the frame to compare with, so that its own light is not missed about it.
  input.fault = Fault{Fault::In::kLookedThrough, texel, 0.0f};
  const auto clean = (*stage)->draw(input, settings, kFiniteSize);
  if (!clean) return clean.error();
  Damage damage;
  // The same texel, blinding, must glow on others, or there is no bloom to be damaged.
  Damage glow;
  input.fault->value = 1e4f;
  const auto glowing = (*stage)->draw(input, settings, kFiniteSize);
  if (!glowing) return glowing.error();
  compare(
      *clean, *glowing, [&](auto x, auto y) { return x != texel.x || y != texel.y; }, glow);
  for (const float value : kBroken) {
    input.fault->value = value;
    const auto frame = (*stage)->draw(input, settings, kFiniteSize);
    if (!frame) return frame.error();
    compare(
        *clean, *frame, [&](auto x, auto y) { return x == texel.x && y == texel.y; }, damage);
  }
  // Nothing at all may differ, not even the pixel: black it was, and as black it is developed.
  return Rows{{"pixels damaged, a texel of radiance before bloom, +-Inf, NaN", 0.0,
               if_shown(glow.inside > 0.0, damage.outside + damage.inside)}};
}

/// Place of a direction in the sky's table [texels, centres at whole numbers]. @param horizon [rad]
glm::dvec2 sky_table_place(const glm::dvec3& ray, double horizon) {
  const glm::dvec3 dir = glm::normalize(ray);
  const double azimuth = std::atan2(dir.x, dir.z) / (2.0 * M_PI);
  const double v = render::sky_row_place(std::asin(std::clamp(dir.y, -1.0, 1.0)), horizon);
  return {(0.5 + azimuth) * (shared::kSkyLutWidth - 1.0), v * (shared::kSkyLutHeight - 1.0)};
}

/// A broken texel of the sky's table: pixels of sky whose bilinear footprint holds it, and pixels
/// of surfaces, whose haze has the colour of the sky behind them.
Result<Rows> sky_table(gpu::Device& device) {
  Rows rows;
  for (const bool with_ground : {true, false}) {
    auto stage = Stage::create(device);
    if (!stage) return stage.error();
    const auto floor = [](int, int y, int) { return y < 0 ? kStone : kAirBlock; };
    if (with_ground)
      if (Result<void> added = (*stage)->add(floor, {0, -1, 0}, {1, 0, 1}); !added)
        return added.error();
    const auto clean = (*stage)->draw(input_of(), {}, kFiniteSize);
    if (!clean) return clean.error();
    Damage damage;
    const FrameInput in = input_of();
    const double horizon = std::asin(render::horizon_sine(render::eye_height_km(in)));
    for (const float value : kBroken) {
      for (const glm::uvec2 pixel : {glm::uvec2{30, 20}, glm::uvec2{80, 38}, glm::uvec2{100, 70}}) {
        const glm::dvec2 place =
            sky_table_place(ray_of(in.camera, kFiniteSize, pixel.x, pixel.y), horizon);
        const glm::uvec2 texel(glm::round(place));
        FrameInput broken = in;
        broken.fault = Fault{Fault::In::kSkyTable, texel, value};
        const auto frame = (*stage)->draw(broken, {}, kFiniteSize);
        if (!frame) return frame.error();
        damage.non_finite += non_finite_channels(frame->radiance);
        // Filters weigh places in steps of 1/256 texel, and a weight of 0 still hands a NaN on.
        const double reach = 1.0 + 1.0 / 256.0;
        const auto touches = [&](std::uint32_t x, std::uint32_t y) {
          const glm::dvec2 at = sky_table_place(ray_of(in.camera, kFiniteSize, x, y), horizon);
          return std::abs(at.x - texel.x) <= reach && std::abs(at.y - texel.y) <= reach;
        };
        compare(*clean, *frame, touches, damage);
      }
    }
    const std::string what = std::string("a texel of the sky's table, ") +
                             (with_ground ? "sky and ground" : "sky alone") + ", +-Inf, NaN";
    const Rows more = rows_of(what, damage);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

/// Broken entries of the material table: only pixels that show or look through the block may care.
Result<Rows> materials(gpu::Device& device) {
  const std::vector<shared::Material> good = game::material_table();
  auto clean_stage = room_stage(device, good);
  if (!clean_stage) return clean_stage.error();
  const auto clean = (*clean_stage)->draw(input_of(), {}, kFiniteSize);
  if (!clean) return clean.error();
  Damage emission, medium;
  for (const float value : kBroken) {
    std::vector<shared::Material> table = good;
    table[kLamp].emission = glm::packHalf1x16(value);
    auto stage = room_stage(device, table);
    if (!stage) return stage.error();
    const auto lamp = (*stage)->draw(input_of(), {}, kFiniteSize);
    if (!lamp) return lamp.error();
    emission.non_finite += non_finite_channels(lamp->radiance);
    compare(
        *clean, *lamp,
        [&](auto x, auto y) {
          return shared::surface_block(clean->words[std::size_t{y} * kFiniteSize.width + x]) ==
                 kLamp;
        },
        emission);

    table = good;
    table[kGlass].absorption = glm::vec3(value);
    table[kGlass].scattering = value;
    table[kGlass].roughness = value;
    stage = room_stage(device, table);
    if (!stage) return stage.error();
    const auto glass = (*stage)->draw(input_of(), {}, kFiniteSize);
    if (!glass) return glass.error();
    medium.non_finite += non_finite_channels(glass->radiance);
    // The pane's front is at z = 6, its back at z = 7, x 20 to 28, y 0 to 8; a pixel more for its
    // edges.
    compare(
        *clean, *glass,
        [&](auto x, auto y) {
          const glm::dvec3 eye{24.5, 3.0, 1.5}, ray = ray_of(input_of().camera, kFiniteSize, x, y);
          const glm::dvec3 front = eye + ray * (4.5 / ray.z), back = eye + ray * (5.5 / ray.z);
          const double pixel = 0.1;
          return std::max(front.x, back.x) > 20.0 - pixel &&
                 std::min(front.x, back.x) < 28.0 + pixel && std::max(front.y, back.y) > -pixel &&
                 std::min(front.y, back.y) < 8.0 + pixel;
        },
        medium);
  }
  Rows rows = rows_of("a lamp's emission of +-Inf, NaN", emission);
  const Rows more = rows_of("absorption and roughness of glass of +-Inf, NaN", medium);
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

constexpr Case kFiniteCases[] = {{"finite.radiance", radiance},
                                 {"finite.bloom", bloom},
                                 {"finite.sky_table", sky_table},
                                 {"finite.materials", materials}};

}  // namespace

std::span<const Case> finite_cases() {
  return kFiniteCases;
}

}  // namespace skerry::tools::stability
