#include "game/scene_view.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "engine/render/celestial.h"
#include "game/materials.h"
#include "game/player.h"
#include "world/blocks.h"

namespace skerry::game {
namespace {

constexpr std::size_t kMaxPolledQuads = 200'000;  // taken from the workers in one frame
constexpr double kReachStep = 128.0;              // blocks
constexpr std::uint32_t kFirstArenaQuads = 1u << 19;

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

std::uint32_t packed_box(const std::array<std::uint8_t, 3>& corner) {
  return std::uint32_t{corner[0]} | std::uint32_t{corner[1]} << 7 | std::uint32_t{corner[2]} << 14;
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

shared::Section section_record(const world::SectionKey& key, const world::ChunkMesh& mesh,
                               std::uint32_t island) {
  shared::Section section{};
  const std::int32_t edge = world::kChunkEdge << key.level;
  section.origin = {key.chunk.x * edge, key.chunk.y * edge, key.chunk.z * edge};
  section.island = island;
  section.voxel_size_log2 = static_cast<std::uint32_t>(key.level);
  section.bounds_min = packed_box(mesh.bounds_min);
  section.bounds_max = packed_box(mesh.bounds_max);
  std::copy(mesh.range_end.begin(), mesh.range_end.end(), section.range_end);
  return section;
}

}  // namespace

SceneView::SceneView(const SceneOptions& options) : settings_(options.settings) {
  jobs_ = std::make_unique<Jobs>(static_cast<int>(settings_.jobs_threads));
  world_ = std::make_unique<world::World>(world::WorldDesc{
      world::seed_from_text(options.seed_text), settings_.world_offset, settings_.world_islands});
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
}

SceneView::~SceneView() = default;

Result<std::unique_ptr<SceneView>> SceneView::create(gpu::Device& device,
                                                     const SceneOptions& options) {
  std::unique_ptr<SceneView> view(new SceneView(options));
  const std::vector<shared::Material> materials = material_table();
  render::RendererDesc desc;
  desc.materials = materials;
  desc.upload_path = upload_path(options.settings.upload_path);
  desc.upload_budget_bytes = options.settings.upload_budget_bytes;
  desc.arena_quads = kFirstArenaQuads;
  Result<std::unique_ptr<render::Renderer>> renderer = render::Renderer::create(device, desc);
  if (!renderer) return renderer.error();
  view->renderer_ = *std::move(renderer);
  return view;
}

Result<void> SceneView::load_completely(const render::Camera& camera, double world_time_s) {
  streamer_->update(
      {place(camera.position), forward_of(camera), world_time_s},
      {static_cast<double>(settings_.view_distance), static_cast<double>(settings_.view_detail)});
  streamer_->wait_until_complete();
  while (!streamer_->complete())
    if (Result<void> taken = take_in(streamer_->poll(kMaxPolledQuads)); !taken) return taken;
  renderer_->set_upload_budget(UINT64_MAX);
  return {};
}

Result<void> SceneView::stream(const render::Camera& camera, double world_time_s) {
  renderer_->set_upload_budget(settings_.upload_budget_bytes);
  streamer_->update(
      {place(camera.position), forward_of(camera), world_time_s},
      {static_cast<double>(settings_.view_distance), static_cast<double>(settings_.view_detail)});
  // What was taken in must be on the GPU before more is: memory stays bounded, and an island's slot
  // is not handed on while sections that name it can still be drawn.
  if (renderer_->mesh_uploader().pending_bytes() != 0) return {};
  return take_in(streamer_->poll(kMaxPolledQuads));
}

Result<void> SceneView::take_in(world::StreamUpdate update) {
  render::GeometryStore& store = renderer_->geometry();
  gpu::Uploader& uploader = renderer_->mesh_uploader();
  for (const world::SectionKey& key : update.removed) {
    const auto found = sections_.find(key);
    SKERRY_ASSERT(found != sections_.end());
    store.remove(uploader, found->second);
    sections_.erase(found);
    const auto slot = island_slots_.find(key.island);
    if (--islands_[slot->second].sections == 0) island_slots_.erase(slot);
  }
  for (const world::ReadySection& ready : update.ready) {
    const std::uint32_t slot = island_slot(ready.key.island);
    Result<render::SectionId> added =
        store.add(uploader, section_record(ready.key, ready.mesh, slot), ready.mesh.quads);
    if (!added) return added.error();
    ++islands_[slot].sections;
    sections_.emplace(ready.key, *added);
  }
  return {};
}

std::uint32_t SceneView::island_slot(std::uint64_t island) {
  if (const auto found = island_slots_.find(island); found != island_slots_.end())
    return found->second;
  const auto free = std::find_if(islands_.begin(), islands_.end(),
                                 [](const IslandEntry& entry) { return entry.sections == 0; });
  const auto slot = static_cast<std::uint32_t>(free - islands_.begin());
  if (free == islands_.end()) islands_.emplace_back();
  const std::optional<world::IslandSpec> spec = world_->island(island);
  SKERRY_ASSERT(spec.has_value());
  islands_[slot] = {*spec, 0};
  island_slots_.emplace(island, slot);
  return slot;
}

std::vector<render::IslandPlacement> SceneView::placements(double world_time_s) const {
  std::vector<render::IslandPlacement> out;
  out.reserve(islands_.size());
  for (const IslandEntry& entry : islands_) {
    const world::Pose pose = world::pose_at(entry.spec, world_time_s);
    out.push_back({fixed(pose.origin), pose.rotation, entry.spec.bounding_radius});
  }
  return out;
}

world::BlockId SceneView::medium_at(const render::Camera& camera, double world_time_s) const {
  for (const IslandEntry& entry : islands_) {
    if (entry.sections == 0) continue;
    const world::Pose pose = world::pose_at(entry.spec, world_time_s);
    const glm::dvec3 offset = world::difference_blocks(place(camera.position), pose.origin);
    if (glm::dot(offset, offset) > entry.spec.bounding_radius * entry.spec.bounding_radius)
      continue;
    const glm::dvec3 lattice = glm::inverse(pose.rotation) * offset;
    const world::IVec3 voxel{static_cast<std::int32_t>(std::floor(lattice.x)),
                             static_cast<std::int32_t>(std::floor(lattice.y)),
                             static_cast<std::int32_t>(std::floor(lattice.z))};
    const std::optional<world::BlockId> block = world_->block_at(entry.spec.id, voxel);
    if (block && world::block_kind(*block) == world::BlockKind::kTranslucent) return *block;
  }
  return world::kAir;
}

render::RenderSettings SceneView::render_settings(
    const render::FixedPos& camera, std::span<const render::IslandPlacement> islands) const {
  // An island is in as a whole once any of it is within view distance; shadows must reach its far
  // side. In steps, because every step draws all shadow maps anew.
  double reach = settings_.view_distance;
  for (std::size_t i = 0; i < islands.size(); ++i) {
    if (islands_[i].sections == 0) continue;
    const glm::dvec3 offset = world::difference_blocks(place(islands[i].origin), place(camera));
    reach = std::max(reach, glm::length(offset) + islands[i].bounding_radius);
  }
  render::RenderSettings out;
  out.view_distance_blocks = std::ceil(reach / kReachStep) * kReachStep;
  out.shadows = settings_.shadow_enabled;
  out.shadow_map_size = static_cast<int>(settings_.shadow_size);
  out.shadow_cascades = static_cast<int>(settings_.shadow_cascades);
  out.shadow_taps = static_cast<int>(settings_.shadow_taps);
  out.shadow_split = settings_.shadow_split;
  out.shadow_filter_blocks = static_cast<float>(settings_.shadow_blur);
  out.texture_taps = static_cast<int>(settings_.texture_taps);
  out.flat_shading = settings_.shading == Shading::kFlat;
  out.translucent_layers = static_cast<int>(settings_.water_layers);
  out.gbuffer = settings_.gbuffer;
  out.meter = settings_.meter;
  out.tone = settings_.tone;
  out.display = settings_.display;
  out.bloom = settings_.bloom;
  out.leave_out = settings_.leave_out;
  out.debug_view = settings_.debug_view;
  return out;
}

Result<std::uint64_t> SceneView::draw(
    const Moment& moment, VkExtent2D size,
    const std::function<void(VkCommandBuffer, gpu::Image& picture)>& after,
    std::span<const VkSemaphoreSubmitInfo> waits, std::span<const VkSemaphoreSubmitInfo> signals) {
  const std::vector<render::IslandPlacement> islands = placements(moment.world_time_s);
  render::FrameInput input;
  input.camera = moment.camera;
  input.anchor = fixed(world_->origin());
  input.islands = islands;
  input.sky = render::celestial_at(moment.time_of_day_s, settings_.moon_phase);
  const std::optional<double> ev =
      settings_.exposure_ev ? settings_.exposure_ev : moment.exposure_ev;
  input.exposure_ev.reset();
  if (ev) input.exposure_ev = static_cast<float>(*ev);
  input.meter = !settings_.exposure_ev;
  input.time_s = moment.world_time_s;
  input.camera_medium = medium_at(moment.camera, moment.world_time_s);
  input.freeze_culling = moment.freeze_culling;
  input.capture = moment.capture;
  return renderer_->draw(input, render_settings(moment.camera.position, islands), size, after,
                         waits, signals);
}

}  // namespace skerry::game
