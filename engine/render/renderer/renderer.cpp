#include "engine/render/renderer/renderer.h"

#include <algorithm>
#include <cstring>

#include "engine/core/check.h"
#include "engine/gpu/frame_ring.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/light/light_pass.h"
#include "engine/render/light/shadow_maps.h"
#include "engine/render/light/shadow_pass.h"
#include "engine/render/post/capture.h"
#include "engine/render/post/develop_pass.h"
#include "engine/render/post/picture.h"
#include "engine/render/renderer/frame_contents.h"
#include "engine/render/renderer/frame_readback.h"
#include "engine/render/renderer/frame_resources.h"
#include "engine/render/renderer/frame_tables.h"
#include "engine/render/scene/cull_pass.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/geometry_pass.h"
#include "engine/render/sky/cloud_pass.h"
#include "engine/render/sky/clouds.h"
#include "engine/render/sky/sky_model.h"
#include "engine/render/sky/sky_pass.h"
#include "engine/render/surface/marker_pass.h"
#include "engine/render/surface/shade_pass.h"
#include "engine/render/surface/translucent_pass.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kFramesInFlight = 2;
constexpr std::array<const char*, 8> kShadowPassNames{
    "draw_shadow_sun_0",  "draw_shadow_sun_1",  "draw_shadow_sun_2",  "draw_shadow_sun_3",
    "draw_shadow_moon_0", "draw_shadow_moon_1", "draw_shadow_moon_2", "draw_shadow_moon_3"};

/// What one frame in flight owns.
struct Slot {
  std::uint64_t value = 0;  // timeline value that completes it; 0: not in flight
  FrameReadback readback;
  std::uint32_t part = 0;                   // see FrameInput
  std::uint32_t lights = 0;                 // in view
  std::optional<shared::ClusterGrid> grid;  // of the lights it sorted
  gpu::FrameCounts counts{};
  int pipelines_created = 0;
  std::uint64_t memory_bytes = 0;
};

void add_times(const FrameReport& earlier, FrameReport& to) {
  to.gpu_ms += earlier.gpu_ms;
  for (const gpu::PassTime& pass : earlier.passes) {
    const auto same = std::find_if(to.passes.begin(), to.passes.end(),
                                   [&](const gpu::PassTime& p) { return p.name == pass.name; });
    if (same == to.passes.end())
      to.passes.push_back(pass);
    else
      same->ms += pass.ms;
  }
}

}  // namespace

struct Renderer::State {
  State(gpu::Device& d, const RendererDesc& desc)
      : device(d),
        pipelines(d),
        graph(&d),
        frame_uploader(d, desc.upload_path),
        mesh_uploader(d, desc.upload_path),
        resources(d),
        shadows(d),
        light_clusters(d),
        clouds(d),
        captures(d),
        picture(d),
        ring(d, kFramesInFlight),
        upload_budget(desc.upload_budget_bytes) {}

  Result<void> create(const RendererDesc& desc);
  void take_report(std::uint32_t slot_index);
  SceneRefs import_scene(const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
                         const FrameTables& tables);
  void build(const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
             const FrameTables& tables, const FrameContents& contents,
             std::span<const ActiveCascade> cascades, const shared::SkyConstants& sky_now,
             Slot& slot);
  void explain_absent(const FrameFeatures& features);
  void add_clouds(SceneRefs& scene, const FrameFeatures& features);
  std::optional<ClusteredLights> add_lights(const SceneRefs& scene, const Geometry& surfaces,
                                            const TranslucentPass::Layers& layers,
                                            const RenderSettings& settings,
                                            const FrameContents& contents, Slot& slot);
  Shadows add_shadows(const SceneRefs& scene, const CulledDraws& draws,
                      const RenderSettings& settings, const FrameContents& contents,
                      std::span<const ActiveCascade> cascades);
  std::optional<Developed> finish(SceneRefs& scene, Shaded shaded, const FrameInput& input,
                                  const RenderSettings& settings) {
    return picture.finish(graph, pipelines, captures, scene, std::move(shaded), input, settings);
  }
  void add_marker(const SceneRefs& scene, const Geometry& surfaces, Developed developed,
                  const FrameInput& input);

