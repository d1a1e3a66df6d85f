#include "game/view/scene_view.h"
#include "engine/render/frame/exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <limits>
#include <set>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/clock.h"
#include "engine/core/log.h"
#include "engine/core/shared_work.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/scene/section_parts.h"
#include "game/panorama/load_panorama.h"
#include "game/player/player.h"
#include "game/sections/section_record.h"
#include "game/view/light_chunk.h"
#include "game/view/light_setup.h"
#include "game/view/materials.h"
#include "game/worlds/open_world.h"
#include "world/islands/medium.h"
#include "world/voxel/blocks.h"

namespace skerry::game {
namespace {

constexpr std::size_t kMaxPolledQuads = 200'000;      // taken from the workers in one frame
constexpr double kReachStep = 128.0;                  // blocks
constexpr std::uint32_t kFirstArenaQuads = 1u << 21;  // 16 MiB
constexpr std::uint64_t kBytesPerMiB = std::uint64_t{1} << 20;
// What is new leaves this share of the memory to what is built anew after an edit.
constexpr double kForEdits = 1.0 / 16.0;
// Removed sections are the GPU's for two frames, and the streamer's answer takes one or two.
constexpr int kFramesToLetGo = 8;
constexpr double kLessOnRestart = 0.7;
constexpr int kMostFramesWithoutLight = 60;
// Of islands that a thread places at a time: a twentieth of a millisecond or so.
constexpr std::size_t kSlotsAPiece = 512;

gpu::UploadPath upload_path(UploadMode mode) {
  switch (mode) {
    case UploadMode::kUpdate:
      return gpu::UploadPath::kUpdateBuffer;
    case UploadMode::kStaging:
      return gpu::UploadPath::kStaging;
    case UploadMode::kMapped:
      return gpu::UploadPath::kMapped;
  }
  return gpu::UploadPath::kUpdateBuffer;
}

render::FixedPos fixed(const world::WorldPos& p) {
  return {p.x, p.y, p.z};
}
world::WorldPos place(const render::FixedPos& p) {
  return {p[0], p[1], p[2]};
}

glm::dvec3 forward_of(const render::Camera& camera) {
  const double yaw = glm::radians(camera.yaw_deg), pitch = glm::radians(camera.pitch_deg);
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

glm::ivec3 chunk_place(const world::SectionKey& key) {
  return {key.chunk.x, key.chunk.y, key.chunk.z};
}

/// Chunks of a level that hold an island's box.
render::IslandChunks expected_chunks(const world::IslandSpec& spec, std::int32_t level) {
  const std::int64_t edge = std::int64_t{world::kChunkEdge} << level;
  const auto chunk = [&](std::int32_t block) {
    return static_cast<int>(world::floor_div(block, edge));
  };
  const glm::ivec3 low{chunk(spec.box_min.x), chunk(spec.box_min.y), chunk(spec.box_min.z)};
  const glm::ivec3 last{chunk(spec.box_max.x - 1), chunk(spec.box_max.y - 1),
                        chunk(spec.box_max.z - 1)};
  return {low, last - low + 1, static_cast<std::uint32_t>(level)};
}

world::LatticeBox box_of_faces(const world::SectionKey& key, const world::ChunkMesh& mesh) {
  if (mesh.quads.empty()) return {};
  const auto corner = [&](const std::array<std::uint8_t, 3>& voxel) {
    const auto along = [&](std::int32_t chunk, std::uint8_t v) {
      return (chunk * world::kChunkEdge + v) * (1 << key.level);
    };
    return world::IVec3{along(key.chunk.x, voxel[0]), along(key.chunk.y, voxel[1]),
                        along(key.chunk.z, voxel[2])};
  };
  return {corner(mesh.bounds_min), corner(mesh.bounds_max)};
}

/// What a frame may upload. Its thread copies it, at about a millisecond a MiB, which is to be a
/// small part of the time that frames take. @param frame_s none: they need not be as long.
std::uint64_t upload_bytes_of(std::optional<double> frame_s, std::uint64_t most) {
  constexpr double kASecond = 384.0 * (1u << 20), kLeast = 512.0 * 1024.0;
  if (!frame_s) return most;
  const double bytes = std::max(kLeast, *frame_s * kASecond);
  return bytes < static_cast<double>(most) ? static_cast<std::uint64_t>(bytes) : most;
}

}  // namespace

SceneView::SceneView(const SceneOptions& options, std::shared_ptr<world::World> world,
                     SceneCache* cache)
    : settings_(options.settings),
      cache_(cache),
      world_(std::move(world)),
      size_{options.size.width, options.size.height} {
  const auto asked = static_cast<int>(settings_.jobs_threads);
  jobs_ = std::make_unique<Jobs>(asked != 0 ? asked : threads_beside_frames());
  streamer_ = std::make_unique<world::Streamer>(*world_, *jobs_);
  if (options.camera) {
    start_camera_.position = fixed(options.camera->position);
    start_camera_.yaw_deg = options.camera->yaw_deg;
    start_camera_.pitch_deg = options.camera->pitch_deg;
  } else {
    const world::Spawn spawn = world_->spawn();
    start_camera_.position = fixed(world::moved(spawn.feet, {0.0, kEyeHeight, 0.0}));
    start_camera_.yaw_deg = spawn.yaw_deg;
    start_camera_.pitch_deg = spawn.pitch_deg;
  }
  start_camera_.fov_deg = options.fov_deg;
  light_field_ = light_field_of(options, *world_, start_camera_);
}

// Nobody waits for light that nobody will see: of a wide view it takes seconds.
SceneView::~SceneView() {
  if (light_threads_) light_threads_->drop_waiting();
}

Result<std::unique_ptr<SceneView>> SceneView::create(gpu::Device& device,
                                                     const SceneOptions& options,
                                                     SceneCache* cache) {
  Result<std::unique_ptr<world::World>> world = open_world(options);
  if (!world) return world.error();
  return create(device, options, *std::move(world), cache);
}

Result<std::unique_ptr<SceneView>> SceneView::create(gpu::Device& device,
                                                     const SceneOptions& options,
                                                     std::shared_ptr<world::World> world,
                                                     SceneCache* cache) {
  std::unique_ptr<SceneView> view(new SceneView(options, std::move(world), cache));
  const std::vector<shared::Material> materials = material_table();
  render::RendererDesc desc;
  desc.materials = materials;
  desc.upload_path = upload_path(options.settings.upload_path);
  desc.upload_budget_bytes = options.settings.upload_budget_bytes;
  desc.arena_quads = kFirstArenaQuads;
  desc.world_budget_bytes = options.settings.memory_budget_mib.value_or(0) * kBytesPerMiB;
  if (cache) desc.pipelines = &cache->pipelines;
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(device, desc);
  if (!renderer) return renderer.error();
  view->renderer_ = *std::move(renderer);
  if (Result<void> ok = view->follow_settings(); !ok) return ok.error();
  Result<std::shared_ptr<const render::PanoramaSky>> panorama = load_panorama(options);
  if (!panorama) return panorama.error();
  if (*panorama)
    if (Result<void> ok = view->renderer_->set_panorama(*std::move(panorama)); !ok)
      return ok.error();
  if (!options.clouds.empty()) {
    const Result<LoadedClouds> clouds = load_clouds(options.clouds);
    if (!clouds) return clouds.error();
    for (const std::string& line : clouds->remarks) fmt::print(stderr, "skerry: {}\n", line);
    view->cloud_volumes_ = true;
    if (Result<void> ok = view->renderer_->set_clouds(
            clouds->volumes,
            static_cast<render::CloudPrecision>(options.settings.render.clouds.precision));
        !ok)
      return ok.error();
  }
  // Programs of other views are likely to be enough.
  if (!cache)
    view->expect_frame({view->start_camera_, static_cast<double>(options.time_of_day_s),
                        options.settings.world_time_s});
  return view;
}

ViewFit::Distances SceneView::asked() const {
  return {static_cast<double>(settings_.view_distance), static_cast<double>(settings_.view_detail)};
}

void SceneView::update_streamer(const render::Camera& camera, double world_time_s) {
  const ViewFit::Distances wanted = asked();
  if (wanted != std::exchange(asked_before_, wanted)) fit_ = {};
  const ViewFit::Distances shown = fit_.of(wanted);
  streamer_->update({place(camera.position), forward_of(camera), world_time_s},
                    {shown.view_blocks, shown.detail_blocks, settings_.view_error > 0.0});
  const world::Streamer::LeftOut& left_out = streamer_->left_out();
  if (left_out.islands == 0 || std::exchange(islands_left_out_, true)) return;
  notices_.push_back(fmt::format(
      "{} islands within view.distance={:.0f} are not drawn, the nearest {:.0f} blocks away: no "
      "more than {} islands can be; lower view.distance",
      left_out.islands, shown.view_blocks, left_out.from_blocks, world::kMaxStreamedIslands));
  log_warning(notices_.back());
}

Result<void> SceneView::load_completely(const Moment& moment, std::optional<double> blend_s) {
  const render::Camera& camera = moment.camera;
  const double world_time_s = moment.world_time_s;
  blends_levels_ = blend_s.has_value();
  if (Result<void> ok = follow_settings(); !ok) return ok;
  do {
    update_streamer(camera, world_time_s);
    streamer_->wait_until_complete();
    while (!streamer_->complete()) take_in(streamer_->poll(kMaxPolledQuads));
    add_waiting(UINT64_MAX);
    if (waiting_.empty()) break;
    renderer_->reclaim();
    add_waiting(UINT64_MAX);
  } while (!waiting_.empty() && show_less(camera));
  renderer_->set_upload_budget(UINT64_MAX);
  choose_levels(camera, world_time_s, {.keep = false, .blend_s = blend_s});
  expect_frame(moment);
  load_light(moment);
  return {};
}

Result<void> SceneView::stream(const Moment& moment, std::optional<double> blend_s) {
  const render::Camera& camera = moment.camera;
  const double world_time_s = moment.world_time_s;
  blends_levels_ = blend_s.has_value();
  if (Result<void> ok = follow_settings(); !ok) return ok;
  const std::uint64_t upload_bytes = upload_bytes_of(blend_s, settings_.upload_budget_bytes);
  renderer_->set_upload_budget(upload_bytes);
  update_streamer(camera, world_time_s);
  if (!std::exchange(streams_, true)) begin_to_stream();
  ++frames_since_lowered_;
  // What was taken in must be on the GPU before more is: memory stays bounded, and an island's slot
  // is not handed on while sections that name it can still be drawn.
  if (renderer_->mesh_uploader().pending_bytes() != 0) return {};
  if (!more_next_frame_) take_in(streamer_->poll(kMaxPolledQuads));
  add_waiting(upload_bytes);
  if (waiting_.empty() && streamer_->complete()) {
    const render::Renderer::WorldMemory memory = renderer_->world_memory();
    fit_.settled(static_cast<double>(memory.used) / static_cast<double>(memory.limit), asked(),
                 place(camera.position));
  } else if (!waiting_.empty() && !more_next_frame_ && frames_since_lowered_ > kFramesToLetGo) {
    show_less(camera);
  }
  choose_levels(camera, world_time_s, {.keep = true, .blend_s = blend_s});
  key_fades_.advance([&](const world::IslandLevel& row) { return key_directions_.contains(row); });
  if (!light_due()) return {};
  find_light(moment, false);
  hand_over_light(moment, upload_bytes);
  return {};
}

/// Frames of half of a view, or before there is light of the sky, would need programs that no later
/// one does.
void SceneView::begin_to_stream() {
  if (island_light_ && settings_.render.indirect != render::Indirect::kOff) indirect_store();
  renderer_->wait_for_programs();
}

/// Whether threads may look for light. The first pictures of a world would wait for them on few
/// cores, so that they begin when a frame has shown something of each island, or cannot.
bool SceneView::light_due() {
  if (frames_without_light_ >= kMostFramesWithoutLight) return true;
  ++frames_without_light_;
  if (streamer_->stats().unshown == 0 || is_full()) frames_without_light_ = kMostFramesWithoutLight;
  return false;
}

/// @return false: no less can be shown; what waits is not drawn.
bool SceneView::show_less(const render::Camera& camera) {
  frames_since_lowered_ = 0;
  if (!fit_.lower(asked(), place(camera.position))) return false;
  const ViewFit::Distances wanted = asked(), shown = fit_.of(wanted);
  notices_.push_back(fmt::format(
      "the memory for the world is full: it is shown {:.0f} blocks far, {:.0f} of them "
      "in full detail, instead of {:.0f} and {:.0f}",
      shown.view_blocks, shown.detail_blocks, wanted.view_blocks, wanted.detail_blocks));
  log_warning(notices_.back());
  return true;
}

/// The device has no memory left for a frame: the world's tables give some of theirs back.
Result<void> SceneView::restart_with_less(const render::Camera& camera, const std::string& why) {
  log_warning(why);
  const std::uint64_t less = static_cast<std::uint64_t>(
      static_cast<double>(renderer_->world_memory().used) * kLessOnRestart);
  sections_.clear();
  islands_.clear();
  first_free_slot_ = 0;
  island_slots_.clear();
  near_slots_.clear();
  cuts_.clear();
  forget_blends();
  waiting_.clear();
  light_field_.remove_sections();
  island_light_.reset();
  if (Result<void> ok = renderer_->restart_world(less); !ok) return ok;
  occupancy_ = nullptr;
  indirect_ = nullptr;
  sky_light_.clear();
  key_fades_.clear();
  weak_lamps_kept_ = false;
  streamer_ = std::make_unique<world::Streamer>(*world_, *jobs_);
  show_less(camera);
  return follow_settings();
}

bool SceneView::occupancy_wanted() const {
  return (settings_.render.ao_strength > 0.0 &&
          settings_.render.shading != render::Shading::kFlat) ||
         settings_.render.lights_shadows != 0 ||
         settings_.render.water_mirror == render::WaterMirror::kWorld;
}

// Occupancy and light are made of what comes along with the meshes, so that all of them are made
// again when one is wanted for the first time, or weak lamps change sides.
Result<void> SceneView::follow_settings() {
  const bool full = settings_.render.indirect == render::Indirect::kFull;
  const bool store = !occupancy_ && occupancy_wanted();
  const bool sky = settings_.render.indirect != render::Indirect::kOff;
  const IslandLight::Finds finds = full  ? IslandLight::Finds::kBounces
                                   : sky ? IslandLight::Finds::kSky
                                         : IslandLight::Finds::kReach;
  const bool light = island_light_ ? sky && island_light_->finds() != finds
                                   : sky || settings_.render.lights_shadows != 0;
  if (!store && !light && full == weak_lamps_kept_) return {};
  forget_blends();
  while (!sections_.empty()) remove_section(sections_.begin()->first);
  waiting_.clear();
  if (store) {
    Result<render::OccupancyStore*> made = renderer_->occupancy();
    if (!made) return made.error();
    occupancy_ = *made;
  }
  if (light && !light_threads_)
    light_threads_ =
        std::make_unique<WorkerThreads>(jobs_->threads(), WorkerThreads::Priority::kLowered);
  if (light)
    island_light_ = std::make_unique<IslandLight>(*light_threads_, finds,
                                                  cache_ ? cache_->light.get() : nullptr);
  weak_lamps_kept_ = full;
  streamer_ =
      std::make_unique<world::Streamer>(*world_, *jobs_, world::StreamOf::kMeshesAndOccupancy);
  return {};
}

void SceneView::take_in(world::StreamUpdate update) {
  // An island all of whose sections are replaced keeps its slot, and its light until there is new.
  std::vector<world::IslandLevel> held;
  for (const world::ReadySection& ready : update.ready)
    if (sections_.contains(ready.key)) held.push_back(ready.key.row());
  for (const world::IslandLevel& row : held) ++islands_[island_slots_.at(row)].sections;
  // Thousands at once when a large island changes its level.
  const std::set<world::SectionKey> removed(update.removed.begin(), update.removed.end());
  std::set<world::SectionKey> kept_on;  // built anew, and shown before
  for (const world::ReadySection& ready : update.ready)
    if (const auto old = sections_.find(ready.key); old != sections_.end()) {
      if (old->second.chosen && removed.contains(ready.key)) kept_on.insert(ready.key);
      if (!old->second.chosen && old->second.shown) blends_.finish(ready.key.island);
      remove_section(ready.key);
    }
  for (const world::SectionKey& key : removed)
    if (sections_.contains(key)) leave_section(key);
  std::erase_if(waiting_,
                [&](const world::ReadySection& ready) { return removed.contains(ready.key); });
  // A section that stands in both lists is built anew, and goes before what is new.
  for (world::ReadySection& ready : update.ready) {
    const world::SectionKey key = ready.key;
    if (removed.contains(key) && add_section(ready)) {
      if (kept_on.contains(key)) {
        fresh_.erase(key);
        blends_.repeat(key);
      }
      continue;
    }
    waiting_.push_back(std::move(ready));
  }
  for (const world::IslandLevel& row : held) release_island(row);
}

/// An island that comes at once, as when its level of detail changes, is copied over several
/// frames: all of it would be tens of milliseconds of one.
void SceneView::add_waiting(std::uint64_t most_bytes) {
  more_next_frame_ = false;
  while (!waiting_.empty() && !is_full()) {
    more_next_frame_ = renderer_->mesh_uploader().pending_bytes() >= most_bytes;
    if (more_next_frame_ || !add_section(waiting_.front())) return;
    waiting_.pop_front();
  }
}

/// Whether what is left is for edits.
bool SceneView::is_full() const {
  const render::Renderer::WorldMemory memory = renderer_->world_memory();
  return static_cast<double>(memory.used) >= (1.0 - kForEdits) * static_cast<double>(memory.limit);
}

void SceneView::remove_section(const world::SectionKey& key) {
  const auto found = sections_.find(key);
  SKERRY_ASSERT(found != sections_.end());
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  light_field_.remove(key);
  light_field_.invalidate_reach(key.island);
  if (island_light_) island_light_->remove(key);
  const auto slot = island_slots_.find(key.row());
  for (const render::SectionId section : found->second.parts)
    renderer_->geometry().remove(uploader, section);
  if (found->second.closing) renderer_->geometry().remove(uploader, *found->second.closing);
  if (occupancy_ && !key.far) occupancy_->remove(uploader, slot->second, chunk_place(key));
  if (!found->second.leaves) cuts_.remove(key);
  sections_.erase(found);
  fresh_.erase(key);
  release_island(key.row());
}

/// One section of it less; the last one takes the level of the island with it.
void SceneView::release_island(const world::IslandLevel& row) {
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  const auto slot = island_slots_.find(row);
  if (--islands_[slot->second].sections != 0) return;
  first_free_slot_ = std::min<std::size_t>(first_free_slot_, slot->second);
  if (occupancy_ && !islands_[slot->second].far) occupancy_->end_island(uploader, slot->second);
  if (indirect_) indirect_->end_island(uploader, slot->second);
  sky_light_.remove(row);
  key_fades_.remove(row);
  if (island_light_) island_light_->end_island(row);
  near_slots_.erase(row);
  island_slots_.erase(slot);
}

Result<void> SceneView::add_section(const world::ReadySection& ready) {
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  const Result<std::uint32_t> slot = island_slot(ready.key);
  if (!slot) return slot.error();
  ++islands_[*slot].sections;
  // Building beyond the island's box widens it.
  if (const auto spec = world_->island(ready.key.island)) islands_[*slot].spec = *spec;
  ResidentSection& section = sections_[ready.key];
  section.seams = ready.seams;
  fresh_.insert(ready.key);
  cuts_.add(ready.key, box_of_faces(ready.key, ready.mesh));
  if (occupancy_ && ready.occupancy.fill != world::ChunkOccupancy::Fill::kEmpty) {
    const render::OccupancyBits bits{ready.occupancy.fill == world::ChunkOccupancy::Fill::kFull,
                                     ready.occupancy.table, ready.occupancy.words};
    if (Result<void> added = occupancy_->add(uploader, *slot, chunk_place(ready.key), bits);
        !added) {
      remove_section(ready.key);
      return added;
    }
  }
  if (!ready.mesh.quads.empty())
    for (const render::SectionPart& part : render::parts_of(
             section_record(ready.key, ready.mesh, *slot), ready.mesh.quads, quads_by_part_)) {
      Result<render::SectionId> added =
          renderer_->geometry().add(uploader, part.section, part.quads);
      if (!added) {
        remove_section(ready.key);
        return added.error();
      }
      section.parts.push_back(*added);
    }
  if (ready.key.far) return {};
  std::vector<LatticeLight> lights = light_field_.lights_of(ready.key, ready.emitters);
  std::vector<world::WeakLamp> weak;
  if (weak_lamps_kept_) weak = take_weak(lights, ready.key.level);
  if (island_light_) island_light_->add(ready.key, light_chunk_of(ready, std::move(weak), lights));
  light_field_.invalidate_reach(ready.key.island);
  light_field_.add_lights(ready.key, std::move(lights));
  light_field_.add_glass(ready.key, world::stained_boxes_of(ready.stained));
  return {};
}

// The slot of a section's island; a new one if this is the first of its sections.
Result<std::uint32_t> SceneView::island_slot(const world::SectionKey& key) {
  if (const auto found = island_slots_.find(key.row()); found != island_slots_.end())
    return found->second;
  while (first_free_slot_ < islands_.size() && islands_[first_free_slot_].sections != 0)
    ++first_free_slot_;
  const auto slot = static_cast<std::uint32_t>(first_free_slot_);
  if (slot == islands_.size()) islands_.emplace_back();
  const std::optional<world::IslandSpec> spec = world_->island(key.island);
  SKERRY_ASSERT(spec.has_value());
  islands_[slot] = {*spec, 0, key.far, key.level};
  if (key.far) {
    open_to_sky(slot);
  } else if (occupancy_) {
    if (Result<void> begun = occupancy_->begin_island(renderer_->mesh_uploader(), slot,
                                                      expected_chunks(*spec, key.level));
        !begun)
      return begun.error();
  }
  island_slots_.emplace(key.row(), slot);
  if (!key.far) near_slots_.emplace(key.row(), slot);
  return slot;
}

/// Of all slots; those without sections are where their last island is.
void SceneView::place_islands(double world_time_s) {
  const world::IslandPoses poses = world_->poses(world_time_s);
  placements_.resize(islands_.size());
  share_calls(islands_.size(), kSlotsAPiece, [&](std::size_t slot) {
    const IslandEntry& entry = islands_[slot];
    const world::Pose pose = poses.of(entry.spec);
    const bool hides = !entry.far && entry.sections != 0;
    placements_[slot] = {fixed(pose.origin),
                         pose.rotation,
                         entry.spec.bounding_radius,
                         entry.far,
                         entry.level,
                         hides ? land_of(entry.spec) : render::IslandLand{},
                         {}};
  });
  for (const auto& [row, slot] : near_slots_) placements_[slot].keyed = key_fades_.of(row);
}

std::vector<PlacedIsland> SceneView::placed_islands(const render::FixedPos& camera) const {
  std::vector<PlacedIsland> out;
  for (const auto& [row, slot] : near_slots_) {
    const render::IslandPlacement& island = placements_[slot];
    const bool main = out.empty() || out.back().id != row.island;
    out.push_back({row.island, slot, glm::mat3_cast(island.rotation),
                   world::difference_blocks(place(island.origin), place(camera)),
                   island.bounding_radius, row.level, main});
  }
  return out;
}

/// Whether lamps count where no surface is, or behind walls; the oracle asks every light.
bool SceneView::lights_count_in_the_open(std::uint32_t medium) const {
  return settings_.render.lights_shadows == 0 || settings_.render.lights_oracle ||
         settings_.render.clouds.coverage > 0.0 || cloud_volumes_ || medium != world::kAir;
}

void SceneView::gather_lights(const Moment& moment, VkExtent2D size, bool in_the_open) {
  const Stopwatch watch;
  light_field_.gather(
      place(moment.camera.position), render::view_of(moment.camera, size.width, size.height),
      placed_islands(moment.camera.position),
      held_light(settings_, light_field_, moment.camera.yaw_deg, moment.world_time_s), in_the_open,
      lights_);
  gather_ms_ = watch.milliseconds();
}

/// The translucent block that the camera is in.
SceneView::Medium SceneView::medium_at(const render::Camera& camera) const {
  for (const auto& [row, slot] : near_slots_) {
    const render::IslandPlacement& island = placements_[slot];
    const glm::dvec3 offset =
        world::difference_blocks(place(camera.position), place(island.origin));
    if (glm::dot(offset, offset) > island.bounding_radius * island.bounding_radius) continue;
    const world::Medium medium =
        world::medium_at(*world_, row.island, glm::inverse(island.rotation) * offset);
    if (medium.block == world::kAir) continue;
    Medium out{medium.block, {}};
    if (medium.below_surface) {
      const world::IVec3& voxel = *medium.below_surface;
      out.surface = {slot, {voxel.x, voxel.y, voxel.z}, medium.light};
    }
    return out;
  }
  return {};
}

double SceneView::reach(const render::FixedPos& camera) const {
  // An island is in as a whole once any of it is within view distance; shadows must reach its far
  // side. In steps, because every step draws all shadow maps anew.
  double reach = settings_.view_distance;
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    if (islands_[i].sections == 0) continue;
    const render::IslandPlacement& island = placements_[i];
    const glm::dvec3 offset = world::difference_blocks(place(island.origin), place(camera));
    reach = std::max(reach, glm::length(offset) + island.bounding_radius);
  }
  return std::ceil(reach / kReachStep) * kReachStep;
}

/// The same, but in play it stays as long as it suffices and is not much too far: near shadows
/// would change whenever an island comes into view or leaves it.
double SceneView::kept_reach(const render::FixedPos& camera) {
  constexpr double kSpare = 3.0 * kReachStep, kTooFar = 2.0 * kSpare;
  const double needed = reach(camera);
  if (!blends_levels_)
    reach_ = needed;
  else if (needed > reach_ || needed + kTooFar < reach_)
    reach_ = needed + kSpare;
  return reach_;
}

std::optional<double> SceneView::adapted_ev(std::optional<double> ev, double seconds) const {
  const std::optional<render::FrameReport>& seen = renderer_->report();
  if (!seen || !seen->metered_ev) return ev;
  return ev ? render::adapted_ev(*ev, *seen->metered_ev, seconds) : double{*seen->metered_ev};
}

/// None if nothing of the island is drawn.
std::optional<render::BlockMarker> SceneView::marker_of(const Moment& moment) const {
  if (!moment.marked) return std::nullopt;
  const auto slot = island_slots_.lower_bound({moment.marked->island, INT32_MIN});
  if (slot == island_slots_.end() || slot->first.island != moment.marked->island)
    return std::nullopt;
  return render::BlockMarker{slot->second, moment.marked->min, moment.marked->max,
                             static_cast<float>(moment.marked->dug)};
}

/// What a frame shows of a world without islands.
render::FrameInput SceneView::empty_input(const Moment& moment) const {
  render::FrameInput input;
  input.camera = moment.camera;
  input.anchor = fixed(world_->origin());
  input.reach_blocks = settings_.view_distance;
  input.sky = render::celestial_at(moment.time_of_day_s, settings_.moon_phase);
  const std::optional<double> ev =
      settings_.exposure_ev ? settings_.exposure_ev : moment.exposure_ev;
  input.exposure_ev.reset();
  if (ev) input.exposure_ev = static_cast<float>(*ev);
  input.meter = !settings_.exposure_ev;
  input.time_s = moment.world_time_s;
  input.freeze_culling = moment.freeze_culling;
  input.capture = moment.capture;
  input.may_lag = moment.may_lag;
  input.count_pixels = moment.count_pixels;
  input.parts = settings_.shadow_samples;
  return input;
}

/// What a frame shows. What it refers to is good until the next call.
render::FrameInput SceneView::frame_input(const Moment& moment, VkExtent2D size) {
  place_islands(moment.world_time_s);
  render::FrameInput input = empty_input(moment);
  input.islands = placements_;
  input.reach_blocks = kept_reach(moment.camera.position);
  const Medium medium = medium_at(moment.camera);
  input.camera_medium = medium.block;
  input.medium_surface = medium.surface;
  gather_lights(moment, size, lights_count_in_the_open(input.camera_medium));
  input.lights = lights_.lights;
  input.light_islands = lights_.islands;
  input.light_reaches = lights_.reaches;
  input.light_panes = lights_.panes;
  input.marker = marker_of(moment);
  return input;
}

/// Has programs made for what is to be drawn, beside what is done before.
void SceneView::expect_frame(const Moment& moment) {
  render::FrameInput input = sections_.empty() ? empty_input(moment) : frame_input(moment, size_);
  input.part = input.parts - 1;
  renderer_->expect(input, settings_.render, size_);
}

Result<std::uint64_t> SceneView::draw(
    const Moment& moment, VkExtent2D size,
    const std::function<void(VkCommandBuffer, gpu::Image& picture)>& after,
    std::span<const VkSemaphoreSubmitInfo> waits, std::span<const VkSemaphoreSubmitInfo> signals) {
  size_ = size;
  render::FrameInput input = frame_input(moment, size);
  const render::RenderSettings& settings = settings_.render;
  for (; input.part + 1 < input.parts; ++input.part)
    if (Result<std::uint64_t> part = renderer_->draw(input, settings, size); !part) return part;
  const Result<std::uint64_t> drawn = renderer_->draw(input, settings, size, after, waits, signals);
  if (drawn || sections_.empty() || input.parts != 1) return drawn;
  // Once more, with what the world gives back; it is streamed in again from the next frame on.
  if (Result<void> ok = restart_with_less(moment.camera, drawn.error().message); !ok)
    return ok.error();
  input.islands = {};
  input.lights = {};
  input.light_islands = {};
  input.marker.reset();
  input.medium_surface.reset();
  return renderer_->draw(input, settings, size, after, waits, signals);
}

}  // namespace skerry::game
