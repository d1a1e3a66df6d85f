#include "engine/render/renderer/renderer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/gpu/graph/frame_ring.h"
#include "engine/gpu/graph/transient_pool.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/renderer/foreseen_plans.h"
#include "engine/render/renderer/frame_readback.h"
#include "engine/render/renderer/frame_resources.h"
#include "engine/render/renderer/frame_steps.h"
#include "engine/render/renderer/plan_frame.h"
#include "engine/render/scene/gbuffer_formats.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kFramesInFlight = 2;
constexpr std::uint64_t kLeastWorldBytes = std::uint64_t{6} << 20;  // what empty tables take, twice

/// What one frame in flight owns.
struct Slot {
  std::uint64_t value = 0;  // timeline value that completes it; 0: not in flight
  FrameReadback readback;
  std::uint32_t part = 0;                   // see FrameInput
  std::uint32_t lights = 0;                 // in view
  std::optional<shared::ClusterGrid> grid;  // of the lights it sorted
  gpu::FrameCounts counts{};
  int pipelines_created = 0, programs_made = 0;
  bool lagged = false;
  std::uint64_t allocations = 0;
  std::uint64_t memory_bytes = 0;
};

void add_earlier(const FrameReport& earlier, FrameReport& to) {
  to.gpu_ms += earlier.gpu_ms;
  to.programs_made += earlier.programs_made;
  to.allocations += earlier.allocations;
  for (const gpu::PassTime& pass : earlier.passes) {
    const auto same = std::find_if(to.passes.begin(), to.passes.end(),
                                   [&](const gpu::PassTime& p) { return p.name == pass.name; });
    if (same == to.passes.end())
      to.passes.push_back(pass);
    else
      same->ms += pass.ms;
  }
}

bool sorts_lights(const FrameAssembly& frame) {
  return frame.lights && !frame.plan.settings.lights_oracle;
}

void add_readback(FrameAssembly& frame, FrameReadback& to) {
  to.add(frame.graph, frame.scene, frame.draws ? &frame.draws->stats : nullptr,
         static_cast<std::uint32_t>(frame.plan.tables.views.size()),
         sorts_lights(frame) ? frame.owners.light_clusters.work() : gpu::BufferRef{});
}

}  // namespace

struct Renderer::State {
  State(gpu::Device& d, const RendererDesc& desc)
      : device(d),
        own_pipelines(desc.pipelines ? nullptr : std::make_unique<gpu::Pipelines>(d)),
        pipelines(desc.pipelines ? *desc.pipelines : *own_pipelines),
        graph(&d),
        frame_uploader(d, desc.upload_path),
        mesh_uploader(d, desc.upload_path),
        resources(d),
        upload_budget(desc.upload_budget_bytes),
        world_budget(desc.world_budget_bytes != 0 ? desc.world_budget_bytes
                                                  : d.limits().heap_bytes / 8 * 5),
        shadows(d),
        light_clusters(d),
        clouds(d),
        captures(d),
        picture(d),
        kept(d),
        ring(d, kFramesInFlight) {}

  Result<void> create(const RendererDesc& desc);
  SceneFacts facts() const;
  Result<void> check(const FramePlan& plan) const;
  Result<void> make_room(const FramePlan& plan);
  Result<void> upload(const FramePlan& plan);
  SceneRefs import_scene(gpu::FrameGraph& to, const FramePlan& plan);
  void add_never_drawn(const FramePlan& supposed, LightClusters& lights, gpu::FrameGraph& to);
  void foresee(const FramePlan& plan);
  bool lacks_programs(const FramePlan& plan);
  void build(const FramePlan& plan, Slot& slot);
  void execute(const gpu::FrameRing::Frame& frame);
  void advance(FramePlan& plan);
  void take_report(std::uint32_t slot_index);

