#include "tools/skerry/shade/stored_light.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "engine/core/clock.h"
#include "engine/core/jobs.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/sky/sky_irradiance.h"
#include "game/panorama/load_panorama.h"
#include "game/player/player.h"
#include "game/view/key_fades.h"
#include "game/view/light_chunk.h"
#include "game/view/light_setup.h"
#include "game/view/materials.h"
#include "game/worlds/open_world.h"
#include "world/light/base/shared_exponent.h"
#include "world/stream/stream.h"

namespace skerry::tools {
namespace {

constexpr std::size_t kIslandTexels = shared::kIndirectIslandTexels;

world::WorldPos camera_of(const game::SceneOptions& options, const world::World& world) {
  if (options.camera) return options.camera->position;
  return world::moved(world.spawn().feet, {0.0, game::kEyeHeight, 0.0});
}

/// Chunks of all islands in view at the levels that they are shown at.
struct LitIsland {
  int level = 0;
  world::LightChunks chunks;
};
using LitIslands = std::map<std::uint64_t, LitIsland>;

LitIslands chunks_in_view(world::World& world, const game::SceneOptions& options,
                          world::WorldPos camera, Jobs& jobs) {
  const game::Settings& settings = options.settings;
  const game::LightField field;
  const bool full = settings.render.indirect == render::Indirect::kFull;
  world::Streamer streamer(world, jobs, world::StreamOf::kMeshesAndOccupancy);
  streamer.update(
      {camera, {0.0, 0.0, 1.0}, settings.world_time_s},
      {static_cast<double>(settings.view_distance), static_cast<double>(settings.view_detail)});
  streamer.wait_until_complete();
  LitIslands out;
  while (!streamer.complete())
    for (const world::ReadySection& section : streamer.poll(SIZE_MAX).ready) {
      LitIsland& island = out[section.key.island];
      island.level = section.key.level;
      if (section.key.far) continue;
      std::vector<game::LatticeLight> lights = field.lights_of(section.key, section.emitters);
      std::vector<world::WeakLamp> weak;
      if (full) weak = game::take_weak(lights, section.key.level);
      island.chunks[section.key.chunk] = std::make_shared<const world::LightChunk>(
          game::light_chunk_of(section, std::move(weak), lights));
    }
  return out;
}

/// @param bounces 0: none are looked for.
world::SkyTransfer::Skies look(const LitIsland& island, int bounces,
                               const world::KeyDirections& keys, Jobs& jobs,
                               std::atomic<double>& seconds) {
  const auto timed = [&seconds](const auto& part) {
    const double begin = thread_seconds();
    part();
    seconds.fetch_add(thread_seconds() - begin);
  };
  std::optional<world::SkyTransfer> transfer;
  timed([&] {
    transfer.emplace(island.chunks,
                     bounces > 0 ? game::albedo_table() : std::span<const world::FaceAlbedo>{},
                     bounces, 0, keys);
  });
  jobs.parallel_for(world::kOctants + 1, [&](int part) {
    timed([&] { part < world::kOctants ? transfer->look(part) : transfer->spread_lamps(); });
  });
  for (int step = 0; step < transfer->bounce_steps(); ++step)
    jobs.parallel_for(world::BounceLight::kParts,
                      [&](int part) { timed([&] { transfer->follow_bounces(step, part); }); });
  timed([&] { transfer->make_faces(); });
  return transfer->faces();
}

std::vector<render::IslandPlacement> placements(const world::World& world, double time_s,
                                                const LitIslands& islands,
                                                const std::map<std::uint64_t, glm::vec3>& keys) {
  std::vector<render::IslandPlacement> out;
  for (const auto& [id, island] : islands) {
    const world::Pose pose = *world.pose(id, time_s);
    const world::IslandSpec spec = *world.island(id);
    out.push_back({{pose.origin.x, pose.origin.y, pose.origin.z},
                   pose.rotation,
                   spec.bounding_radius,
                   island.chunks.empty(),
                   island.level,
                   game::land_of(spec),
                   {}});
    if (const auto key = keys.find(id); key != keys.end())
      out.back().keyed[0] = {key->second, 1.0f};
  }
  return out;
}

/// The texels of sky_irradiance(), read as shaders read them.
double half_of(const glm::uvec4& texel, int i) {
  const glm::vec2 pair = glm::unpackHalf2x16(texel[i / 2]);
  return static_cast<double>(i % 2 == 0 ? pair.x : pair.y);
}

template <class T>
T between_corners(const std::array<T, 4>& corners, glm::dvec2 at) {
  return glm::mix(glm::mix(corners[0], corners[1], at.x), glm::mix(corners[2], corners[3], at.x),
                  at.y);
}

/// Of a record's two texels: share of a lobe that is seen at each corner.
std::array<double, 4> lobe_of(std::span<const glm::uvec4> record, std::size_t lobe) {
  std::array<double, 4> out{};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const glm::uvec4& texel = record[corner / 2];
    const std::uint32_t word = texel[static_cast<int>(corner % 2 * 2 + lobe / 4)];
    out[corner] = static_cast<double>(word >> 8 * (lobe % 4) & 255u) / 255.0;
  }
  return out;
}

/// Shares of the lobes of a face of an axis in the light of an even sky; they sum to 1.
std::array<double, shared::kSkyLobes> even_shares(int axis) {
  std::array<double, shared::kSkyLobes> out{};
  double sum = 0.0;
  for (int octant = 0; octant < world::kOctants; ++octant) {
    if ((octant >> axis & 1) != 0) continue;
    for (std::size_t k = 0; k < shared::kSkyPatternCount; ++k) {
      const double weight = world::lobe_weights(axis)[k];
      out[world::lobe_of(axis, octant, k)] += weight;
      sum += weight;
    }
  }
  for (double& share : out) share /= sum;
  return out;
}

/// @param apart each lobe's share times its light; else the share of all times the light of all.
glm::dvec3 sky_light(std::span<const glm::uvec4> record, std::span<const glm::uvec4> face, int axis,
                     glm::dvec2 at, bool apart) {
  const std::array<double, shared::kSkyLobes> shares = even_shares(axis);
  glm::dvec3 sum(0.0), whole(0.0);
  double seen_of_all = 0.0;
  for (std::size_t lobe = 0; lobe < shared::kSkyLobes; ++lobe) {
    const double seen = between_corners(lobe_of(record, lobe), at);
    seen_of_all += seen * shares[lobe];
    for (int c = 0; c < 3; ++c) {
      const double light = half_of(face[static_cast<std::size_t>(c)], static_cast<int>(lobe));
      sum[c] += seen * light;
      whole[c] += light;
    }
  }
  return apart ? sum : seen_of_all * whole;
}

/// @param words a colour a corner.
glm::dvec3 colour_between(const glm::uvec4& words, glm::dvec2 at) {
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = world::unpack_shared_exponent(words[static_cast<int>(i)]);
  return between_corners(corners, at);
}

/// @param shares a byte a corner.
double share_between(std::uint32_t shares, glm::dvec2 at) {
  std::array<double, 4> corners{};
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = static_cast<double>(shares >> 8 * i & 255u) / 255.0;
  return between_corners(corners, at);
}

/// @param bodies irradiance: kIndirectKeys and the texel after.
glm::dvec3 keyed_light(const glm::uvec4& keyed, std::span<const glm::uvec4> bodies, glm::dvec2 at) {
  glm::dvec3 sum(0.0);
  for (int slot = 0; slot < 2; ++slot)
    sum +=
        glm::dvec3(world::unpack_shared_exponent(keyed[2 * slot])) *
        glm::dvec3(std::bit_cast<glm::vec3>(glm::uvec3(bodies[static_cast<std::size_t>(slot)]))) *
        share_between(keyed[2 * slot + 1], at);
  return sum;
}

/// @param sent harmonics of what comes from infinity: kIndirectHarmonics and the texels after.
/// @param degree of those that count.
glm::dvec3 bounced_light(const glm::uvec4& bounce, std::span<const glm::uvec4> sent, glm::dvec2 at,
                         int degree) {
  const glm::vec4 low = glm::unpackSnorm4x8(bounce.z), high = glm::unpackSnorm4x8(bounce.w);
  glm::dvec3 sum;
  for (int c = 0; c < 3; ++c) {
    const glm::uvec4& texel = sent[static_cast<std::size_t>(c)];
    sum[c] = static_cast<double>(std::bit_cast<float>(sent[3][c]));
    for (int i = 0; i < (degree + 1) * (degree + 1) - 1; ++i)
      sum[c] += static_cast<double>(shared::kMostBounceShape * (i < 4 ? low[i] : high[i - 4])) *
                half_of(texel, i);
  }
  return glm::dvec3(world::unpack_shared_exponent(bounce.x)) * glm::max(sum, 0.0) *
         share_between(bounce.y, at);
}

/// From where light of sun and moon is followed on the nearest islands, as SceneView has it.
std::map<std::uint64_t, glm::vec3> key_directions(const world::World& world, const LitIslands& lit,
                                                  world::WorldPos camera, double time_s,
                                                  const render::Celestial& sky) {
  std::vector<std::pair<double, std::uint64_t>> nearest;
  for (const auto& [id, island] : lit) {
    if (island.chunks.empty() || island.level != 0) continue;
    const double centre =
        glm::length(world::difference_blocks(camera, world.pose(id, time_s)->origin));
    const double distance = std::max(0.0, centre - world.island(id)->bounding_radius);
    if (distance <= game::kKeyedWithin) nearest.emplace_back(distance, id);
  }
  std::ranges::sort(nearest);
  nearest.resize(std::min(nearest.size(), game::kMostKeyed));
  std::map<std::uint64_t, glm::vec3> out;
  for (const auto& [distance, id] : nearest)
    if (const auto to_body = game::key_direction(sky, world.pose(id, time_s)->rotation))
      out[id] = *to_body;
  return out;
}

}  // namespace