  gpu::Device& device;
  gpu::Pipelines pipelines;
  gpu::FrameGraph graph;
  gpu::Uploader frame_uploader, mesh_uploader;
  FrameResources resources;
  std::unique_ptr<GeometryStore> geometry;
  std::unique_ptr<OccupancyStore> occupancy;  // null: never asked for
  ShadowMaps shadows;
  LightClusters light_clusters;
  Clouds clouds;
  Captures captures;
  Picture picture;
  gpu::FrameRing ring;
  std::uint64_t upload_budget;
  std::optional<shared::SkyConstants> baked_sky;
  std::array<Slot, kFramesInFlight> slots;
  std::uint32_t last_slot = 0;
  std::optional<FrameReport> report;
  std::optional<std::pair<shared::CullView, FixedPos>> frozen;
};

Result<void> Renderer::State::create(const RendererDesc& desc) {
  Result<std::unique_ptr<GeometryStore>> store = GeometryStore::create(device, desc.arena_quads);
  if (!store) return store.error();
  geometry = *std::move(store);
  if (Result<void> ok = resources.create(frame_uploader, desc.materials); !ok) return ok;
  for (Slot& slot : slots)
    if (Result<void> ok = slot.readback.create(device); !ok) return ok;
  return {};
}

SceneRefs Renderer::State::import_scene(const FrameInput& input, const RenderSettings& settings,
                                        VkExtent2D size, const FrameTables& tables) {
  SceneRefs s = resources.import(graph, input, settings, size, tables);
  s.quads = graph.import(geometry->quads());
  s.sections = graph.import(geometry->sections());
  if (occupancy) {
    s.occupancy_grids = graph.import(occupancy->grids());
    s.occupancy_tables = graph.import(occupancy->tables());
    s.occupancy_words = graph.import(occupancy->words());
    if (settings.traced_lights != 0 && !input.light_islands.empty())
      s.light_islands = resources.import_light_islands(graph);
    s.corners = settings.corner_darkening > 0.0f && !settings.flat_shading;
  }
  return s;
}

Shadows Renderer::State::add_shadows(const SceneRefs& scene, const CulledDraws& draws,
                                     const RenderSettings& settings, const FrameContents& contents,
                                     std::span<const ActiveCascade> cascades) {
  std::vector<ShadowDraw> redraw;
  std::uint32_t view = 1;
  for (const ActiveCascade& c : cascades) {
    const char* name = kShadowPassNames[static_cast<std::size_t>(c.body * kCascadeCount + c.index)];
    if (c.redraw) {
      redraw.push_back({view, c.layer, name, contents.cutouts_in_view[view]});
      ++view;
    } else
      graph.leave_out(
          name, "kept from an earlier frame: light, window, geometry and islands have not moved");
  }
  for (const Feature body : {Feature::kSun, Feature::kMoon}) {
    const char* name = body == Feature::kSun ? "draw_shadow_sun" : "draw_shadow_moon";
    if (const char* why = contents.features.why_not(body))
      graph.leave_out(name, why);
    else if (!settings.shadows)
      graph.leave_out(name, "shadow.enabled=0");
  }
  return ShadowPass::add(graph, pipelines, scene, draws, shadows.maps(), redraw);
}

void Renderer::State::add_marker(const SceneRefs& scene, const Geometry& surfaces,
                                 Developed developed, const FrameInput& input) {
  if (!input.marker) return;
  const std::optional<shared::MarkerConstants> marker =
      marker_constants(*input.marker, input.islands[input.marker->island], input.camera,
                       picture.image().desc().extent);
  if (marker)
    (void)MarkerPass::add(graph, pipelines, scene, surfaces, std::move(developed), *marker);
}

