#include "engine/render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "engine/core/check.h"
#include "engine/gpu/frame_ring.h"
#include "engine/render/block_textures.h"
#include "engine/render/bloom_pass.h"
#include "engine/render/capture.h"
#include "engine/render/cloud_pass.h"
#include "engine/render/clouds.h"
#include "engine/render/cull_pass.h"
#include "engine/render/develop_pass.h"
#include "engine/render/frame_contents.h"
#include "engine/render/frame_setup.h"
#include "engine/render/gbuffer_formats.h"
#include "engine/render/geometry_pass.h"
#include "engine/render/light_clusters.h"
#include "engine/render/light_pass.h"
#include "engine/render/marker_pass.h"
#include "engine/render/meter_pass.h"
#include "engine/render/resolve_pass.h"
#include "engine/render/shade_pass.h"
#include "engine/render/shadow_maps.h"
#include "engine/render/shadow_pass.h"
#include "engine/render/sky_model.h"
#include "engine/render/sky_pass.h"
#include "engine/render/translucent_pass.h"

namespace skerry::render {
namespace {

constexpr std::uint32_t kFramesInFlight = 2;
constexpr VkBufferUsageFlags kTable =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
    VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
constexpr std::array<const char*, 8> kShadowPassNames{
    "draw_shadow_sun_0",  "draw_shadow_sun_1",  "draw_shadow_sun_2",  "draw_shadow_sun_3",
    "draw_shadow_moon_0", "draw_shadow_moon_1", "draw_shadow_moon_2", "draw_shadow_moon_3"};

/// What one frame in flight owns.
struct Slot {
  std::uint64_t value = 0;   // timeline value that completes it; 0: not in flight
  gpu::Buffer readback;      // CullStats[kViewCount], then PixelStats, Exposure, ClusterWork
  std::uint32_t views = 0;   // entries of CullStats that the frame wrote
  std::uint32_t part = 0;    // see FrameInput
  std::uint32_t lights = 0;  // in view
  std::optional<shared::ClusterGrid> grid;  // of the lights it sorted
  gpu::FrameCounts counts{};
  int pipelines_created = 0;
  std::uint64_t memory_bytes = 0;
};

/// Whether a debug view takes the place of the lit scene.
bool shows_channel(const RenderSettings& settings) {
  return settings.debug_view != DebugView::kNone && settings.debug_view != DebugView::kExposure;
}

/// Samples along a pixel's edge. A debug view shows samples as they are.
int samples_per_edge(const RenderSettings& settings) {
  return shows_channel(settings) ? 1 : settings.samples_per_edge;
}

bool meters(const FrameInput& input, const RenderSettings& settings) {
  return input.meter || !input.exposure_ev || settings.debug_view == DebugView::kExposure;
}

/// Whether the picture takes the way over a radiance image though no pass comes between.
bool by_radiance(const FrameInput& input, const RenderSettings& settings,
                 const FrameFeatures& features) {
  return features.has(Feature::kLights) || features.has(Feature::kClouds) ||
         settings.bloom.intensity > 0.0f || meters(input, settings) || input.capture ||
         input.fault.has_value() || samples_per_edge(settings) > 1 || input.parts > 1;
}

/// Slices of depth in which lights show without a surface: about an eye in water, and in clouds.
std::uint32_t marked_slices(const FrameInput& input, const FrameContents& contents) {
  const std::uint32_t lit =
      contents.features.has(Feature::kClouds) ? slices_lit(contents.lights) : 0u;
  return lit | (input.camera_medium != 0 ? 1u : 0u);
}

/// The sky whose sun and moon stand at the middle of a part's share of their discs: points of a
/// sunflower (H. Vogel, A better way to construct the sunflower head, 1979), which cover it evenly.
Celestial sky_of_part(Celestial sky, std::uint32_t part, std::uint32_t parts) {
  if (parts == 1) return sky;
  constexpr double kGoldenAngle = 2.399963229728653;
  const double radius = static_cast<double>(shared::kBodyRadius) * std::sqrt((part + 0.5) / parts);
  for (glm::dvec3* to_light : {&sky.to_sun, &sky.to_moon}) {
    const std::array<glm::dvec3, 3> axes = light_axes(*to_light);
    *to_light = glm::normalize(*to_light + radius * std::cos(kGoldenAngle * part) * axes[0] +
                               radius * std::sin(kGoldenAngle * part) * axes[1]);
  }
  return sky;
}

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

constexpr std::uint64_t kPixelStatsOffset = shared::kViewCount * sizeof(shared::CullStats);
constexpr std::uint64_t kExposureOffset = kPixelStatsOffset + sizeof(shared::PixelStats);
constexpr std::uint64_t kClusterWorkOffset = kExposureOffset + sizeof(shared::Exposure);

}  // namespace

struct Renderer::State {
  State(gpu::Device& d, const RendererDesc& desc)
      : device(d),
        pipelines(d),
        graph(&d),
        frame_uploader(d, desc.upload_path),
        mesh_uploader(d, desc.upload_path),
        shadows(d),
        light_clusters(d),
        clouds(d),
        captures(d),
        ring(d, kFramesInFlight),
        upload_budget(desc.upload_budget_bytes) {}