  gpu::Device& device;
  std::unique_ptr<gpu::Pipelines> own_pipelines;  // null: they are others'
  gpu::Pipelines& pipelines;
  gpu::FrameGraph graph;
  bool foresees = false;
  std::optional<FrameNeeds> foreseen;      // that programs are being made for
  std::optional<RenderSettings> drawn_by;  // of the last frame, if it foresaw
  bool lagged = false;                     // the last frame
  gpu::Uploader frame_uploader, mesh_uploader;
  FrameResources resources;
  std::uint64_t upload_budget;
  MemoryBudget world_budget;  // outlives the stores
  GlassBlocks glass;
  std::unique_ptr<GeometryStore> geometry;
  std::unique_ptr<OccupancyStore> occupancy;  // null: never asked for
  std::unique_ptr<IndirectStore> indirect;    // null: never asked for
  ShadowMaps shadows;
  LightClusters light_clusters;
  Clouds clouds;
  std::shared_ptr<const PanoramaSky> panorama;  // none: the sky is the air's
  Captures captures;
  Picture picture;
  KeptFrames kept;
  gpu::FrameRing ring;
  std::function<void(std::uint32_t, std::uint32_t)> progress;  // see step_frames
  FrameHistory history;
  std::uint64_t shown_version = 0;  // of the geometry, when the last mesh was uploaded
  std::array<Slot, kFramesInFlight> slots;
  std::uint32_t last_slot = 0;
  std::optional<FrameReport> report;
};

Result<void> Renderer::State::create(const RendererDesc& desc) {
  glass = glass_among(desc.materials);
  Result<std::unique_ptr<GeometryStore>> store =
      GeometryStore::create(device, world_budget, glass, desc.arena_quads);
  if (!store) return store.error();
  geometry = *std::move(store);
  if (Result<void> ok = resources.create(frame_uploader, desc.materials); !ok) return ok;
  for (Slot& slot : slots)
    if (Result<void> ok = slot.readback.create(device); !ok) return ok;
  return {};
}

SceneFacts Renderer::State::facts() const {
  return {.sections = geometry->records(),
          .translucent_boxes = geometry->translucent_boxes(),
          .glass_boxes = &geometry->glass_boxes(),
          .sections_resident = geometry->sections_resident(),
          .sections_blended = geometry->sections_blended(),
          .quads_resident = geometry->quads_resident(),
          .translucent_quads = geometry->translucent_quads(),
          .cutout_quads = geometry->cutout_quads(),
          .changes = &geometry->changes(),
          .occupancy = occupancy != nullptr,
          .indirect = indirect != nullptr,
          .clouds = clouds.facts(),
          .panorama = panorama,
          .quads_in_view = report ? report->camera.quads_in_view : 0,
          .shadow_generation = shadows.generation(),
          .kept_generation = kept.generation()};
}

/// Whether the device can draw the frame at all.
Result<void> Renderer::State::check(const FramePlan& plan) const {
  if (Result<void> ok = check_store(device, plan.settings.gbuffer); !ok) return ok;
  return check_draws(geometry->most_draws(), device.limits());
}

/// Makes what the frame's passes write to and what outlives them. May fail half-way: what has been
/// made stays, and the history is about what was there before (see generations).
Result<void> Renderer::State::make_room(const FramePlan& plan) {
  // A frame without geometry has nothing to mix, but foresees frames that are mixed.
  const bool mixed = !why_not_temporal(plan.input, plan.settings);
  if (Result<void> ok = picture.resize({plan.shown, plan.picture, mixed},
                                       samples_per_edge(plan.settings), plan.input.parts);
      !ok)
    return ok;
  if (mixed)
    if (Result<void> ok = kept.ensure(plan.drawn); !ok) return ok;
  if (plan.geometry)
    if (Result<void> ok = shadows.ensure(plan.shadows.layout); !ok) return ok;
  if (!plan.input.capture) return {};
  return captures.begin(plan.picture, plan.drawn, plan.geometry,
                        plan.shadows.cascades.empty() ? nullptr : shadows.maps());
}

