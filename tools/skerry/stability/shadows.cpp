// The sun where it is hard to build shadow maps for, and motion too small to see.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/render/frame/celestial.h"
#include "engine/render/light/cascades.h"
#include "game/input/controls.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using render::Cascade;
using render::CascadeInput;

/// Zenith, horizon, below, each axis both ways, the sky's poles, and a hair beside each.
std::vector<glm::dvec3> hard_directions() {
  std::vector<glm::dvec3> out;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 v{0.0};
      v[axis] = sign;
      out.push_back(v);
    }
  out.push_back(render::kCelestialPole);
  out.push_back(-render::kCelestialPole);
  out.push_back({0.6, 0.0, 0.8});     // exactly on the horizon, along no axis
  out.push_back({0.6, -0.001, 0.8});  // below it
  for (std::size_t i = 0, count = out.size(); i < count; ++i)
    for (const double hair : {1e-16, 1e-7})
      out.push_back(glm::normalize(out[i] + glm::dvec3(hair, -2.0 * hair, 0.5 * hair)));
  return out;
}

double non_finite_numbers(const Cascade& cascade) {
  double count = 0.0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      count += !std::isfinite(cascade.clip_from_world[column][row]) +
               !std::isfinite(cascade.clip_from_centre[column][row]);
  for (const glm::vec4& plane : cascade.planes)
    for (int i = 0; i < 4; ++i) count += !std::isfinite(plane[i]);
  return count;
}

Result<Rows> shadow_directions() {
  double non_finite = 0.0, skew = 0.0, left_handed = 0.0;
  for (const glm::dvec3& to_light : hard_directions()) {
    const std::array<glm::dvec3, 3> axes = render::light_axes(to_light);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k <= i; ++k)
        skew = std::max(skew, std::abs(glm::dot(axes[static_cast<std::size_t>(i)],
                                                axes[static_cast<std::size_t>(k)]) -
                                       (i == k ? 1.0 : 0.0)));
    left_handed += glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.5;
    for (const std::int64_t far :
         {std::int64_t{0}, std::int64_t{1} << 56, -(std::int64_t{1} << 56)}) {
      CascadeInput in;
      in.to_light = to_light;
      in.camera = {far, far / 3, -far};
      for (const Cascade& cascade : render::make_cascades(in))
        non_finite += non_finite_numbers(cascade);
    }
  }
  // Rounding of three products and a normalisation each, and the right angle between a cross
  // product and its factors: eight half units in the last place of 1.
  const double rounding = 8.0 * std::ldexp(1.0, -53);
  return Rows{
      {"numbers that are not finite in cascades, sun at zenith, horizon, below, axes, poles", 0.0,
       non_finite},
      {"error of right angles and lengths of the light's axes", rounding, skew},
      {"left-handed axes", 0.0, left_handed}};
}

/// The sun's whole circle in a million places, at each a step of 1e-7 rad.
Result<Rows> continuity() {
  constexpr double kStep = 1e-7;
  const double seconds = kStep / (2.0 * std::numbers::pi) * render::kDaySeconds;
  double most = 0.0;
  constexpr int kPlaces = 1'000'000;
  for (int i = 0; i < kPlaces; ++i) {
    const double time_s = render::kDaySeconds * i / kPlaces;
    const auto before = render::light_axes(render::celestial_at(time_s, 0.5).to_sun);
    const auto after = render::light_axes(render::celestial_at(time_s + seconds, 0.5).to_sun);
    for (std::size_t axis = 0; axis < 3; ++axis)
      most = std::max(most, glm::distance(before[axis], after[axis]));
  }
  // The sun keeps at a right angle to the pole, so no axis turns faster than the sun; the time of
  // day is rounded to 2^-37 s (1e-15 rad), directions to a few 2^-53.
  return Rows{
      {"radians an axis of the light turns while the sun moves by 1e-7 rad", kStep + 4e-15, most}};
}

world::BlockId pillars(int x, int y, int z) {
  const bool pillar = y < 12 && (x & 15) == 3 && (z & 15) == 5;
  return y < 0 || pillar ? world::block::kStone : world::block::kAirBlock;
}

const std::vector<render::IslandPlacement>& shadowed_island() {
  static const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  return islands;
}

Result<std::unique_ptr<Stage>> pillar_stage(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage;
  if (Result<void> added = (*stage)->add(pillars, {-1, -1, -1}, {1, 1, 1}); !added)
    return added.error();
  return stage;
}

render::FrameInput input_of(const render::Celestial& sky) {
  render::FrameInput in;
  in.camera = camera_at({1.3, 4.2, -7.7}, 30.0, -10.0);
  in.islands = shadowed_island();
  in.sky = sky;
  in.reach_blocks = 200.0;
  in.capture = true;
  return in;
}

constexpr VkExtent2D kShadowsSize{96, 54};

render::RenderSettings shadow_settings() {
  render::RenderSettings out;
  out.shadow_size = 512;
  return out;
}

/// The sun as the cases of motion have it.
render::Celestial slanting_sun() {
  return sun_towards({0.4, 0.7, -0.5});
}

/// Whether the pillars are lit and cast shadows: without either, no row of shadows means anything.
Result<bool> shadows_show(Stage& stage) {
  const auto sunlight =
      sunlight_of(stage, input_of(slanting_sun()), shadow_settings(), kShadowsSize);
  if (!sunlight) return sunlight.error();
  return sunlight->lit > 0.0 && sunlight->shadowed > 0.0;
}

