// A seed's world, seen from its middle and from the ends of what coordinates can hold.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/gpu/transfer/readback.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using Offset = std::array<std::int64_t, 3>;

game::SceneOptions scene_at(const Offset& offset) {
  game::SceneOptions scene;
  scene.seed_text = "1";
  scene.size = {160, 90};
  scene.quality = game::Quality::kLow;
  scene.settings = game::settings_of(scene.quality);
  scene.settings.view_distance = 160;
  scene.settings.world_offset = offset;
  return scene;
}

/// Whether the sun lights the ground before the feet at noon: a quarter of the lowest rows of a
/// picture without any other light.
Result<bool> sun_lights_ground(gpu::Device& device, game::SceneCache& cache) {
  game::SceneOptions scene = scene_at({});
  render::RenderSettings& settings = scene.settings.render;
  settings = without_sky_light(settings);
  for (const render::Feature other :
       {render::Feature::kMoon, render::Feature::kLights, render::Feature::kWater})
    settings.leave_out.add(other);
  scene.time_of_day_s = 12 * 3600;
  Result<std::unique_ptr<SceneDrawer>> drawer = SceneDrawer::create(device, scene, &cache);
  if (!drawer) return drawer.error();
  const Result<Drawn> drawn = (*drawer)->draw();
  if (!drawn) return drawn.error();
  const std::vector<std::uint8_t>& rgba = drawn->rgba;
  constexpr std::uint32_t kRows = 10;
  const game::PictureSize size = scene.size;
  const std::size_t first = std::size_t{size.height - kRows} * size.width * 4;
  double lit = 0.0;
  for (std::size_t i = first; i + 4 <= rgba.size(); i += 4)
    lit += std::max({rgba[i], rgba[i + 1], rgba[i + 2]}) >= 32;
  return lit >= 0.25 * kRows * size.width;
}

/// A picture of the seed's spawn in a world that is moved by `offset`, by day and by moonlight.
Result<std::vector<std::vector<std::uint8_t>>> pictures_at(gpu::Device& device,
                                                           game::SceneCache& cache,
                                                           const Offset& offset) {
  const game::SceneOptions scene = scene_at(offset);
  Result<std::unique_ptr<SceneDrawer>> drawer = SceneDrawer::create(device, scene, &cache);
  if (!drawer) return drawer.error();
  game::SceneView& view = (*drawer)->view();
  std::vector<std::vector<std::uint8_t>> out;
  for (const double time_of_day_s : {12 * 3600.0, 18 * 3600.0, 0.0}) {
    Result<std::vector<std::uint8_t>> picture = drawn_picture(
        device, view, {view.start_camera(), time_of_day_s}, {scene.size.width, scene.size.height});
    if (!picture) return picture.error();
    if (view.renderer().report()->camera.quads == 0) return Error{"the spawn view shows no block"};
    out.push_back(*std::move(picture));
  }
  return out;
}

Result<Rows> far_away(gpu::Device& device) {
  game::SceneCache cache(device);  // light is found in an island's lattice, wherever that is
  const auto shown = sun_lights_ground(device, cache);
  if (!shown) return shown.error();
  const auto at_origin = pictures_at(device, cache, {});
  if (!at_origin) return at_origin.error();
  constexpr std::int64_t k24 = std::int64_t{1} << 24, k40 = std::int64_t{1} << 40;
  const std::array<std::pair<const char*, Offset>, 5> places{
      {{"2^24", {k24, k24, k24}},
       {"-2^24", {-k24, -k24, -k24}},
       {"2^40", {k40, k40, k40}},
       {"-2^40", {-k40, -k40, -k40}},
       {"2^40, -3, -2^40", {k40, -3, -k40}}}};
  Rows rows;
  for (const auto& [name, offset] : places) {
    const auto moved = pictures_at(device, cache, offset);
    if (!moved) return moved.error();
    double different = 0.0;
    for (std::size_t i = 0; i < moved->size(); ++i)
      different += different_pixels((*moved)[i], (*at_origin)[i]);
    rows.push_back({std::string("pixels unlike those at 0, camera, world at ") + name +
                        " blocks, noon, dusk, moon",
                    0.0, if_shown(*shown, different)});
  }
  return rows;
}

/// Pictures from a camera that moves by `step` blocks a frame.
Result<std::vector<std::vector<std::uint8_t>>> sequence(gpu::Device& device,
                                                        game::SceneCache& cache,
                                                        const Offset& offset, double step,
                                                        int frames) {
  const game::SceneOptions scene = scene_at(offset);
  Result<std::unique_ptr<SceneDrawer>> drawer = SceneDrawer::create(device, scene, &cache);
  if (!drawer) return drawer.error();
  game::SceneView& view = (*drawer)->view();
  std::vector<std::vector<std::uint8_t>> out;
  for (int i = 0; i < frames; ++i) {
    game::SceneView::Moment moment;
    moment.camera = view.start_camera();
    moment.camera.position = moved(moment.camera.position, step * i * glm::dvec3(1.0, 0.5, -0.7));
    moment.camera.yaw_deg += 0.01 * i;
    if (Result<std::uint64_t> drawn = view.draw(moment, {scene.size.width, scene.size.height});
        !drawn)
      return drawn.error();
    view.renderer().finish();
    Result<std::vector<std::byte>> bytes = gpu::read_back(device, view.renderer().picture(), 4);
    if (!bytes) return bytes.error();
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes->data());
    out.emplace_back(first, first + bytes->size());
  }
  if (out.front() == out.back()) return Error{"the camera's motion does not show"};
  return out;
}

Result<Rows> jitter(gpu::Device& device) {
  game::SceneCache cache(device);  // light is found in an island's lattice, wherever that is
  const auto shown = sun_lights_ground(device, cache);
  if (!shown) return shown.error();
  constexpr std::int64_t k40 = std::int64_t{1} << 40;
  constexpr int kFrames = 32;
  Rows rows;
  for (const double step : {0.001, 1.0 / static_cast<double>(world::kUnitsPerBlock)}) {
    const auto near = sequence(device, cache, {}, step, kFrames);
    if (!near) return near.error();
    const auto far = sequence(device, cache, {k40, -k40, k40}, step, kFrames);
    if (!far) return far.error();
    double different = 0.0;
    for (std::size_t i = 0; i < near->size(); ++i)
      different += different_pixels((*near)[i], (*far)[i]);
    rows.push_back({std::string("pixels of 32 frames unlike those at 0, at 2^40, camera moving ") +
                        (step == 0.001 ? "0.001 block" : "1/65536 block") + " a frame",
                    0.0, if_shown(*shown, different)});
  }
  return rows;
}

constexpr Case kCoordinatesCases[] = {{"coordinates.far_away", far_away},
                                      {"coordinates.jitter", jitter}};

}  // namespace

std::span<const Case> coordinates_cases() {
  return kCoordinatesCases;
}

}  // namespace skerry::tools::stability