/// Queues the frame's tables.
Result<void> Renderer::State::upload(const FramePlan& plan) {
  const FrameInput& input = plan.input;
  if (Result<void> ok =
          resources.upload(frame_uploader, plan.tables, input, plan.sky, plan.bake_sky);
      !ok)
    return ok;
  if (!plan.contents.lights.empty())
    if (Result<void> ok = light_clusters.upload(
            frame_uploader, plan.contents.lights, input.light_reaches, input.light_panes,
            view_of(input.camera, plan.drawn.width, plan.drawn.height),
            {plan.drawn, plan.tables.constants.layers_area, plan.marked_slices,
             plan.settings.lights_tile});
        !ok)
      return ok;
  if (plan.temporal)
    if (Result<void> ok = kept.upload(frame_uploader, plan.temporal->motions); !ok) return ok;
  if (!plan.why_one_phase)
    if (Result<void> ok = resources.ensure_seen(frame_uploader, geometry->section_slots()); !ok)
      return ok;
  if (plan.indirect)
    if (Result<void> ok = resources.upload_skies(frame_uploader, plan.sky_light); !ok) return ok;
  if (plan.clouds)
    if (Result<void> ok = clouds.prepare(frame_uploader, *plan.clouds); !ok) return ok;
  if (occupancy && plan.settings.lights_shadows != 0 && !input.light_islands.empty())
    return resources.upload_light_islands(frame_uploader, input);
  return {};
}

SceneRefs Renderer::State::import_scene(gpu::FrameGraph& to, const FramePlan& plan) {
  SceneRefs s = resources.import(to, plan.input, plan.settings, plan.drawn, plan.tables);
  s.quads = to.import(geometry->quads());
  s.sections = to.import(geometry->sections());
  s.section_slots = geometry->section_slots();
  s.most_draws = geometry->most_draws();
  if (!plan.why_one_phase) s.seen_sections = resources.import_seen(to);
  s.haze = plan.contents.features.has(Feature::kHaze);
  s.ao = plan.ao;
  s.sums_floats = device.limits().sums_floats;
  s.on_cpu = device.info().type == VK_PHYSICAL_DEVICE_TYPE_CPU;
  if (plan.indirect) s.indirect_light = plan.settings.indirect;
  s.indirect = to.import(plan.indirect && indirect ? indirect->texels() : resources.no_texels());
  s.island_skies = resources.import_skies(to);
  if (!occupancy) return s;
  s.occupancy_grids = to.import(occupancy->grids());
  s.occupancy_tables = to.import(occupancy->tables());
  s.occupancy_words = to.import(occupancy->words());
  if (plan.settings.lights_shadows != 0 && !plan.input.light_islands.empty())
    s.light_islands = resources.import_light_islands(to);
  return s;
}

/// Adds the plan's steps to the graph.
void Renderer::State::build(const FramePlan& plan, Slot& slot) {
  graph.begin();
  for (const gpu::LeftOut& absent : plan.left_out) graph.leave_out(absent.name, absent.why);
  FrameOwners owners{light_clusters, clouds, captures, picture, kept};
  FrameAssembly frame{
      .graph = graph,
      .pipelines = pipelines,
      .plan = plan,
      .owners = owners,
      .scene = import_scene(graph, plan),
      .shadow_maps = shadows.maps() ? graph.import(*shadows.maps()) : gpu::ImageRef{}};
  for (const std::size_t step : plan.steps) frame_steps()[step].add(frame);
  if (sorts_lights(frame)) slot.grid = light_clusters.grid();
  add_readback(frame, slot.readback);
}