void Renderer::State::build(const FrameInput& input, const RenderSettings& settings,
                            VkExtent2D size, const FrameTables& tables,
                            const FrameContents& contents, std::span<const ActiveCascade> cascades,
                            const shared::SkyConstants& sky_now, Slot& slot) {
  graph.begin();
  SceneRefs scene = import_scene(input, settings, size, tables);
  graph.add_pass(
      "clear_pixel_stats",
      [&](gpu::PassBuilder& b) {
        scene.pixel_stats = b.write(scene.pixel_stats, gpu::Use::kTransferWrite);
      },
      [stats = scene.pixel_stats](gpu::Commands& c) { c.fill(stats, 0, VK_WHOLE_SIZE, 0); });
  const FrameFeatures& features = contents.features;
  explain_absent(features);
  if (!meters(input, settings) && !shows_channel(settings))
    for (const char* name : {"meter_radiance", "choose_exposure"})
      graph.leave_out(name, "the exposure is given");
  if (!shows_channel(settings) && settings.bloom.intensity <= 0.0f)
    for (const char* name : {"shrink_bloom", "spread_bloom"})
      graph.leave_out(name, "bloom.intensity=0");
  scene.haze = features.has(Feature::kHaze);
  if (!scene.corners)
    graph.leave_out("corners", settings.flat_shading ? "shading=flat" : "ao.strength=0");
  const ShadeIn shade_in{settings.texture_taps, features.has(Feature::kStars),
                         features.has(Feature::kDiscs)};
  const bool sky_moved = !baked_sky || std::memcmp(&*baked_sky, &sky_now, sizeof(sky_now)) != 0;
  baked_sky = sky_now;
  if (sky_moved)
    scene.sky_lut = add_sky_pass(graph, pipelines, scene);
  else
    graph.leave_out("bake_sky", "sun and moon have not moved since the table was made");

  if (input.fault && input.fault->in == Fault::In::kSkyTable) {
    scene.sky_lut = FaultPass::add(graph, scene.sky_lut, *input.fault);
    baked_sky.reset();
  }

  const auto view_count = static_cast<std::uint32_t>(tables.views.size());
  if (geometry->sections_resident() == 0) {
    for (const char* name :
         {"clear_cull_stats", "cull_sections", "cull_scan", "cull_emit", "draw_geometry",
          "draw_shadow_sun", "draw_shadow_moon", "classify_tiles_clear", "classify_tiles",
          "shade_surfaces", "draw_translucent", "classify_translucent_tiles", "shade_translucent"})
      graph.leave_out(name, "no geometry is resident");
    if (by_radiance(input, settings, features)) {
      add_clouds(scene, features);
      Shaded shaded = ShadePass::add_sky_only(graph, pipelines, scene, shade_in);
      if (scene.clouds)
        shaded = CloudPass::add(graph, pipelines, scene, {}, std::move(shaded), settings);
      (void)finish(scene, std::move(shaded), input, settings);
    } else {
      graph.leave_out("develop", "nothing comes between shading and picture");
      (void)ShadePass::add_sky_only_to_picture(graph, pipelines, scene, shade_in, picture.image());
    }
    slot.readback.add(graph, scene, nullptr, 0, {});
    return;
  }
  const CulledDraws draws = add_cull_passes(
      graph, pipelines, scene, {geometry->section_slots(), geometry->quads_resident(), view_count});
  Geometry surfaces = GeometryPass::add(graph, pipelines, scene, draws, contents.cutouts_in_view[0],
                                        samples_per_edge(settings) > 1, settings.gbuffer);
  Shadows maps = add_shadows(scene, draws, settings, contents, cascades);
  const bool debug = shows_channel(settings);
  const char* no_translucent = features.why_not(Feature::kWater);
  TranslucentPass::Layers layers;
  if (!debug && !no_translucent)
    layers = TranslucentPass::draw(graph, pipelines, scene, draws, surfaces,
                                   settings.translucent_layers);
  const std::optional<ClusteredLights> lights =
      add_lights(scene, surfaces, layers, settings, contents, slot);
  if (debug) {
    (void)DevelopPass::add_debug(graph, pipelines, scene, surfaces, maps,
                                 lights ? &*lights : nullptr, settings.debug_view, picture.image());
    for (const char* name :
         {"classify_tiles", "shade_surfaces", "shade_sky", "draw_translucent", "shade_translucent",
          "meter_radiance", "choose_exposure", "shrink_bloom", "spread_bloom", "develop"})
      graph.leave_out(name, "a debug view is shown");
  } else {
    if (no_translucent)
      for (const char* name :
           {"draw_translucent", "classify_translucent_tiles", "shade_translucent"})
        graph.leave_out(name, no_translucent);
    if (no_translucent && !by_radiance(input, settings, features)) {
      graph.leave_out("develop", "nothing comes between shading and picture");
      add_marker(scene, surfaces,
                 ShadePass::add_to_picture(graph, pipelines, scene, surfaces, maps, shade_in,
                                           picture.image()),
                 input);
    } else {
      add_clouds(scene, features);
      Shaded shaded = ShadePass::add(graph, pipelines, scene, surfaces, maps, shade_in);
      if (lights)
        shaded =
            LightPass::add(graph, pipelines, scene, surfaces, *lights, std::move(shaded), settings);
      if (input.fault && input.fault->in == Fault::In::kShaded)
        shaded = FaultPass::add(graph, std::move(shaded), *input.fault);
      const CloudPass::View view{&surfaces, maps.maps(), layers.depth[0],
                                 lights ? &*lights : nullptr};
      if (scene.clouds && layers.count != 0)
        shaded = CloudPass::add_behind(graph, pipelines, scene, view, std::move(shaded), settings);
      if (scene.clouds && layers.count == 0)
        graph.leave_out("march_mirrored_clouds", no_translucent);
      else if (scene.clouds && (scene.bodies == 0 || input.camera_medium != 0))
        graph.leave_out("march_mirrored_clouds", "no sky is mirrored");
      else if (scene.clouds)
        layers.mirrored_clouds = CloudPass::add_mirrored(graph, pipelines, scene, view, layers);
      if (!no_translucent)
        shaded = TranslucentPass::add(graph, pipelines, scene, surfaces, maps, layers,
                                      lights ? &*lights : nullptr, std::move(shaded), settings,
                                      input.camera_medium != 0);
      if (scene.clouds && input.camera_medium == 0)
        shaded = CloudPass::add(graph, pipelines, scene, view, std::move(shaded), settings);
      if (std::optional<Developed> developed = finish(scene, std::move(shaded), input, settings))
        add_marker(scene, surfaces, *std::move(developed), input);
    }
  }
  if (input.capture) {
    if (settings.gbuffer.depth == DepthStore::kD32)
      captures.add(graph, Capture::kDepth, surfaces.depth());
    captures.add(graph, Capture::kSurfaces, surfaces.surfaces());
    if (maps.maps()) captures.add(graph, Capture::kShadowMaps, maps.maps());
  }
  slot.readback.add(graph, scene, &draws.stats, view_count,
                    slot.grid ? light_clusters.work() : gpu::BufferRef{});
}

