#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <memory>
#include <utility>

#include "engine/render/frame/celestial.h"
#include "game/panorama/load_panorama.h"
#include "game/player/player.h"
#include "game/scene_file/cloud_files.h"
#include "game/view/light_setup.h"
#include "game/worlds/open_world.h"
#include "tools/reference/reference.h"
#include "tools/reference/tracer.h"
#include "world/islands/march.h"
#include "world/islands/world.h"
#include "world/stream/stream.h"

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

/// The islands that are drawn: as the streamer takes them in for a first view. Errors: it would
/// leave some out.
Result<std::vector<world::IslandSpec>> specs_of(const world::World& world,
                                                const game::SceneOptions& options,
                                                world::WorldPos camera) {
  std::vector<world::IslandSpec> specs =
      world.islands_near(camera, options.settings.view_distance, options.settings.world_time_s);
  if (specs.size() > world::kMaxStreamedIslands)
    return Error{
        fmt::format("{} islands are within view.distance={} and a picture shows at most "
                    "{}: lower view.distance",
                    specs.size(), options.settings.view_distance, world::kMaxStreamedIslands)};
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
               game::held_light(settings, field, camera.yaw_deg, settings.world_time_s), true,
               gathered);
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

constexpr int kMostBounces = 1000;

/// How much of the light of clear air there is, taken back as the body that lights it sets.
/// docs/decisions/0009-haze-that-keeps-caves-black.md.
double light_in_air(const render::Celestial& sky) {
  const glm::dvec3 light = sky.sun_casts ? glm::dvec3(sky.sun_irradiance)
                                         : glm::dvec3(sky.moon_irradiance) / render::kMoonToSun;
  const double t = std::clamp((light.x + light.y + light.z) / 3.0 / 0.05, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// What can be left out of a reference.
bool may_lack(const render::FeatureSet& left_out) {
  for (std::size_t i = 0; i < render::kFeatureNames.size(); ++i) {
    const auto feature = static_cast<render::Feature>(i);
    const bool may = feature == render::Feature::kSun || feature == render::Feature::kMoon ||
                     feature == render::Feature::kDiscs;
    if (!may && left_out.has(feature)) return false;
  }
  return true;
}

void add_sky(const game::SceneOptions& options, const render::Celestial& sky, double eye_km,
             double body_radius, std::shared_ptr<const render::PanoramaSky> panorama,
             Scene& scene) {
  scene.sky = Sky{render::sky_model(sky, eye_km, nullptr, std::move(panorama)),
                  glm::dmat3(sky.sky_from_world)};
  if (options.settings.render.leave_out.has(render::Feature::kDiscs))
    scene.sky->model.constants.sun_disc = scene.sky->model.constants.moon_disc = glm::vec3(0.0f);
  if (sky.sun_casts)
    scene.bodies.push_back({sky.to_sun, glm::dvec3(sky.sun_irradiance), body_radius});
  if (sky.moon_casts)
    scene.bodies.push_back({sky.to_moon, glm::dvec3(sky.moon_irradiance), body_radius});
  scene.sky_lights = options.settings.render.indirect != render::Indirect::kOff;
  // Ended by lot, long before.
  if (options.settings.render.indirect == render::Indirect::kFull) scene.bounces = kMostBounces;
  scene.air_light = light_in_air(sky);
  // What the sky lights stays as thick when sun and moon have set.
  scene.haze_per_block = 0.0005 * (scene.sky_lights ? 1.0 : scene.air_light);
  scene.body_in_air = scene.sky_lights ? scene.air_light : 1.0;
  scene.shadows = options.settings.render.shadow_enabled;
  scene.flat_shading = options.settings.render.shading == render::Shading::kFlat;
  scene.ao_strength = scene.flat_shading ? 0.0 : options.settings.render.ao_strength;
}

/// The layer as docs/clouds.md has it. What it repeats with is taken off in integers.
CloudLayer cloud_layer(const render::CloudSettings& settings, world::WorldPos camera,
                       world::WorldPos origin, double time_s) {
  constexpr std::int64_t kPeriod = 10240 * 65536LL;
  const auto in_noise = [&](std::int64_t units, double wind) {
    return static_cast<double>(units % kPeriod) / 65536.0 - std::fmod(wind * time_s, 10240.0);
  };
  CloudLayer out;
  out.eye = {in_noise(camera.x - origin.x, 5.0),
             static_cast<double>(camera.y - origin.y) / 65536.0 - settings.altitude,
             in_noise(camera.z - origin.z, 2.0)};
  out.thickness = static_cast<double>(settings.thickness);
  out.extinction = static_cast<double>(settings.density);
  out.coverage = static_cast<double>(settings.coverage);
  return out;
}

/// A volume's samples in one box. Errors: the box is too large.
Result<CloudGrid> cloud_grid(const render::CloudVolumeDesc& volume,
                             const render::CloudSettings& settings, world::WorldPos camera) {
  constexpr std::int64_t kMostSamples = std::int64_t{1} << 27;
  CloudGrid out;
  glm::ivec3 low(1 << 30), end(-(1 << 30));
  const auto take = [&](glm::ivec3 first, int edge) {
    low = glm::min(low, first);
    end = glm::max(end, first + edge);
  };
  for (const render::CloudBrick& brick : volume.bricks) take(brick.origin, 8);
  for (const render::CloudTile& tile : volume.tiles) take(tile.origin, tile.edge);
  if (low.x >= end.x) return out;
  out.low = low;
  out.size = end - low;
  const std::int64_t count = std::int64_t{out.size.x} * out.size.y * out.size.z;
  if (count <= 0 || count > kMostSamples)
    return Error{"a cloud's box is too large for a reference picture: use renderer=deferred"};
  out.samples.resize(static_cast<std::size_t>(count));
  float most = 0.0f;
  // Densities beyond count as this: docs/clouds.md.
  const float limit =
      volume.role == render::CloudRole::kDensity ? 1e4f : std::numeric_limits<float>::max();
  const auto put = [&](glm::ivec3 at, float value) {
    at -= low;
    value = std::min(value, limit);
    most = std::max(most, value);
    out.samples[(static_cast<std::size_t>(at.z) * static_cast<std::size_t>(out.size.y) +
                 static_cast<std::size_t>(at.y)) *
                    static_cast<std::size_t>(out.size.x) +
                static_cast<std::size_t>(at.x)] = value;
  };
  for (const render::CloudBrick& brick : volume.bricks)
    for (int i = 0; i < 512; ++i)
      put(brick.origin + glm::ivec3(i / 64, i / 8 % 8, i % 8), brick.values[i]);
  for (const render::CloudTile& tile : volume.tiles)
    for (int z = 0; z < tile.edge; ++z)
      for (int y = 0; y < tile.edge; ++y)
        for (int x = 0; x < tile.edge; ++x) put(tile.origin + glm::ivec3(x, y, z), tile.value);
  glm::dmat4 world_from_index = volume.blocks_from_index;
  const world::WorldPos origin{volume.origin[0], volume.origin[1], volume.origin[2]};
  world_from_index[3] += glm::dvec4(world::difference_blocks(origin, camera), 0.0);
  out.index_from_world = glm::inverse(world_from_index);
  const glm::dmat3 axes(world_from_index);
  out.step = 0.5 * std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  if (volume.role == render::CloudRole::kDensity)
    out.extinction = static_cast<double>(settings.file_density);
  else if (most > 0.0f)
    out.emission = glm::dvec3(1.0, 0.42, 0.10) *
                   (static_cast<double>(settings.file_emission) / static_cast<double>(most));
  return out;
}

Result<void> add_clouds(const game::SceneOptions& options, world::WorldPos camera,
                        world::WorldPos origin, Scene& scene) {
  const render::CloudSettings& settings = options.settings.render.clouds;
  if (settings.coverage > 0.0f)
    scene.clouds.layer = cloud_layer(settings, camera, origin, options.settings.world_time_s);
  const Result<game::LoadedClouds> loaded = game::load_clouds(options.clouds);
  if (!loaded) return loaded.error();
  for (const render::CloudVolumeDesc& volume : loaded->volumes) {
    Result<CloudGrid> grid = cloud_grid(volume, settings, camera);
    if (!grid) return grid.error();
    scene.clouds.grids.push_back(*std::move(grid));
  }
  return {};
}

double ev_of(const game::SceneOptions& options, const measure::Picture& radiance) {
  if (options.settings.exposure_ev) return *options.settings.exposure_ev;
  return metered_ev(radiance, options.settings.render.meter).value_or(0.0);
}

}  // namespace

Result<NamedScene> scene_from(const game::SceneOptions& options,
                              const ReferenceSettings& settings) {
  if (options.settings.render.debug_view != render::DebugView::kNone)
    return Error{"debug.view has no reference picture: use debug.view=none or renderer=deferred"};
  if (!may_lack(options.settings.render.leave_out))
    return Error{
        "leave.out has a reference picture for sun, moon and discs alone: use leave.out=none or "
        "renderer=deferred"};
  if (std::uint64_t{options.size.width} * options.size.height > kMaxPixels)
    return Error{fmt::format("--size {}x{} is too large: a reference picture has at most {} pixels",
                             options.size.width, options.size.height, kMaxPixels)};
  Result<std::unique_ptr<world::World>> opened = game::open_world(options);
  if (!opened) return opened.error();
  world::World& world = **opened;
  const game::CameraPlace camera = camera_place(options, world);
  const render::Celestial sky =
      render::sky_without(render::celestial_at(options.time_of_day_s, options.settings.moon_phase),
                          options.settings.render.leave_out);
  Result<std::shared_ptr<const render::PanoramaSky>> panorama = game::load_panorama(options);
  if (!panorama) return panorama.error();
  NamedScene named;
  Scene& scene = named.scene;
  scene.view = view_of(options, camera);
  const Result<std::vector<world::IslandSpec>> specs = specs_of(world, options, camera.position);
  if (!specs) return specs.error();
  scene.islands = islands_of(world, *specs, camera.position, options.settings.world_time_s);
  scene.lights = lights_of(world, options, camera, settings.threads, placed(*specs, scene.islands));
  scene.view.medium = medium_at_eye(scene.islands);
  scene.time_s = options.settings.world_time_s;
  const double above = static_cast<double>(camera.position.y - world.origin().y) / 65536.0;
  add_sky(options, sky, render::eye_height_km(above), settings.body_radius, *panorama, scene);
  if (Result<void> added = add_clouds(options, camera.position, world.origin(), scene); !added)
    return added.error();
  named.world = *std::move(opened);
  for (const world::IslandSpec& spec : *specs) named.ids.push_back(spec.id);
  return named;
}

ReferenceSettings settings_from(const game::SceneOptions& options) {
  ReferenceSettings settings;
  settings.samples = options.settings.reference_samples;
  settings.filter = options.settings.reference_filter;
  settings.threads = static_cast<int>(options.settings.jobs_threads);
  return settings;
}

Darkroom darkroom_from(const game::Settings& settings) {
  return {settings.render.tone, settings.render.display, settings.render.bloom};
}

Result<ReferencePicture> render_reference(const game::SceneOptions& options,
                                          const ReferenceSettings& settings,
                                          const Progress& progress) {
  const Result<NamedScene> named = scene_from(options, settings);
  if (!named) return named.error();
  ReferencePicture picture = render(named->scene, settings, progress);
  picture.ev = ev_of(options, picture.radiance);
  return picture;
}

Result<ReferenceBatches> render_reference_batches(const game::SceneOptions& options,
                                                  const ReferenceSettings& settings,
                                                  std::uint32_t first, std::uint32_t count,
                                                  const Progress& progress) {
  const Result<NamedScene> named = scene_from(options, settings);
  if (!named) return named.error();
  return render_batches(named->scene, settings, first, count, progress);
}

ReferencePicture merge_reference(const game::SceneOptions& options,
                                 std::span<const ReferenceBatches> parts) {
  ReferencePicture picture = merge_batches(parts);
  picture.ev = ev_of(options, picture.radiance);
  return picture;
}

}  // namespace skerry::reference