/// Asks for a frame's programs and memory, by adding its steps to a graph that is never drawn.
void Renderer::State::add_never_drawn(const FramePlan& supposed, LightClusters& lights,
                                      gpu::FrameGraph& to) {
  to.begin();
  lights.suppose(light_kinds(supposed.contents.lights),
                 {.size = supposed.drawn, .tile_edge = supposed.settings.lights_tile});
  FrameOwners owners{lights, clouds, captures, picture, kept};
  FrameAssembly frame{.graph = to,
                      .pipelines = pipelines,
                      .plan = supposed,
                      .owners = owners,
                      .scene = import_scene(to, supposed),
                      .shadow_maps = {}};
  frame.scene.section_slots = std::max(frame.scene.section_slots, kUsualSections);
  for (std::size_t list = 0; list < kUsualDraws.size(); ++list)
    frame.scene.most_draws[list] = std::max(frame.scene.most_draws[list], kUsualDraws[list]);
  if (const ShadowLayout& maps = supposed.shadows.layout; maps.layers != 0)
    frame.shadow_maps = to.create({.name = "shadow maps",
                                   .extent = {maps.edge, maps.edge},
                                   .layers = std::max(maps.layers, layers_used(supposed.shadows))});
  for (const std::size_t step : supposed.steps) frame_steps()[step].add(frame);
  FrameReadback unread;
  add_readback(frame, unread);
}

/// Whether a frame would have to wait for a program. They are being made from now on.
bool Renderer::State::lacks_programs(const FramePlan& plan) {
  gpu::FrameGraph never_drawn(nullptr);
  LightClusters no_lights(device);
  return pipelines.prepare([&] { add_never_drawn(plan, no_lights, never_drawn); }) != 0;
}

/// Asks for the programs of frames to come, and makes room for what they need.
void Renderer::State::foresee(const FramePlan& plan) {
  if (!foresees) return;
  const FrameNeeds needs = frame_needs(plan, facts());
  if (foreseen == needs) return;
  foreseen = needs;
  gpu::FrameGraph never_drawn(nullptr);
  gpu::TransientNeeds transients;
  LightClusters no_lights(device);
  pipelines.foresee([&] {
    each_foreseen(plan, needs, [&](const FramePlan& supposed) {
      add_never_drawn(supposed, no_lights, never_drawn);
      never_drawn.compile();
      never_drawn.add_needs(transients);
    });
  });
  graph.reserve(transients);
  light_clusters.reserve();
}

void Renderer::State::execute(const gpu::FrameRing::Frame& frame) {
  if (!progress) return graph.execute(frame.commands, frame.slot);
  std::uint32_t done = 0;
  graph.execute(frame.commands, frame.slot, [&] {
    ring.flush();
    progress(done++, graph.counts().passes);
  });
}

/// The frame has been submitted: what it leaves behind is so from now on.
void Renderer::State::advance(FramePlan& plan) {
  history = std::move(plan.next);
  history.shadows.generation = shadows.generation();
  if (mesh_uploader.pending_bytes() == 0) shown_version = geometry->changes().version();
  // What is drawn while meshes still wait for their turn lacks them.
  history.shadows.only_shows(shown_version);
  const CloudFacts made = clouds.facts();
  if (plan.clouds && plan.clouds->layer) history.clouds.noise_generation = made.noise_generation;
  if (plan.clouds) history.clouds.light_generation = made.light_generation;
  if (!history.temporal) return;
  history.temporal->generation = kept.generation();
  KeptView& last = history.temporal->views[0];
  last.geometry_version = std::min(last.geometry_version, shown_version);
}

void Renderer::State::take_report(std::uint32_t slot_index) {
  Slot& slot = slots[slot_index];
  if (slot.value == 0) return;
  FrameReport r;
  r.passes = graph.times(slot_index);
  for (const gpu::PassTime& pass : r.passes) r.gpu_ms += pass.ms;
  slot.readback.take(r);
  r.lights = slot.lights;
  if (slot.grid) light_clusters.learn(*slot.grid, r.clusters);
  r.counts = slot.counts;
  r.pipelines_created = slot.pipelines_created;
  r.programs_made = slot.programs_made;
  r.lagged = slot.lagged;
  r.allocations = slot.allocations;
  r.memory_bytes = slot.memory_bytes;
  if (slot.part != 0 && report) add_earlier(*report, r);
  report = std::move(r);
  slot.value = 0;
}

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device, const RendererDesc& desc) {
  auto state = std::make_unique<State>(device, desc);
  std::unique_ptr<Renderer> renderer(new Renderer(std::move(state)));
  if (Result<void> ok = renderer->state_->create(desc); !ok) return ok.error();
  return renderer;
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}