Result<Rows> pictures(gpu::Device& device) {
  auto stage = pillar_stage(device);
  if (!stage) return stage.error();
  const auto shown = shadows_show(**stage);
  if (!shown) return shown.error();
  double non_finite = 0.0, out_of_range = 0.0, without_maps = 0.0;
  for (const glm::dvec3& to_sun : hard_directions()) {
    const auto frame =
        (*stage)->draw(input_of(sun_towards(to_sun)), shadow_settings(), kShadowsSize);
    if (!frame) return frame.error();
    non_finite += non_finite_channels(frame->radiance) + frame->report.pixels.non_finite;
    for (const float depth : frame->shadow_maps) out_of_range += !(depth >= 0.0f && depth <= 1.0f);
    // A sun above the horizon has maps, and something stands in them.
    without_maps += to_sun.y > 0.01 && std::ranges::none_of(frame->shadow_maps, [](float depth) {
                      return depth > 0.0f && depth < 1.0f;
                    });
  }
  return Rows{{"channels or pixels not finite, sun at zenith, horizon, below, axes, poles", 0.0,
               if_shown(*shown, non_finite)},
              {"shadow texels outside 0..1, sun at zenith, horizon, below, axes, poles", 0.0,
               if_shown(*shown, out_of_range)},
              {"suns above the horizon whose shadow maps are empty", 0.0, without_maps}};
}

/// What changes in the shadow maps over frames of a motion that must not show.
struct Change {
  double texels = 0.0, redrawn = 0.0;
};
Result<Change> change_over(Stage& stage, int frames, bool afresh,
                           const std::function<render::FrameInput(int frame)>& input) {
  Change change;
  std::vector<float> first;
  for (int i = 0; i < frames; ++i) {
    if (afresh) stage.renderer().invalidate_shadows();
    const auto frame = stage.draw(input(i), shadow_settings(), kShadowsSize);
    if (!frame) return frame.error();
    if (i == 0) first = frame->shadow_maps;
    if (frame->shadow_maps.empty() || frame->shadow_maps.size() != first.size())
      return Error{"there are no shadow maps to compare"};
    if (i == 0) continue;
    for (std::size_t k = 0; k < first.size(); ++k)
      change.texels += first[k] != frame->shadow_maps[k];
    for (const std::string& pass : stage.renderer().graph().pass_names())
      change.redrawn += pass.starts_with("draw_shadow");
  }
  return change;
}

/// The camera moves by 1/64 of the smallest texel a frame, for 32 frames.
Result<Rows> camera_motion(gpu::Device& device) {
  auto stage = pillar_stage(device);
  if (!stage) return stage.error();
  const render::Celestial sky = slanting_sun();
  const auto shown = shadows_show(**stage);
  if (!shown) return shown.error();
  CascadeInput in;
  in.far_blocks = input_of(sky).reach_blocks;
  in.map_size = shadow_settings().shadow_size;
  const double texel = static_cast<double>(render::make_cascades(in)[0].texel_blocks);
  const auto input = [&](int frame) {
    render::FrameInput moved_input = input_of(sky);
    moved_input.camera.position =
        moved(moved_input.camera.position, texel / 64.0 * frame * glm::dvec3(0.6, 0.3, 0.74));
    return moved_input;
  };
  const auto afresh = change_over(**stage, 32, true, input);
  if (!afresh) return afresh.error();
  const auto kept = change_over(**stage, 32, false, input);
  if (!kept) return kept.error();
  return Rows{{"shadow texels changed, camera moving 1/64 texel in each of 32 frames, drawn afresh",
               0.0, if_shown(*shown && afresh->redrawn > 0.0, afresh->texels)},
              {"shadow maps drawn again while the camera moves by less than a texel", 0.0,
               if_shown(*shown && afresh->redrawn > 0.0, kept->redrawn)}};
}

/// The sun moves by 1e-7 rad a frame, as the clock of play turns it.
Result<Rows> sun_motion(gpu::Device& device) {
  auto stage = pillar_stage(device);
  if (!stage) return stage.error();
  const auto shown = shadows_show(**stage);
  if (!shown) return shown.error();
  constexpr double kStep = 1e-7 / (2.0 * std::numbers::pi) * render::kDaySeconds;
  double texels = 0.0, redrawn = 0.0, drawn = 0.0;
  for (const bool afresh : {true, false}) {
    game::DayClock clock(9 * 3600);
    const auto input = [&](int) {
      clock.turn(kStep);
      return input_of(render::celestial_at(clock.time_of_day_s(), 0.5));
    };
    const auto change = change_over(**stage, 64, afresh, input);
    if (!change) return change.error();
    texels += change->texels;
    (afresh ? drawn : redrawn) = change->redrawn;
  }
  const bool moved = *shown && drawn > 0.0;
  return Rows{{"shadow texels changed, sun moving 1e-7 rad in each of 64 frames", 0.0,
               if_shown(moved, texels)},
              {"shadow maps drawn again, sun moving 1e-7 rad in each of 64 frames", 0.0,
               if_shown(moved, redrawn)}};
}

constexpr Case kShadowsCases[] = {{"shadows.directions", shadow_directions},
                                  {"shadows.continuity", continuity},
                                  {"shadows.pictures", pictures},
                                  {"shadows.camera_motion", camera_motion},
                                  {"shadows.sun_motion", sun_motion}};

}  // namespace

std::span<const Case> shadows_cases() {
  return kShadowsCases;
}

}  // namespace skerry::tools::stability
