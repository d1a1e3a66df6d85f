#include "engine/render/renderer/frame_steps.h"

#include <array>
#include <utility>
#include <vector>

#include "engine/render/frame/frame_choices.h"
#include "engine/render/light/light_pass.h"
#include "engine/render/light/shadow_pass.h"
#include "engine/render/post/develop_pass.h"
#include "engine/render/post/enlarge_pass.h"
#include "engine/render/post/meter_pass.h"
#include "engine/render/post/resolve_pass.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/geometry_pass.h"
#include "engine/render/sky/cloud_pass.h"
#include "engine/render/sky/sky_pass.h"
#include "engine/render/surface/marker_pass.h"
#include "engine/render/surface/shade_pass.h"

namespace skerry::render {
namespace {

constexpr const char* kAbsent = "";  // for steps whose absence goes without saying
constexpr const char* kNoGeometry = "no geometry is resident";
constexpr const char* kDebugView = "a debug view is shown";

// --- Why a step is left out ---

const char* always(const FramePlan&) {
  return nullptr;
}

const char* needs(bool wanted) {
  return wanted ? nullptr : kAbsent;
}

const char* needs_geometry(const FramePlan& plan) {
  return plan.geometry ? nullptr : kNoGeometry;
}

const char* needs_lit_surfaces(const FramePlan& plan) {
  return !plan.geometry ? kNoGeometry : plan.shows_channel() ? kDebugView : nullptr;
}

const char* needs_lit_scene(const FramePlan& plan) {
  return plan.shows_channel() ? kDebugView : nullptr;
}

const char* needs_water(const FramePlan& plan) {
  const char* why = needs_lit_surfaces(plan);
  return why ? why : plan.contents.features.why_not(Feature::kWater);
}

const char* needs_moved_sky(const FramePlan& plan) {
  return plan.bake_sky ? nullptr : "sun and moon have not moved since the table was made";
}

const char* needs_clouds(const FramePlan& plan) {
  return needs(plan.clouds && !plan.shows_channel());
}

/// Light at fewer pixels is that of lights as well.
const char* needs_lights(const FramePlan& plan) {
  return needs(plan.lights() && !plan.shows_channel() && !plan.sampled());
}

/// Clouds that water mirrors need an eye in the open, and a sky to be mirrored.
const char* needs_mirrored_clouds(const FramePlan& plan) {
  if (const char* why = needs_lit_surfaces(plan)) return why;
  if (const char* why = plan.contents.features.why_not(Feature::kClouds)) return why;
  if (const char* why = plan.contents.features.why_not(Feature::kWater)) return why;
  const bool lit = plan.input.sky.sun_casts || plan.input.sky.moon_casts;
  return !lit || plan.input.camera_medium != 0 ? "no sky is mirrored" : nullptr;
}

const char* needs_samples(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  return samples_per_edge(plan.settings) > 1 ? nullptr : "aa.samples=1";
}

const char* needs_parts(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  return plan.input.parts > 1 ? nullptr : "shadow.samples=1";
}

const char* needs_resolving(const FramePlan& plan) {
  return needs(!needs_samples(plan) || !needs_parts(plan));
}

/// What works on the whole picture's radiance waits for its last part.
const char* needs_whole_radiance(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (plan.direct) return "nothing comes between shading and picture";
  return plan.last_part() ? nullptr : "the picture has parts to come";
}

const char* needs_meter(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (!meters(plan.input, plan.settings)) return "the exposure is given";
  return needs_whole_radiance(plan);
}

const char* needs_bloom(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (plan.settings.bloom.intensity <= 0.0f) return "bloom.intensity=0";
  return needs_whole_radiance(plan);
}

const char* needs_enlarging(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (!plan.enlarged()) return "render.scale=1";
  return plan.last_part() ? nullptr : "the picture has parts to come";
}

template <Fault::In in>
const char* needs_fault(const FramePlan& plan) {
  return needs(plan.input.fault && plan.input.fault->in == in &&
               (in == Fault::In::kSkyTable || !plan.shows_channel()));
}

// --- What a step adds ---

void clear_pixel_stats(FrameAssembly& f) {
  f.graph.add_pass(
      "clear_pixel_stats",
      [&](gpu::PassBuilder& b) {
        f.scene.pixel_stats = b.write(f.scene.pixel_stats, gpu::Use::kTransferWrite);
      },
      [stats = f.scene.pixel_stats](gpu::Commands& c) { c.fill(stats, 0, VK_WHOLE_SIZE, 0); });
}

void cull(FrameAssembly& f) {
  const SceneRefs& scene = f.scene;
  f.draws = add_cull_passes(f.graph, f.pipelines, scene,
                            {scene.section_slots, scene.most_draws,
                             static_cast<std::uint32_t>(f.plan.tables.views.size())});
}

void draw_geometry(FrameAssembly& f) {
  f.geometry = GeometryPass::add(f.graph, f.pipelines, f.scene, *f.draws,
                                 {f.plan.settings.gbuffer, f.plan.contents.cutouts_in_view[0],
                                  samples_per_edge(f.plan.settings) > 1, f.plan.input.capture});
}

void draw_shadows(FrameAssembly& f) {
  std::vector<ShadowDraw> redraw;
  std::uint32_t view = 1;
  for (const ActiveCascade& c : f.plan.shadows.cascades) {
    if (!c.redraw) continue;
    redraw.push_back(
        {view, c.layer, shadow_pass_name(c.body, c.index), f.plan.contents.cutouts_in_view[view]});
    ++view;
  }
  f.shadows = ShadowPass::add(f.graph, f.pipelines, f.scene, *f.draws, f.shadow_maps, redraw);
}

void draw_translucent(FrameAssembly& f) {
  f.layers = TranslucentPass::draw(f.graph, f.pipelines, f.scene, *f.draws, *f.geometry,
                                   f.plan.settings.water_layers);
}

void sort_lights(FrameAssembly& f) {
  const ClusterDepths depths{f.geometry->surfaces(), f.geometry->depth(),
                             f.plan.settings.gbuffer.depth == DepthStore::kD16, f.layers.depth,
                             f.layers.count};
  f.lights = f.owners.light_clusters.add(f.graph, f.pipelines, f.scene, depths,
                                         f.plan.settings.lights_oracle);
}

void show_channel(FrameAssembly& f) {
  (void)DevelopPass::add_debug(
      f.graph, f.pipelines, f.scene,
      {*f.geometry, *f.shadows, f.lights_or_null(), f.plan.settings.debug_view},
      f.owners.picture.image());
}

void light_clouds(FrameAssembly& f) {
  f.scene.clouds = f.owners.clouds.add_light(f.graph, f.pipelines, f.scene, *f.plan.clouds);
}

ShadeIn shade_in(const FramePlan& plan) {
  const FrameFeatures& features = plan.contents.features;
  return {plan.settings.texture_taps, features.has(Feature::kStars), features.has(Feature::kDiscs),
          std::nullopt};
}

void shade(FrameAssembly& f) {
  ShadeIn in = shade_in(f.plan);
  if (f.plan.sampled())
    in.sampled.emplace(SampledLight{f.lights_or_null(), f.plan.settings,
                                    static_cast<std::uint32_t>(f.plan.settings.shading_rate)});
  gpu::Image& picture = f.owners.picture.image();
  if (f.plan.geometry && f.plan.direct)
    f.developed = ShadePass::add_to_picture(f.graph, f.pipelines, f.scene,
                                            {*f.geometry, *f.shadows}, in, picture);
  else if (f.plan.geometry)
    f.shaded = ShadePass::add(f.graph, f.pipelines, f.scene, {*f.geometry, *f.shadows}, in);
  else if (f.plan.direct)
    f.developed = ShadePass::add_sky_only_to_picture(f.graph, f.pipelines, f.scene, in, picture);
  else
    f.shaded = ShadePass::add_sky_only(f.graph, f.pipelines, f.scene, in);
}

void shade_lights(FrameAssembly& f) {
  f.shaded = LightPass::add(f.graph, f.pipelines, f.scene,
                            {*f.geometry, *f.lights, f.plan.settings}, *std::move(f.shaded));
}

void break_sky_table(FrameAssembly& f) {
  f.scene.sky_lut = FaultPass::add(f.graph, f.scene.sky_lut, *f.plan.input.fault);
}

void break_radiance(FrameAssembly& f) {
  f.shaded = FaultPass::add(f.graph, *std::move(f.shaded), *f.plan.input.fault);
}

CloudPass::View cloud_view(FrameAssembly& f) {
  if (!f.geometry) return {};
  return {&*f.geometry, f.shadows->maps(), f.layers.depth[0], f.lights_or_null()};
}

void blend_clouds_behind_water(FrameAssembly& f) {
  f.shaded = CloudPass::add_behind(f.graph, f.pipelines, f.scene, cloud_view(f),
                                   *std::move(f.shaded), f.plan.settings);
}

void mirror_clouds(FrameAssembly& f) {
  f.layers.mirrored_clouds =
      CloudPass::add_mirrored(f.graph, f.pipelines, f.scene, cloud_view(f), f.layers);
}

void shade_translucent(FrameAssembly& f) {
  f.shaded = TranslucentPass::add(f.graph, f.pipelines, f.scene,
                                  {*f.geometry, *f.shadows, f.layers, f.lights_or_null(),
                                   f.plan.settings, f.plan.input.camera_medium != 0},
                                  *std::move(f.shaded));
}

void blend_clouds(FrameAssembly& f) {
  f.shaded = CloudPass::add(f.graph, f.pipelines, f.scene, cloud_view(f), *std::move(f.shaded),
                            f.plan.settings);
}

void resolve(FrameAssembly& f) {
  Picture& picture = f.owners.picture;
  f.shaded = ResolvePass::add(f.graph, f.pipelines, f.scene, *std::move(f.shaded),
                              {samples_per_edge(f.plan.settings), picture.image().desc().extent,
                               f.plan.input.part, f.plan.input.parts, picture.total()});
}

void capture_radiance(FrameAssembly& f) {
  f.owners.captures.add(f.graph, Capture::kRadiance, f.shaded->radiance());
}

void meter(FrameAssembly& f) {
  f.metered = MeterPass::add(f.graph, f.pipelines, f.scene, f.shaded->radiance(),
                             f.plan.settings.meter, !f.plan.input.exposure_ev);
}

void bloom(FrameAssembly& f) {
  f.bloom =
      BloomPass::add(f.graph, f.pipelines, f.scene, f.shaded->radiance(), f.plan.settings.bloom);
}

void develop(FrameAssembly& f) {
  f.developed = DevelopPass::add(f.graph, f.pipelines, f.scene, *std::move(f.shaded),
                                 f.bloom ? &*f.bloom : nullptr, f.owners.picture.image());
}

void show_exposure(FrameAssembly& f) {
  f.developed = MeterPass::show(f.graph, f.pipelines, f.scene, *std::move(f.developed), f.metered,
                                f.plan.settings.meter);
}

void draw_marker(FrameAssembly& f) {
  f.developed = MarkerPass::add(f.graph, f.pipelines, f.scene, *f.geometry, *std::move(f.developed),
                                *f.plan.marker);
}

void enlarge(FrameAssembly& f) {
  f.developed = EnlargePass::add(f.graph, f.pipelines, f.scene, *std::move(f.developed),
                                 f.owners.picture.shown());
}

void capture_geometry(FrameAssembly& f) {
  Captures& captures = f.owners.captures;
  if (f.plan.settings.gbuffer.depth == DepthStore::kD32)
    captures.add(f.graph, Capture::kDepth, f.geometry->depth());
  captures.add(f.graph, Capture::kSurfaces, f.geometry->surfaces());
  if (f.shadows->maps()) captures.add(f.graph, Capture::kShadowMaps, f.shadows->maps());
}

// --- The frame ---

using Names = std::string_view;
constexpr std::array kCullNames{Names("clear_cull_stats"), Names("cull_sections"),
                                Names("cull_scan"), Names("cull_emit")};
constexpr std::array kGeometryNames{Names("draw_geometry")};
constexpr std::array kShadowNames{Names("draw_shadow_sun"), Names("draw_shadow_moon")};
constexpr std::array kSkyNames{Names("bake_sky")};
constexpr std::array kLayerNames{Names("draw_translucent")};
constexpr std::array kSurfaceNames{Names("classify_tiles"), Names("shade_surfaces")};
constexpr std::array kShadeNames{Names("shade_sky")};
constexpr std::array kMirrorNames{Names("march_mirrored_clouds")};
constexpr std::array kTranslucentNames{Names("classify_translucent_tiles"),
                                       Names("shade_translucent")};
constexpr std::array kSampleNames{Names("average_samples")};
constexpr std::array kPartNames{Names("accumulate_part")};
constexpr std::array kMeterNames{Names("meter_radiance"), Names("choose_exposure")};
constexpr std::array kBloomNames{Names("shrink_bloom"), Names("spread_bloom")};
constexpr std::array kDevelopNames{Names("develop")};
constexpr std::array kEnlargeNames{Names("enlarge_picture")};

/// A row that adds nothing says why passes are absent that another row adds.
void nothing(FrameAssembly&) {}

constexpr std::array kSteps{
    FrameStep{{}, always, clear_pixel_stats},
    FrameStep{
        kSkyNames, needs_moved_sky,
        [](FrameAssembly& f) { f.scene.sky_lut = add_sky_pass(f.graph, f.pipelines, f.scene); }},
    FrameStep{{}, needs_fault<Fault::In::kSkyTable>, break_sky_table},
    FrameStep{kCullNames, needs_geometry, cull},
    FrameStep{kGeometryNames, needs_geometry, draw_geometry},
    FrameStep{kShadowNames, needs_geometry, draw_shadows},
    FrameStep{kLayerNames, needs_water, draw_translucent},
    FrameStep{{}, [](const FramePlan& p) { return needs(p.lights()); }, sort_lights},
    FrameStep{{}, [](const FramePlan& p) { return needs(p.shows_channel()); }, show_channel},
    FrameStep{{}, needs_clouds, light_clouds},
    FrameStep{kSurfaceNames, needs_lit_surfaces, nothing},
    FrameStep{kShadeNames, needs_lit_scene, shade},
    FrameStep{{}, needs_lights, shade_lights},
    FrameStep{{}, needs_fault<Fault::In::kShaded>, break_radiance},
    FrameStep{{},
              [](const FramePlan& p) { return needs(!needs_clouds(p) && !needs_water(p)); },
              blend_clouds_behind_water},
    FrameStep{kMirrorNames, needs_mirrored_clouds, mirror_clouds},
    FrameStep{kTranslucentNames, needs_water, shade_translucent},
    FrameStep{{},
              [](const FramePlan& p) {
                return needs(!needs_clouds(p) && (!p.geometry || p.input.camera_medium == 0));
              },
              blend_clouds},
    FrameStep{{}, needs_fault<Fault::In::kLookedThrough>, break_radiance},
    FrameStep{kSampleNames, needs_samples, nothing},
    FrameStep{kPartNames, needs_parts, nothing},
    FrameStep{{}, needs_resolving, resolve},
    FrameStep{{},
              [](const FramePlan& p) { return needs(p.input.capture && !needs_whole_radiance(p)); },
              capture_radiance},
    FrameStep{kMeterNames, needs_meter, meter},
    FrameStep{kBloomNames, needs_bloom, bloom},
    FrameStep{kDevelopNames, needs_whole_radiance, develop},
    FrameStep{{},
              [](const FramePlan& p) {
                return needs(p.settings.debug_view == DebugView::kExposure && !needs_meter(p));
              },
              show_exposure},
    FrameStep{{}, [](const FramePlan& p) { return needs(p.marker && p.last_part()); }, draw_marker},
    FrameStep{kEnlargeNames, needs_enlarging, enlarge},
    FrameStep{{},
              [](const FramePlan& p) { return needs(p.input.capture && p.geometry); },
              capture_geometry},
};

}  // namespace

std::span<const FrameStep> frame_steps() {
  return kSteps;
}

}  // namespace skerry::render