Renderer::~Renderer() {
  State& s = *state_;
  for (const Slot& slot : s.slots)
    if (slot.value != 0) s.device.wait(slot.value);
}

Result<std::uint64_t> Renderer::draw(
    const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
    const std::function<void(VkCommandBuffer, gpu::Image& picture)>& after,
    std::span<const VkSemaphoreSubmitInfo> waits, std::span<const VkSemaphoreSubmitInfo> signals) {
  State& s = *state_;
  const int late = s.pipelines.late();
  const std::uint64_t allocations = s.device.allocations();
  FramePlan plan = plan_frame({input, settings, size}, s.facts(), s.history);
  s.lagged = s.foresees && input.may_lag && s.drawn_by && *s.drawn_by != settings &&
             s.lacks_programs(plan);
  if (s.lagged) plan = plan_frame({input, *s.drawn_by, size}, s.facts(), s.history);
  if (Result<void> ok = s.check(plan); !ok) return ok.error();
  if (Result<void> ok = s.make_room(plan); !ok) return ok.error();
  if (Result<void> ok = s.upload(plan); !ok) return ok.error();

  const gpu::FrameRing::Frame frame = s.ring.begin();
  Slot& slot = s.slots[frame.slot];
  s.take_report(frame.slot);
  slot.grid.reset();
  slot.lights = static_cast<std::uint32_t>(plan.contents.lights.size());
  s.geometry->collect();
  if (s.occupancy) s.occupancy->collect();
  if (s.indirect) s.indirect->collect();
  s.frame_uploader.record(frame.commands, UINT64_MAX);
  s.mesh_uploader.record(frame.commands, s.upload_budget);
  s.build(plan, slot);
  s.graph.compile();
  if (const std::optional<Error> failure = s.graph.allocation_failure()) {
    s.ring.submit();  // uploads are on their way; nothing has been drawn
    return *failure;
  }
  s.execute(frame);
  slot.part = plan.input.part;
  slot.counts = s.graph.counts();
  slot.pipelines_created = s.pipelines.used();
  slot.programs_made = s.pipelines.late() - late;
  slot.lagged = s.lagged;
  slot.allocations = s.device.allocations() - allocations;
  slot.memory_bytes = s.device.memory_total();
  if (after) after(frame.commands, s.picture.shown());
  slot.value = s.ring.submit(waits, signals);
  s.last_slot = frame.slot;
  s.foresee(plan);
  if (s.foresees) s.drawn_by = plan.settings;
  s.advance(plan);
  return slot.value;
}

void Renderer::finish() {
  State& s = *state_;
  for (std::uint64_t i = 0; i < kFramesInFlight; ++i) {
    const auto slot_index = static_cast<std::uint32_t>((s.last_slot + 1 + i) % kFramesInFlight);
    if (s.slots[slot_index].value == 0) continue;
    s.device.wait(s.slots[slot_index].value);
    s.take_report(slot_index);
  }
}