/// Clouds of the frame, if it has any, and what light comes through them.
void Renderer::State::add_clouds(SceneRefs& scene, const FrameFeatures& features) {
  if (features.has(Feature::kClouds)) scene.clouds = clouds.add_light(graph, pipelines, scene);
}

void Renderer::State::explain_absent(const FrameFeatures& features) {
  for (std::size_t i = 0; i < kFeatureNames.size(); ++i)
    if (const char* why = features.why_not(static_cast<Feature>(i)))
      graph.leave_out(std::string(kFeatureNames[i]), why);
}

/// Sorts the frame's lights, if it has any. Debug views of other things need none.
std::optional<ClusteredLights> Renderer::State::add_lights(
    const SceneRefs& scene, const Geometry& surfaces, const TranslucentPass::Layers& layers,
    const RenderSettings& settings, const FrameContents& contents, Slot& slot) {
  const bool wanted = !shows_channel(settings) || settings.debug_view == DebugView::kClusters ||
                      settings.debug_view == DebugView::kLightCount;
  if (!wanted || !contents.features.has(Feature::kLights)) return std::nullopt;
  const ClusterDepths depths{surfaces.surfaces(), surfaces.depth(),
                             settings.gbuffer.depth == DepthStore::kD16, layers.depth,
                             layers.count};
  const ClusteredLights lights =
      light_clusters.add(graph, pipelines, scene, depths, settings.lights_oracle);
  if (!settings.lights_oracle) slot.grid = light_clusters.grid();
  return lights;
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
  r.memory_bytes = slot.memory_bytes;
  if (slot.part != 0 && report) add_times(*report, r);
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
    const FrameInput& asked, const RenderSettings& settings, VkExtent2D size,
    const std::function<void(VkCommandBuffer, gpu::Image& picture)>& after,
    std::span<const VkSemaphoreSubmitInfo> waits, std::span<const VkSemaphoreSubmitInfo> signals) {
  State& s = *state_;
  FrameInput input = asked;
  input.sky = sky_without(asked.sky, settings.leave_out);
  if (shows_channel(settings)) input.part = 0, input.parts = 1;
  if (input.part + 1 != input.parts) input.capture = false;
  if (settings.leave_out.has(Feature::kWater)) input.camera_medium = 0;
  SKERRY_ASSERT(input.islands.size() <= shared::kMaxIslands);
  if (Result<void> ok = s.picture.resize(size, samples_per_edge(settings), input.parts); !ok)
    return ok.error();
  const auto samples = static_cast<std::uint32_t>(samples_per_edge(settings));
  const VkExtent2D drawn{size.width * samples, size.height * samples};
  if (Result<void> ok = check_store(s.device, settings.gbuffer); !ok) return ok.error();
  if (Result<void> ok = check_draws(
          most_draws(s.geometry->section_slots(), s.geometry->quads_resident()), s.device.limits());
      !ok)
    return ok.error();

  const shared::SkyConstants sky_now = sky_constants(input.sky);
  input.sky = sky_of_part(input.sky, input.part, input.parts);
  const Result<std::span<const ActiveCascade>> cascades =
      s.geometry->sections_resident() == 0
          ? std::span<const ActiveCascade>{}
          : s.shadows.update(input, settings, s.geometry->changes());
  if (!cascades) return cascades.error();
  if (input.capture)
    if (Result<void> ok = s.captures.begin(size, drawn, s.geometry->sections_resident() != 0,
                                           cascades->empty() ? nullptr : s.shadows.maps());
        !ok)
      return ok.error();
  FrameTables tables = build_tables(input, settings, drawn, *cascades);
  tables.constants.picture_size = {size.width, size.height};
  const FrameContents contents =
      contents_of(input, settings, tables, sky_now, *s.geometry, s.clouds.has_volumes());
  if (!input.freeze_culling)
    s.frozen.reset();
  else if (!s.frozen)
    s.frozen = {tables.views[0], input.camera.position};
  if (s.frozen) {
    tables.views[0] = s.frozen->first;
    shift_view(tables.views[0], s.frozen->second, input.camera.position);
  }
  if (Result<void> ok = s.resources.upload(s.frame_uploader, tables, input, sky_now); !ok)
    return ok.error();
  if (!contents.lights.empty())
    if (Result<void> ok = s.light_clusters.upload(
            s.frame_uploader, contents.lights, view_of(input.camera, drawn.width, drawn.height),
            {drawn, marked_slices(input, contents), settings.light_tile});
        !ok)
      return ok.error();
  if (contents.features.has(Feature::kClouds))
    if (Result<void> ok = s.clouds.prepare(s.frame_uploader, input, settings, sky_now); !ok)
      return ok.error();
  if (s.occupancy && settings.traced_lights != 0 && !input.light_islands.empty())
    if (Result<void> ok = s.resources.upload_light_islands(s.frame_uploader, input); !ok)
      return ok.error();

  const gpu::FrameRing::Frame frame = s.ring.begin();
  Slot& slot = s.slots[frame.slot];
  s.take_report(frame.slot);
  slot.grid.reset();
  slot.lights = static_cast<std::uint32_t>(contents.lights.size());
  s.geometry->collect();
  if (s.occupancy) s.occupancy->collect();
  s.frame_uploader.record(frame.commands, UINT64_MAX);
  s.mesh_uploader.record(frame.commands, s.upload_budget);
  // Maps drawn while meshes still wait for their turn will lack them.
  if (s.mesh_uploader.pending_bytes() != 0) s.shadows.forget();
  s.build(input, settings, drawn, tables, contents, *cascades, sky_now, slot);
  s.graph.compile();
  if (const std::optional<Error> failure = s.graph.allocation_failure()) {
    s.ring.submit();
    s.shadows.forget();
    s.clouds.forget();
    s.baked_sky.reset();
    return *failure;
  }
  s.graph.execute(frame.commands, frame.slot);
  slot.part = input.part;
  slot.counts = s.graph.counts();
  slot.pipelines_created = s.pipelines.created();
  slot.memory_bytes = s.device.memory_total();
  if (after) after(frame.commands, s.picture.image());
  slot.value = s.ring.submit(waits, signals);
  s.last_slot = frame.slot;
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
void Renderer::set_upload_budget(std::uint64_t bytes) {
  state_->upload_budget = bytes;
}
Result<OccupancyStore*> Renderer::occupancy() {
  if (!state_->occupancy) {
    Result<std::unique_ptr<OccupancyStore>> made = OccupancyStore::create(state_->device);
    if (!made) return made.error();
    state_->occupancy = *std::move(made);
  }
  return state_->occupancy.get();
}
gpu::Uploader& Renderer::mesh_uploader() {
  return state_->mesh_uploader;
}
const gpu::FrameGraph& Renderer::graph() const {
  return state_->graph;
}
int Renderer::pipelines_created() const {
  return state_->pipelines.created();
}
gpu::Image& Renderer::picture() {
  return state_->picture.image();
}
Captured Renderer::captured(Capture what) {
  finish();
  return state_->captures.take(what);
}
const std::optional<FrameReport>& Renderer::report() const {
  return state_->report;
}
void Renderer::forget_shadows() {
  state_->shadows.forget();
}

}  // namespace skerry::render