Result<StoredLight> StoredLight::find(const game::SceneOptions& options,
                                      const LightDetail& detail) {
  Result<std::unique_ptr<world::World>> opened = game::open_world(options);
  if (!opened) return opened.error();
  world::World& world = **opened;
  Result<std::shared_ptr<const render::PanoramaSky>> panorama = game::load_panorama(options);
  if (!panorama) return panorama.error();
  const world::WorldPos camera = camera_of(options, world);
  Jobs jobs(static_cast<int>(options.settings.jobs_threads));
  const LitIslands lit = chunks_in_view(world, options, camera, jobs);
  const bool full = options.settings.render.indirect == render::Indirect::kFull;
  const render::Celestial sky =
      render::sky_without(render::celestial_at(options.time_of_day_s, options.settings.moon_phase),
                          options.settings.render.leave_out);
  std::map<std::uint64_t, glm::vec3> keys;
  if (full && detail.keyed)
    keys = key_directions(world, lit, camera, options.settings.world_time_s, sky);
  StoredLight out;
  out.detail_ = detail;
  std::atomic<double> seconds = 0.0;
  for (const auto& [id, island] : lit) {
    out.islands_[id].level = island.level;
    if (island.chunks.empty()) continue;
    world::KeyDirections from{};
    if (const auto key = keys.find(id); key != keys.end()) from[0] = key->second;
    out.islands_[id].skies = look(island, full ? detail.bounces : 0, from, jobs, seconds);
  }
  out.work_seconds_ = seconds;
  const double above = static_cast<double>(camera.y - world.origin().y) / 65536.0;
  const std::vector<render::IslandPlacement> placed =
      placements(world, options.settings.world_time_s, lit, keys);
  out.sky_ = render::sky_irradiance(
      render::sky_model(sky, render::eye_height_km(above), nullptr, *panorama), sky, placed,
      std::vector<bool>(placed.size(), true), {camera.x, camera.y, camera.z});
  std::size_t number = 0;
  for (auto& [id, island] : out.islands_) {
    island.first = out.sky_[number / 4][static_cast<int>(number % 4)];
    ++number;
  }
  return out;
}