GeometryStore& Renderer::geometry() {
  return *state_->geometry;
}
Result<void> Renderer::set_clouds(std::span<const CloudVolumeDesc> volumes,
                                  CloudPrecision precision) {
  return state_->clouds.set_volumes(state_->frame_uploader, volumes, precision);
}
Result<void> Renderer::set_panorama(std::shared_ptr<const PanoramaSky> panorama) {
  finish();
  if (Result<void> ok = state_->resources.set_panorama(state_->frame_uploader,
                                                       panorama ? &panorama->image() : nullptr);
      !ok)
    return ok;
  state_->panorama = std::move(panorama);
  return {};
}
void Renderer::set_upload_budget(std::uint64_t bytes) {
  state_->upload_budget = bytes;
}
Result<OccupancyStore*> Renderer::occupancy() {
  if (!state_->occupancy) {
    Result<std::unique_ptr<OccupancyStore>> made =
        OccupancyStore::create(state_->device, state_->world_budget);
    if (!made) return made.error();
    state_->occupancy = *std::move(made);
  }
  return state_->occupancy.get();
}
Result<IndirectStore*> Renderer::indirect() {
  if (!state_->indirect) {
    Result<std::unique_ptr<IndirectStore>> made =
        IndirectStore::create(state_->device, state_->world_budget);
    if (!made) return made.error();
    state_->indirect = *std::move(made);
  }
  return state_->indirect.get();
}
gpu::Uploader& Renderer::mesh_uploader() {
  return state_->mesh_uploader;
}
Renderer::WorldMemory Renderer::world_memory() const {
  return {state_->geometry->bytes_in_use() +
              (state_->occupancy ? state_->occupancy->bytes_in_use() : 0) +
              (state_->indirect ? state_->indirect->bytes_in_use() : 0),
          state_->world_budget.limit()};
}
void Renderer::reclaim() {
  // An empty submit: removed ranges wait for the one that follows them.
  state_->device.run_now([](VkCommandBuffer) {});
  state_->geometry->collect();
  if (state_->occupancy) state_->occupancy->collect();
  if (state_->indirect) state_->indirect->collect();
}
Result<void> Renderer::restart_world(std::uint64_t bytes) {
  State& s = *state_;
  finish();
  s.mesh_uploader.discard();
  const bool had_occupancy = s.occupancy != nullptr;
  s.geometry.reset();
  s.occupancy.reset();
  s.indirect.reset();
  s.history = {};
  s.shown_version = 0;
  s.device.run_now([](VkCommandBuffer) {});  // the old tables are retired until then
  s.device.collect();
  s.world_budget = MemoryBudget(std::max(bytes, kLeastWorldBytes));
  Result<std::unique_ptr<GeometryStore>> geometry = GeometryStore::create(
      s.device, s.world_budget, s.glass, kLeastWorldBytes / 4 / sizeof(shared::Quad));
  if (!geometry) return geometry.error();
  s.geometry = *std::move(geometry);
  if (had_occupancy)
    if (Result<OccupancyStore*> made = occupancy(); !made) return made.error();
  return {};
}
const gpu::FrameGraph& Renderer::graph() const {
  return state_->graph;
}
int Renderer::pipelines_created() const {
  return state_->pipelines.used();
}
void Renderer::time_passes(bool each) {
  state_->graph.time_passes(each);
}
void Renderer::foresee_programs() {
  state_->foresees = true;
}
void Renderer::expect(const FrameInput& input, const RenderSettings& settings, VkExtent2D size) {
  State& s = *state_;
  SceneFacts facts = s.facts();
  facts.indirect = true;
  FramePlan plan = plan_frame({input, settings, size}, facts, s.history);
  if (!s.check(plan) || !s.make_room(plan)) return;
  const auto ask = [&](const FramePlan& frame) {
    gpu::FrameGraph never_drawn(nullptr);
    LightClusters no_lights(s.device);
    s.add_never_drawn(frame, no_lights, never_drawn);
  };
  s.pipelines.prepare(
      [&] { ask(plan.geometry ? plan : expected_plan(plan, frame_needs(plan, facts))); });
}
bool Renderer::lagged() const {
  return state_->lagged;
}
int Renderer::programs_made() const {
  return state_->pipelines.late();
}
std::size_t Renderer::programs_to_come() const {
  return state_->pipelines.pending();
}
bool Renderer::make_program() {
  return state_->pipelines.help();
}
void Renderer::wait_for_programs() {
  state_->pipelines.wait();
}
gpu::Image& Renderer::picture() {
  return state_->picture.shown();
}
Captured Renderer::captured(Capture what) {
  finish();
  return state_->captures.take(what);
}
const std::optional<FrameReport>& Renderer::report() const {
  return state_->report;
}
void Renderer::step_frames(std::function<void(std::uint32_t, std::uint32_t)> progress) {
  state_->progress = std::move(progress);
}
void Renderer::invalidate_history() {
  state_->history.temporal.reset();
}
void Renderer::invalidate_shadows() {
  state_->history.shadows = {};
}

}  // namespace skerry::render
