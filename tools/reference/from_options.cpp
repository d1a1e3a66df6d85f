#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "engine/render/celestial.h"
#include "engine/render/sky_model.h"
#include "game/light_setup.h"
#include "game/open_world.h"
#include "game/player.h"
#include "tools/reference/reference.h"
#include "tools/reference/tracer.h"
#include "world/march.h"
#include "world/stream.h"
#include "world/world.h"

namespace skerry::reference {
namespace {

using world::BlockId;
using world::IVec3;

/// A picture and its errors take 24 bytes a pixel.
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 26;

game::CameraPlace camera_place(const game::SceneOptions& options, const world::World& world) {
  if (options.camera) return *options.camera;
  const world::Spawn spawn = world.spawn();
  return {world::moved(spawn.feet, {0.0, game::kEyeHeight, 0.0}), spawn.yaw_deg, spawn.pitch_deg};
}

View view_of(const game::SceneOptions& options, const game::CameraPlace& camera) {
  const double yaw = glm::radians(camera.yaw_deg), pitch = glm::radians(camera.pitch_deg);
  View view;
  view.forward = {std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                  std::cos(yaw) * std::cos(pitch)};
  view.right = {-std::cos(yaw), 0.0, std::sin(yaw)};
  view.up = glm::cross(view.right, view.forward);
  view.tan_half_y = std::tan(0.5 * glm::radians(options.fov_deg));
  view.width = options.size.width;
  view.height = options.size.height;
  return view;
}

/// The islands that are drawn: as the streamer takes them in for a first view.
std::vector<world::IslandSpec> specs_of(const world::World& world,
                                        const game::SceneOptions& options, world::WorldPos camera) {
  std::vector<world::IslandSpec> specs =
      world.islands_near(camera, options.settings.view_distance, options.settings.world_time_s);
  if (specs.size() > world::kMaxStreamedIslands) specs.resize(world::kMaxStreamedIslands);
  return specs;
}

std::vector<Island> islands_of(world::World& world, std::span<const world::IslandSpec> specs,
                               world::WorldPos camera, double time_s) {
  std::vector<Island> islands;
  for (const world::IslandSpec& spec : specs) {
    const world::Pose pose = *world.pose(spec.id, time_s);
    islands.push_back({world::Volume::of_island(world, spec), glm::mat3_cast(pose.rotation),
                       world::difference_blocks(pose.origin, camera)});
  }
  return islands;
}

std::vector<game::PlacedIsland> placed(std::span<const world::IslandSpec> specs,
                                       std::span<const Island> islands) {
  std::vector<game::PlacedIsland> out;
  for (std::size_t i = 0; i < islands.size(); ++i)
    out.push_back({specs[i].id, static_cast<std::uint32_t>(i), islands[i].rotation,
                   islands[i].origin, specs[i].bounding_radius});
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return out;
}

/// The lights that the program would gather if it drew everything at full detail and looked to all
/// sides.
std::vector<Light> lights_of(world::World& world, const game::SceneOptions& options,
                             const game::CameraPlace& camera, int threads,
                             std::span<const game::PlacedIsland> islands) {
  const game::Settings& settings = options.settings;
  const render::Camera first{{camera.position.x, camera.position.y, camera.position.z},
                             camera.yaw_deg,
                             camera.pitch_deg,
                             options.fov_deg};
  game::LightField field = game::light_field_of(options, world, first);
  Jobs jobs(threads);
  world::Streamer streamer(world, jobs);
  streamer.update({camera.position, {0.0, 0.0, 1.0}, settings.world_time_s},
                  {static_cast<double>(settings.view_distance), kFar});
  streamer.wait_until_complete();
  while (!streamer.complete())
    for (const world::ReadySection& section : streamer.poll(SIZE_MAX).ready)
      field.add(section.key, section.emitters);
  game::FrameLights gathered;
  field.gather(camera.position, std::nullopt, islands,
               game::held_light(settings, field, camera.yaw_deg, settings.world_time_s), gathered);
  std::vector<Light> lights;
  for (const shared::Light& light : gathered.lights) lights.push_back(light_from(light));
  return lights;
}

/// The translucent block about the eye, or air.
BlockId medium_at_eye(const std::vector<Island>& islands) {
  for (const Island& island : islands) {
    const glm::dvec3 eye = glm::transpose(island.rotation) * -island.origin;
    const IVec3 voxel{world::floor_to_int(eye.x), world::floor_to_int(eye.y),
                      world::floor_to_int(eye.z)};
    const BlockId block = island.voxels->block_at(voxel);
    if (world::block_kind(block) == world::BlockKind::kTranslucent) return block;
  }
  return world::kAir;
}

/// Extinction of clear air [1/block]: 0.0005, taken back as the body that lights it sets.
/// docs/decisions/0009-haze-that-keeps-caves-black.md.
double haze_per_block(const render::Celestial& sky) {
  const glm::dvec3 light = sky.sun_casts ? glm::dvec3(sky.sun_irradiance)
                                         : glm::dvec3(sky.moon_irradiance) / render::kMoonToSun;
  const double t = std::clamp((light.x + light.y + light.z) / 3.0 / 0.05, 0.0, 1.0);
  return 0.0005 * t * t * (3.0 - 2.0 * t);
}

void add_sky(const game::SceneOptions& options, const render::Celestial& sky, double body_radius,
             Scene& scene) {
  scene.sky = Sky{render::sky_constants(sky), glm::dmat3(sky.sky_from_world)};
  if (sky.sun_casts)
    scene.bodies.push_back({sky.to_sun, glm::dvec3(sky.sun_irradiance), body_radius});
  if (sky.moon_casts)
    scene.bodies.push_back({sky.to_moon, glm::dvec3(sky.moon_irradiance), body_radius});
  scene.haze_per_block = haze_per_block(sky);
  scene.shadows = options.settings.shadow_enabled;
  scene.flat_shading = options.settings.shading == game::Shading::kFlat;
  scene.corner_occlusion = scene.flat_shading ? 0.0 : options.settings.ao_strength;
}

}  // namespace

ReferenceSettings settings_from(const game::SceneOptions& options) {
  ReferenceSettings settings;
  settings.samples = options.settings.reference_samples;
  settings.filter = options.settings.reference_filter;
  settings.threads = static_cast<int>(options.settings.jobs_threads);
  return settings;
}

Darkroom darkroom_from(const game::Settings& settings) {
  return {settings.tone, settings.display, settings.bloom};
}

Result<ReferencePicture> render_reference(const game::SceneOptions& options,
                                          const ReferenceSettings& settings,
                                          const Progress& progress) {
  if (options.settings.debug_view != game::DebugView::kNone)
    return Error{"debug.view has no reference picture: use debug.view=none or renderer=deferred"};
  if (options.settings.leave_out != render::FeatureSet{})
    return Error{"leave.out has no reference picture: use leave.out=none or renderer=deferred"};
  if (std::uint64_t{options.size.width} * options.size.height > kMaxPixels)
    return Error{fmt::format("--size {}x{} is too large: a reference picture has at most {} pixels",
                             options.size.width, options.size.height, kMaxPixels)};
  Result<std::unique_ptr<world::World>> opened = game::open_world(options);
  if (!opened) return opened.error();
  world::World& world = **opened;
  const game::CameraPlace camera = camera_place(options, world);
  const render::Celestial sky =
      render::celestial_at(options.time_of_day_s, options.settings.moon_phase);
  Scene scene;
  scene.view = view_of(options, camera);
  const std::vector<world::IslandSpec> specs = specs_of(world, options, camera.position);
  scene.islands = islands_of(world, specs, camera.position, options.settings.world_time_s);
  scene.lights = lights_of(world, options, camera, settings.threads, placed(specs, scene.islands));
  scene.view.medium = medium_at_eye(scene.islands);
  scene.time_s = options.settings.world_time_s;
  add_sky(options, sky, settings.body_radius, scene);
  ReferencePicture picture = render(scene, settings, progress);
  picture.ev = options.settings.exposure_ev
                   ? *options.settings.exposure_ev
                   : metered_ev(picture.radiance, options.settings.meter).value_or(0.0);
  return picture;
}

}  // namespace skerry::reference