std::optional<glm::dvec3> StoredLight::at(std::uint64_t id, glm::dvec3 place, int direction) const {
  const auto found = islands_.find(id);
  if (found == islands_.end()) return std::nullopt;
  const Island& island = found->second;
  const bool plant = direction == kPlant;
  const int face = plant ? 2 : direction;
  const std::span<const glm::uvec4> sky(sky_.begin() + static_cast<std::ptrdiff_t>(island.first),
                                        kIslandTexels);
  place /= static_cast<double>(1 << island.level);
  glm::dvec3 inside = place;
  inside[face / 2] += plant ? 1e-3 : face % 2 == 0 ? -0.5 : 0.5;
  const glm::ivec3 voxel(glm::floor(inside));
  const world::IVec3 chunk{voxel.x >> 6, voxel.y >> 6, voxel.z >> 6};
  const auto in = island.skies.find(chunk);
  if (in == island.skies.end()) return std::nullopt;
  const std::optional<std::size_t> at =
      world::find_record(*in->second, {voxel.x & 63, voxel.y & 63, voxel.z & 63}, face);
  if (!at) return std::nullopt;
  const std::span<const glm::uvec4> record(
      in->second->texels.begin() + static_cast<std::ptrdiff_t>(*at), in->second->record_texels());
  const world::FaceAxes axes(face);
  const glm::dvec3 in_voxel = glm::clamp(place - glm::dvec3(voxel), 0.0, 1.0);
  const glm::dvec2 corner{in_voxel[axes.b], in_voxel[axes.c]};
  const glm::dvec3 open_sky =
      sky_light(record,
                sky.subspan(static_cast<std::size_t>(face) * shared::kIndirectSkyTexels,
                            shared::kIndirectSkyTexels),
                face / 2, corner, detail_.lobes);
  const world::RecordParts& parts = in->second->parts;
  const glm::dvec3 tint =
      parts.tinted ? colour_between(record[parts.before_tint()], corner) : glm::dvec3(1.0);
  glm::dvec3 bounced =
      bounced_light(record[3], sky.subspan(shared::kIndirectHarmonics), corner, detail_.degree);
  if (parts.keyed)
    bounced += keyed_light(record[shared::kIndirectRecordTexels],
                           sky.subspan(shared::kIndirectKeys), corner);
  return open_sky * tint + colour_between(record[2], corner) + bounced;
}

std::size_t StoredLight::bytes() const {
  std::size_t sum = 0;
  for (const auto& [id, island] : islands_)
    for (const auto& [at, sky] : island.skies)
      sum += sky->table.size() * sizeof(std::uint32_t) + sky->texels.size() * sizeof(glm::uvec4);
  return sum;
}

}  // namespace skerry::tools