  Result<void> create(const RendererDesc& desc);
  Result<gpu::Buffer> table(const char* name, std::uint64_t size_bytes) {
    return device.create_buffer({name, size_bytes, kTable, gpu::Memory::kDevice});
  }
  Result<void> reserve(gpu::Buffer& buffer, const char* name, std::uint64_t size_bytes);
  Result<void> resize(gpu::Image& image, const gpu::ImageDesc& desc);
  Result<void> resize_picture(VkExtent2D size, int samples);
  Result<void> resize_total(VkExtent2D size);
  template <class T>
  Result<void> upload(gpu::Buffer& to, const char* name, std::span<const T> values);
  Result<void> upload_tables(const FrameTables& tables, const FrameInput& input,
                             const shared::SkyConstants& sky);
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
  std::optional<Developed> finish_picture(SceneRefs& scene, Shaded shaded, const FrameInput& input,
                                          const RenderSettings& settings);
  void add_marker(const SceneRefs& scene, const Geometry& surfaces, Developed developed,
                  const FrameInput& input);
  void add_readback(Slot& slot, const SceneRefs& scene, const gpu::BufferRef* cull_stats,
                    std::uint32_t views);

  gpu::Device& device;
  gpu::Pipelines pipelines;
  gpu::FrameGraph graph;
  gpu::Uploader frame_uploader, mesh_uploader;
  std::unique_ptr<GeometryStore> geometry;
  std::unique_ptr<OccupancyStore> occupancy;  // null: never asked for
  ShadowMaps shadows;
  LightClusters light_clusters;
  Clouds clouds;
  Captures captures;
  gpu::FrameRing ring;
  std::uint64_t upload_budget;
  gpu::Buffer frame, sky, islands, view_islands, views, light_islands, materials, indices,
      pixel_stats, exposure;
  gpu::Image block_textures, sky_lut, picture;
  gpu::Image total;  // of a picture's parts; empty when it has one
  VkSampler block_sampler{}, lut_sampler{}, point_sampler{};
  std::optional<shared::SkyConstants> baked_sky;
  std::array<Slot, kFramesInFlight> slots;
  std::uint32_t last_slot = 0;
  std::optional<FrameReport> report;
  std::optional<std::pair<shared::CullView, FixedPos>> frozen;
};

Result<void> Renderer::State::reserve(gpu::Buffer& buffer, const char* name,
                                      std::uint64_t size_bytes) {
  if (buffer && buffer.size_bytes() >= size_bytes) return {};
  Result<gpu::Buffer> made =
      table(name, buffer ? std::max(size_bytes, buffer.size_bytes() * 2) : size_bytes);
  if (!made) return made.error();
  buffer = *std::move(made);
  return {};
}

template <class T>
Result<void> Renderer::State::upload(gpu::Buffer& to, const char* name, std::span<const T> values) {
  if (Result<void> ok = reserve(to, name, std::max<std::size_t>(values.size_bytes(), sizeof(T)));
      !ok)
    return ok;
  if (!values.empty()) frame_uploader.write(to, 0, values);
  return {};
}

Result<void> Renderer::State::create(const RendererDesc& desc) {
  Result<std::unique_ptr<GeometryStore>> store = GeometryStore::create(device, desc.arena_quads);
  if (!store) return store.error();
  geometry = *std::move(store);

  std::vector<std::uint16_t> index(shared::kMaxQuadsPerDraw * 6);
  for (std::uint32_t quad = 0; quad < shared::kMaxQuadsPerDraw; ++quad)
    for (std::uint32_t i = 0; i < 6; ++i)
      index[quad * 6 + i] =
          static_cast<std::uint16_t>(quad * 4 + std::array<std::uint32_t, 6>{0, 1, 2, 0, 2, 3}[i]);
  Result<gpu::Buffer> made = device.create_buffer(
      {"quad indices", index.size() * 2,
       VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::kDevice});
  if (!made) return made.error();
  indices = *std::move(made);
  frame_uploader.write(indices, 0, std::span<const std::uint16_t>(index));
  if (Result<void> ok = upload(materials, "materials", desc.materials); !ok) return ok;
  if (Result<void> ok = reserve(pixel_stats, "pixel stats", sizeof(shared::PixelStats)); !ok)
    return ok;

  const BlockTextures textures = render::block_textures();
  Result<gpu::Image> image =
      device.create_image({.name = "block textures",
                           .format = VK_FORMAT_R8G8B8A8_SRGB,
                           .extent = {textures.edge, textures.edge},
                           .mips = textures.mips,
                           .layers = textures.layers,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                           .array = true});
  if (!image) return image.error();
  block_textures = *std::move(image);
  if (Result<void> ok = frame_uploader.fill_image(block_textures, textures.texels); !ok) return ok;

  image = device.create_image({.name = "sky table",
                               .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                               .extent = {shared::kSkyLutWidth, shared::kSkyLutHeight},
                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_DST_BIT});
  if (!image) return image.error();
  sky_lut = *std::move(image);

  const std::array<std::pair<VkSampler*, gpu::SamplerDesc>, 3> samplers{{
      {&block_sampler,
       {.mip = VK_SAMPLER_MIPMAP_MODE_LINEAR, .address = VK_SAMPLER_ADDRESS_MODE_REPEAT}},
      {&lut_sampler, {}},
      {&point_sampler, {.mag = VK_FILTER_NEAREST, .min = VK_FILTER_NEAREST}},
  }};
  for (const auto& [sampler, sampler_desc] : samplers) {
    Result<VkSampler> got = device.sampler(sampler_desc);
    if (!got) return got.error();
    *sampler = *got;
  }
  for (Slot& slot : slots) {
    Result<gpu::Buffer> readback =
        device.create_buffer({"frame stats", kClusterWorkOffset + sizeof(shared::ClusterWork),
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::kReadback});
    if (!readback) return readback.error();
    slot.readback = *std::move(readback);
  }
  return {};
}

/// Makes an image anew unless it has its size already.
Result<void> Renderer::State::resize(gpu::Image& image, const gpu::ImageDesc& desc) {
  if (image && image.desc().extent.width == desc.extent.width &&
      image.desc().extent.height == desc.extent.height)
    return {};
  image = {};
  Result<gpu::Image> made = device.create_image(desc);
  if (!made) return made.error();
  image = *std::move(made);
  return {};
}

Result<void> Renderer::State::resize_picture(VkExtent2D size, int samples) {
  const std::uint32_t limit = device.limits().max_image_edge;
  const std::uint32_t most = limit / static_cast<std::uint32_t>(samples);
  if (size.width == 0 || size.height == 0 || size.width > most || size.height > most)
    return Error{
        samples == 1
            ? fmt::format("cannot draw a picture of {}x{} pixels: the device takes 1 to {} along "
                          "an edge; choose another --size",
                          size.width, size.height, limit)
            : fmt::format("cannot draw a picture of {}x{} pixels with aa.samples={}: the device "
                          "takes 1 to {} samples along an edge; choose fewer samples or another "
                          "--size",
                          size.width, size.height, samples * samples, limit)};
  return resize(picture, {.name = "picture",
                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                          .extent = size,
                          .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
}

Result<void> Renderer::State::resize_total(VkExtent2D size) {
  if (size.width == 0) {
    total = {};
    return {};
  }
  return resize(total, {.name = "total of parts",
                        .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                        .extent = size,
                        .usage = VK_IMAGE_USAGE_STORAGE_BIT});
}

Result<void> Renderer::State::upload_tables(const FrameTables& tables, const FrameInput& input,
                                            const shared::SkyConstants& sky_now) {
  // Where every pixel is black, any exposure is right.
  shared::Exposure given{};
  given.ev = input.exposure_ev.value_or(0.0f);
  const std::size_t island_count = input.islands.size();
  const std::array<Result<void>, 6> done{
      upload(exposure, "exposure", std::span<const shared::Exposure>(&given, 1)),
      upload(frame, "frame constants",
             std::span<const shared::FrameConstants>(&tables.constants, 1)),
      upload(sky, "sky constants", std::span<const shared::SkyConstants>(&sky_now, 1)),
      upload(islands, "island transforms",
             std::span<const shared::IslandTransform>(tables.islands).first(island_count)),
      upload(view_islands, "view island transforms",
             std::span<const shared::IslandTransform>(tables.islands)),
      upload(views, "cull views", std::span<const shared::CullView>(tables.views)),
  };
  for (const Result<void>& one : done)
    if (!one) return one.error();
  return {};
}

SceneRefs Renderer::State::import_scene(const FrameInput& input, const RenderSettings& settings,
                                        VkExtent2D size, const FrameTables& tables) {
  SceneRefs s;
  s.frame = graph.import(frame);
  s.sky = graph.import(sky);
  s.islands = graph.import(islands);
  s.view_islands = graph.import(view_islands);
  s.clip_from_source = tables.matrices;
  s.edge_growth = tables.edge_growth;
  s.views = graph.import(views);
  s.materials = graph.import(materials);
  s.quads = graph.import(geometry->quads());
  s.sections = graph.import(geometry->sections());
  if (occupancy) {
    s.occupancy_grids = graph.import(occupancy->grids());
    s.occupancy_tables = graph.import(occupancy->tables());
    s.occupancy_words = graph.import(occupancy->words());
    if (settings.traced_lights != 0 && !input.light_islands.empty())
      s.light_islands = graph.import(light_islands);
    s.corners = settings.corner_darkening > 0.0f && !settings.flat_shading;
  }
  s.indices = graph.import(indices);
  s.pixel_stats = graph.import(pixel_stats);
  s.exposure = graph.import(exposure);
  s.block_textures = graph.import(block_textures);
  s.sky_lut = graph.import(sky_lut);
  s.block_sampler = block_sampler;
  s.lut_sampler = lut_sampler;
  s.point_sampler = point_sampler;
  s.islands_per_view = static_cast<std::uint32_t>(input.islands.size());
  s.size = size;
  s.tone = settings.tone;
  s.calibrated = settings.display != DisplaySettings{};
  s.shadow_taps = static_cast<std::uint32_t>(settings.shadow_taps);
  s.shadow_cascades = static_cast<std::uint32_t>(settings.shadow_cascades);
  s.samples_per_edge = static_cast<std::uint32_t>(samples_per_edge(settings));
  s.penumbrae = settings.shadow_penumbra_blocks > 0.0f;
  for (std::uint32_t body = 0; body < shared::kBodyCount; ++body)
    if (tables.constants.bodies[body].irradiance != glm::vec3(0.0f)) s.bodies |= 1u << body;
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

/// Makes pixels of samples, copies radiance out if asked to, meters and develops it: with the last
/// part.
std::optional<Developed> Renderer::State::finish_picture(SceneRefs& scene, Shaded shaded,
                                                         const FrameInput& input,
                                                         const RenderSettings& settings) {
  if (input.fault && input.fault->in == Fault::In::kLookedThrough)
    shaded = FaultPass::add(graph, std::move(shaded), *input.fault);
  const int samples = samples_per_edge(settings);
  if (samples > 1 || input.parts > 1)
    shaded = ResolvePass::add(graph, pipelines, scene, std::move(shaded),
                              {samples, picture.desc().extent, input.part, input.parts,
                               input.parts > 1 ? &total : nullptr});
  if (samples == 1) graph.leave_out("average_samples", "aa.samples=1");
  if (input.parts == 1) graph.leave_out("accumulate_part", "shadow.samples=1");
  if (input.part + 1 != input.parts) return std::nullopt;
  if (input.capture) captures.add(graph, Capture::kRadiance, shaded.radiance());
  gpu::BufferRef histogram;
  if (meters(input, settings))
    histogram = MeterPass::add(graph, pipelines, scene, shaded.radiance(), settings.meter,
                               !input.exposure_ev);
  std::optional<Bloom> bloom;
  if (settings.bloom.intensity > 0.0f)
    bloom = BloomPass::add(graph, pipelines, scene, shaded.radiance(), settings.bloom);
  Developed developed = DevelopPass::add(graph, pipelines, scene, std::move(shaded),
                                         bloom ? &*bloom : nullptr, picture);
  if (settings.debug_view == DebugView::kExposure)
    developed =
        MeterPass::show(graph, pipelines, scene, std::move(developed), histogram, settings.meter);
  return developed;
}

void Renderer::State::add_marker(const SceneRefs& scene, const Geometry& surfaces,
                                 Developed developed, const FrameInput& input) {
  if (!input.marker) return;
  const std::optional<shared::MarkerConstants> marker = marker_constants(
      *input.marker, input.islands[input.marker->island], input.camera, picture.desc().extent);
  if (marker)
    (void)MarkerPass::add(graph, pipelines, scene, surfaces, std::move(developed), *marker);
}

void Renderer::State::add_readback(Slot& slot, const SceneRefs& scene,
                                   const gpu::BufferRef* cull_stats, std::uint32_t view_count) {
  gpu::BufferRef to = graph.import(slot.readback);
  slot.views = cull_stats ? view_count : 0;
  const gpu::BufferRef work = slot.grid ? light_clusters.work() : gpu::BufferRef{};
  graph.add_pass(
      "read_stats",
      [&](gpu::PassBuilder& b) {
        if (cull_stats) b.read(*cull_stats, gpu::Use::kTransferRead);
        b.read(scene.pixel_stats, gpu::Use::kTransferRead);
        b.read(scene.exposure, gpu::Use::kTransferRead);
        if (work) b.read(work, gpu::Use::kTransferRead);
        to = b.write(to, gpu::Use::kTransferWrite);
      },
      [to, stats = cull_stats ? *cull_stats : gpu::BufferRef{}, pixels = scene.pixel_stats,
       exposed = scene.exposure, work, view_count](gpu::Commands& c) {
        if (stats) c.copy(stats, to, 0, 0, view_count * sizeof(shared::CullStats));
        c.copy(pixels, to, 0, kPixelStatsOffset, sizeof(shared::PixelStats));
        c.copy(exposed, to, 0, kExposureOffset, sizeof(shared::Exposure));
        if (work) c.copy(work, to, 0, kClusterWorkOffset, sizeof(shared::ClusterWork));
      });
  graph.add_pass(
      "stats_to_cpu",
      [&](gpu::PassBuilder& b) {
        b.read(to, gpu::Use::kHostRead);
        b.keep();
      },
      [](gpu::Commands&) {});
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
        shaded = CloudPass::add(graph, pipelines, scene, {}, std::move(shaded), settings.clouds);
      (void)finish_picture(scene, std::move(shaded), input, settings);
    } else {
      graph.leave_out("develop", "nothing comes between shading and picture");
      (void)ShadePass::add_sky_only_to_picture(graph, pipelines, scene, shade_in, picture);
    }
    add_readback(slot, scene, nullptr, 0);
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
                                 lights ? &*lights : nullptr, settings.debug_view, picture);
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
      add_marker(
          scene, surfaces,
          ShadePass::add_to_picture(graph, pipelines, scene, surfaces, maps, shade_in, picture),
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
        shaded = CloudPass::add_behind(graph, pipelines, scene, view, std::move(shaded));
      if (!no_translucent)
        shaded = TranslucentPass::add(graph, pipelines, scene, surfaces, maps, layers,
                                      lights ? &*lights : nullptr, std::move(shaded), settings,
                                      input.camera_medium != 0);
      if (scene.clouds && input.camera_medium == 0)
        shaded = CloudPass::add(graph, pipelines, scene, view, std::move(shaded), settings.clouds);
      if (std::optional<Developed> developed =
              finish_picture(scene, std::move(shaded), input, settings))
        add_marker(scene, surfaces, *std::move(developed), input);
    }
  }
  if (input.capture) {
    if (settings.gbuffer.depth == DepthStore::kD32)
      captures.add(graph, Capture::kDepth, surfaces.depth());
    captures.add(graph, Capture::kSurfaces, surfaces.surfaces());
    if (maps.maps()) captures.add(graph, Capture::kShadowMaps, maps.maps());
  }
  add_readback(slot, scene, &draws.stats, view_count);
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
  const std::byte* data = slot.readback.mapped();
  for (std::uint32_t v = 0; v < slot.views; ++v) {
    shared::CullStats one;
    std::memcpy(&one, data + v * sizeof(one), sizeof(one));
    if (v == 0) {
      r.camera = one;
    } else {
      r.shadows.sections_in += one.sections_in;
      r.shadows.sections_passed += one.sections_passed;
      r.shadows.draws += one.draws;
      r.shadows.quads += one.quads;
    }
  }
  std::memcpy(&r.pixels, data + kPixelStatsOffset, sizeof(r.pixels));
  r.lights = slot.lights;
  if (slot.grid) {
    std::memcpy(&r.clusters, data + kClusterWorkOffset, sizeof(r.clusters));
    light_clusters.learn(*slot.grid, r.clusters);
  }
  shared::Exposure exposed;
  std::memcpy(&exposed, data + kExposureOffset, sizeof(exposed));
  r.exposure_ev = exposed.ev;
  if (exposed.metered != 0) r.metered_ev = exposed.metered_ev;
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
  if (Result<void> ok = s.resize_picture(size, samples_per_edge(settings)); !ok) return ok.error();
  const auto samples = static_cast<std::uint32_t>(samples_per_edge(settings));
  const VkExtent2D drawn{size.width * samples, size.height * samples};
  if (Result<void> ok = check_store(s.device, settings.gbuffer); !ok) return ok.error();
  if (Result<void> ok = check_draws(
          most_draws(s.geometry->section_slots(), s.geometry->quads_resident()), s.device.limits());
      !ok)
    return ok.error();

  if (Result<void> ok = s.resize_total(input.parts > 1 ? size : VkExtent2D{}); !ok)
    return ok.error();
  const shared::SkyConstants sky_now = sky_constants(input.sky);
  input.sky = sky_of_part(input.sky, input.part, input.parts);
  const Result<std::span<const ActiveCascade>> cascades =
      s.geometry->sections_resident() == 0
          ? std::span<const ActiveCascade>{}
          : s.shadows.update(input, settings, s.geometry->version());
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
  if (Result<void> ok = s.upload_tables(tables, input, sky_now); !ok) return ok.error();
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
    if (Result<void> ok = s.upload(s.light_islands, "light islands", input.light_islands); !ok)
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
    return *failure;
  }
  s.graph.execute(frame.commands, frame.slot);
  slot.part = input.part;
  slot.counts = s.graph.counts();
  slot.pipelines_created = s.pipelines.created();
  slot.memory_bytes = s.device.memory_total();
  if (after) after(frame.commands, s.picture);
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
  return state_->picture;
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
