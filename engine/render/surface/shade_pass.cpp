#include "engine/render/surface/shade_pass.h"

#include <shader_names.h>
#include <bit>
#include <utility>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/tiles.h"
#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

using gpu::Use;

/// Pixels of a row that have one sky's two ends in common, where light is that of fewer pixels.
constexpr std::uint32_t kSkyRun = 4;

/// Whether a sky without detail may be that of fewer pixels.
bool sky_may_differ(const SceneRefs& scene, const ShadeIn& in) {
  return in.sampled && in.settings.shading_tolerance > 0.0f && !scene.panorama;
}

/// Whether tiles that may show stars or discs are told apart from others.
bool looks_for_detail(const SceneRefs& scene, const ShadeIn& in) {
  return sky_may_differ(scene, in) && (in.stars || in.discs);
}

/// @param detail with the stars and discs that there are; else there are none in its tiles.
std::vector<gpu::SpecConstant> constants_of_sky(const SceneRefs& scene, const ShadeIn& in,
                                                bool detail) {
  const bool stars = detail && in.stars, discs = detail && in.discs;
  const std::uint32_t run = sky_may_differ(scene, in) && !stars && !discs ? kSkyRun : 1;
  std::vector<gpu::SpecConstant> constants{
      {shared::kStarsConstant, stars ? 1u : 0u},
      {shared::kDiscsConstant, discs ? 1u : 0u},
      {shared::kRunConstant, run},
      {shared::kGroupSizeConstant, shared::kTileEdge * shared::kTileEdge / run}};
  if (scene.panorama) constants.push_back({shared::kPanoramaConstant, 1});
  return constants;
}

/// Whether tiles that get no sun are worth finding: on a CPU, which looks for shadows at every
/// pixel of a program that does so anywhere. A GPU's few invocations would take longer to find
/// them.
bool looks_for_sunless(const SceneRefs& scene, const ShadeIn& in, const ShadedFrom& from) {
  return scene.on_cpu && !in.sampled && !in.settings.lights_oracle && from.shadows.maps() &&
         !from.geometry.stored() && std::has_single_bit(scene.bodies);
}

/// As classify_tiles(), with kSunless and kInWater.
Tiles classify_lit_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                         const ShadedFrom& from, const LampReads& lamps) {
  const std::uint32_t tiles = tile_count(scene.size);
  Tiles out = create_tiles(graph, "classify_tiles_clear", tiles);
  const SurfaceReads surfaces(from.geometry);
  const bool under_water = from.layers.count != 0;
  // In place of what is then never read.
  const gpu::ImageRef layers = under_water ? from.layers.depth[0] : from.geometry.depth();
  graph.add_pass(
      "classify_tiles",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        b.read(layers, Use::kComputeSampled);
        b.read(from.shadows.maps(), Use::kComputeSampled);
        lamps.declare(b);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [scene, surfaces, layers, maps = from.shadows.maps(), lamps, out, tiles,
       program = gpu::compute(pipelines, programs::kClassifyLitTiles,
                              lamps.with_lamps(surfaces.with_depth(
                                  with_light({{shared::kUnderWaterConstant, under_water ? 1u : 0u}},
                                             scene, true))))](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::texels<shared::kIslandsBinding>(scene.islands),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::sampled<shared::kLayerDepthsBinding>(layers, scene.point_sampler),
                  gpu::sampled<shared::kShadowMapsBinding>(maps, scene.point_sampler),
                  lamps.bindings(), gpu::storage<shared::kTilesBinding>(out.lists));
        dispatch_items(c, tiles);
      });
  return out;
}

/// Whether squares are told apart that one light's four points are found for at once.
bool looks_for_squares(const ShadeIn& in) {
  return in.sampled && in.settings.shading_rate == static_cast<int>(shared::kSquareEdge) &&
         in.settings.shading_tolerance > 0.0f;
}

/// As classify_tiles(), with kDetailed and with squares if they are looked for, and with kKept...
/// if there are `layer_tiles`, dispatches of those that show water or glass.
Tiles classify_shaded_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const ShadeIn& in, const Geometry& geometry,
                            gpu::BufferRef layer_tiles, const LampReads& lamps) {
  const std::uint32_t tiles = tile_count(scene.size);
  Tiles out = create_tiles(graph, "classify_tiles_clear", tiles, looks_for_squares(in));
  out.smooth_sky = sky_may_differ(scene, in);
  const SurfaceReads surfaces(geometry);
  const bool detail = looks_for_detail(scene, in);
  // In place of what is then never read.
  const gpu::BufferRef layers = layer_tiles ? layer_tiles : scene.frame;
  std::vector<gpu::SpecConstant> constants{{shared::kTranslucentConstant, layer_tiles ? 1u : 0u},
                                           {shared::kStarsConstant, detail && in.stars ? 1u : 0u},
                                           {shared::kDiscsConstant, detail && in.discs ? 1u : 0u},
                                           {shared::kSquaresConstant, out.squares ? 1u : 0u},
                                           {shared::kSmoothSkyConstant, out.smooth_sky ? 1u : 0u}};
  graph.add_pass(
      "classify_tiles",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky, layers})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        lamps.declare(b);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [scene, layers, surfaces, lamps, out, tiles,
       program = gpu::compute(pipelines, programs::kClassifyShadedTiles,
                              lamps.with_lamps(surfaces.with_depth(std::move(constants))))](
          gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kSkyBinding>(scene.sky),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::storage<shared::kLayerTilesBinding>(layers), lamps.bindings(),
                  gpu::storage<shared::kTilesBinding>(out.lists));
        dispatch_items(c, tiles);
      });
  return out;
}

bool is_sunless(TileKind kind) {
  return kind == TileKind::kSunless || kind == TileKind::kLampLitSunless;
}

/// Tiles with surfaces as they are shaded at every pixel.
/// @param lit those that lamps reach; else the others.
/// @param some_sunless whether the tiles are of classify_lit_tiles().
/// @param water whether some of these may show any.
std::vector<OutputTiles> surface_tiles(const ShadeTarget& into, bool lit, bool some_sunless,
                                       bool water) {
  std::vector<OutputTiles> out = into.tiles_of(lit ? TileKind::kLampLit : TileKind::kCovered);
  if (!some_sunless) return out;
  out.push_back({lit ? TileKind::kLampLitSunless : TileKind::kSunless, true});
  if (water) out.push_back({lit ? TileKind::kLampLitInWater : TileKind::kInWater, true});
  return out;
}

/// Those of them that sun or moon may light.
std::vector<TileKind> sunlit_tiles(const ShadeTarget& into, bool lit, bool some_sunless) {
  std::vector<TileKind> out;
  for (const OutputTiles& some : surface_tiles(into, lit, some_sunless, true))
    if (!is_sunless(some.kind)) out.push_back(some.kind);
  return out;
}

/// Surfaces at every pixel of their tiles.
struct SurfacesIn {
  const ShadeIn& in;
  const SampleIn& on;
  ClusteredLights lamps;  ///< of the tiles that they reach; none: of the others
  bool some_sunless;      ///< whether the tiles are of classify_lit_tiles()

  bool lit() const { return lamps.kinds != 0; }
};

/// Adds surfaces. @param shader with the bindings `own` besides those of all.
template <typename Shader, typename... Own>
void shade_surfaces_by(const Shader& shader, const std::tuple<Own...>& own, gpu::FrameGraph& graph,
                       gpu::Pipelines& pipelines, SceneRefs& scene, const SurfacesIn& from,
                       ShadeTarget& into) {
  const SampleIn& on = from.on;
  const RenderSettings& settings = from.in.settings;
  const ClusteredLights& lights = from.lamps;
  const bool ao = scene.ao && (from.lit() || scene.bodies != 0);
  const Tiles& tiles = on.tiles;
  const SurfaceReads surfaces(on.geometry);
  const gpu::ImageRef maps = on.shadows.maps();
  const WallReads walls(scene, settings, ao);
  const CloudRefs clouds = clouds_before_light(scene);
  const auto program = [&](const OutputTiles& some) {
    std::vector<gpu::SpecConstant> constants = with_light(
        {{shared::kTextureTapsConstant, static_cast<std::uint32_t>(settings.texture_taps)}}, scene,
        bool{maps});
    constants = clouds.with_clouds(with_ao(surfaces.with_store(std::move(constants)), ao));
    if (from.lit()) constants = walls.with_walls(lights.with_panes(std::move(constants)));
    // Nothing under water is in a sunless tile, and glass takes no light of the sky.
    if (is_sunless(some.kind))
      constants.push_back({shared::kSunlessConstant, 1});
    else
      constants = on.media.with_media(std::move(constants),
                                      !from.some_sunless || some.kind == TileKind::kInWater ||
                                          some.kind == TileKind::kLampLitInWater);
    return gpu::compute(pipelines, shader,
                        into.with_output(std::move(constants), scene, some.keep));
  };
  std::vector<std::pair<TileKind, decltype(program(OutputTiles{}))>> programs;
  for (const OutputTiles& some :
       surface_tiles(into, from.lit(), from.some_sunless, on.media.has_water()))
    programs.push_back(std::pair(some.kind, program(some)));
  graph.add_pass(
      from.lit() ? "shade_lights" : "shade_surfaces",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.indirect, scene.island_skies})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        surfaces.declare(b);
        walls.declare(b);
        lights.declare(b);
        on.media.declare(b, scene);
        clouds.declare_light(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        into.declare(b, scene);
      },
      [programs = std::move(programs), scene, tiles, walls, lights, media = on.media, clouds, maps,
       into, own](gpu::Commands& c) {
        const std::tuple bindings{
            gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::texels<shared::kIndirectBinding>(scene.indirect),
            gpu::texels<shared::kIslandSkiesBinding>(scene.island_skies),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            own,
            walls.bindings(),
            lights.bindings(),
            lights.reach_binding(),
            media.bindings(scene),
            clouds.light_bindings(),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.sky_sampler),
            into.bindings(scene),
            gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                     scene.point_sampler)};
        for (const auto& some : programs) {
          gpu::bind(c, some.second, bindings, tiles.bindings(some.first));
          dispatch_tiles(c, tiles, some.first);
        }
      });
}

/// As shade_surfaces_by(), from the G-buffer as it is kept.
void shade_surfaces(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const SurfacesIn& from, ShadeTarget& into) {
  const SurfaceReads surfaces(from.on.geometry);
  if (from.on.geometry.stored()) {
    const std::tuple own{surfaces.bindings(scene.point_sampler)};
    shade_surfaces_by(programs::kShadeStoredSurfaces, own, graph, pipelines, scene, from, into);
    return;
  }
  const std::tuple own{gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                       gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                       from.lamps.shaft_binding()};
  shade_surfaces_by(programs::kShadeSurfaces, own, graph, pipelines, scene, from, into);
}

/// Adds sky to the pixels without a surface.
void shade_sky(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
               const ShadeIn& in, const SampleIn& on, ShadeTarget& into) {
  const Tiles& tiles = on.tiles;
  const SurfaceReads surfaces(on.geometry);
  const auto make = [&](bool detail) {
    return [&, detail](bool keep) {
      return gpu::compute(
          pipelines, programs::kShadeSky,
          into.with_output(surfaces.with_depth(constants_of_sky(scene, in, detail)), scene, keep));
    };
  };
  const bool apart = looks_for_detail(scene, in);
  auto sky = programs_of(into, TileKind::kOpen, make(!apart));
  if (apart)
    for (auto& some : programs_of(into, TileKind::kDetailed, make(true)))
      sky.push_back(std::move(some));
  const auto make_smooth = [&](bool keep) {
    return gpu::compute(pipelines, programs::kShadeSmoothSky, into.with_output({}, scene, keep));
  };
  decltype(programs_of(into, TileKind::kSmoothSky, make_smooth)) smooth;
  if (tiles.smooth_sky) smooth = programs_of(into, TileKind::kSmoothSky, make_smooth);
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky}) b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        surfaces.declare(b);
        b.read(scene.sky_lut, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        into.declare(b, scene);
      },
      [sky = std::move(sky), smooth = std::move(smooth), scene, tiles, surfaces,
       into](gpu::Commands& c) {
        for (const auto& some : smooth) {
          gpu::bind(c, some.second, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                    gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.sky_sampler),
                    into.bindings(scene), tiles.bindings(some.first));
          dispatch_tiles(c, tiles, some.first);
        }
        for (const auto& some : sky) {
          gpu::bind(c, some.second, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::storage<shared::kSkyBinding>(scene.sky),
                    gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                    gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                    gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                    gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.sky_sampler),
                    into.bindings(scene), tiles.bindings(some.first));
          dispatch_tiles(c, tiles, some.first);
        }
      });
}

/// Adds surfaces and sky.
void shade(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
           const ShadedFrom& from, const ShadeIn& in, ShadeTarget& into) {
  const bool some_sunless = looks_for_sunless(scene, in, from);
  // Tiles that lamps reach are told apart where they have a program of their own.
  const ClusteredLights none = ClusteredLights::none(scene),
                        lamps = in.lamps && !in.sampled ? *in.lamps : none;
  const LampReads reads = lamps.tile_reads();
  if (!some_sunless && into.picture && into.radiance && from.layers.count != 0)
    into.layer_tiles = from.layers.tiles.lists;
  const Tiles tiles = into.layer_tiles || sky_may_differ(scene, in)
                          ? classify_shaded_tiles(graph, pipelines, scene, in, from.geometry,
                                                  into.layer_tiles, reads)
                      : some_sunless
                          ? classify_lit_tiles(graph, pipelines, scene, from, reads)
                          : classify_tiles(graph, pipelines, scene, "classify_tiles",
                                           {.words = from.geometry.surfaces(),
                                            .depth = from.geometry.depth(),
                                            .kept = from.geometry.store().depth,
                                            .area = {0, 0, scene.size.width, scene.size.height},
                                            .lamps = reads});
  std::vector<TileKind> sunlit = sunlit_tiles(into, false, some_sunless);
  if (reads.lit)
    for (const TileKind kind : sunlit_tiles(into, true, some_sunless)) sunlit.push_back(kind);
  const MediaLight media =
      MediaLight::add(graph, pipelines, scene,
                      {from.geometry, from.layers, from.glass, from.shadows.maps()}, tiles, sunlit);
  const SampleIn on{from.geometry, from.shadows, media, tiles};
  if (in.sampled) {
    add_sample_passes(graph, pipelines, scene, on, {in.lamps, in.settings}, into);
  } else {
    shade_surfaces(graph, pipelines, scene, {in, on, none, some_sunless}, into);
    if (reads.lit) shade_surfaces(graph, pipelines, scene, {in, on, lamps, some_sunless}, into);
  }
  shade_sky(graph, pipelines, scene, in, on, into);
}

/// Sky for every pixel.
void shade_sky_everywhere(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                          const ShadeIn& in, ShadeTarget& into) {
  std::vector<gpu::SpecConstant> constants = constants_of_sky(scene, in, true);
  constants.push_back({shared::kSkyAloneConstant, 1});
  const auto program =
      gpu::compute(pipelines, programs::kShadeSky, into.with_output(std::move(constants), scene));
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky, scene.materials})
          b.read(ref, Use::kComputeRead);
        b.read(scene.no_words, Use::kComputeRead);
        b.read(scene.sky_lut, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        into.declare(b, scene);
      },
      [program, scene, into](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kSkyBinding>(scene.sky),
                  gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                  gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.sky_sampler),
                  into.bindings(scene),
                  // Neither surfaces nor tiles are read.
                  gpu::storage<shared::kSurfacesBinding>(scene.no_words),
                  gpu::sampled<shared::kDepthsBinding>(scene.sky_lut, scene.point_sampler),
                  gpu::storage<shared::kTilesBinding>(scene.materials), gpu::constants(0u));
        c.dispatch(gpu::Commands::groups(scene.size.width, shared::kTileEdge),
                   gpu::Commands::groups(scene.size.height, shared::kTileEdge), 1);
      });
}

ShadeTarget target(gpu::FrameGraph& graph, const SceneRefs& scene, const ShadeOut& out) {
  ShadeTarget into;
  if (out.by_radiance != ByRadiance::kNothing)
    into.radiance = graph.create(gpu::ImageDesc{
        .name = "radiance", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = scene.size});
  if (out.by_radiance == ByRadiance::kEverything) return into;
  into.picture = graph.import(out.picture);
  if (!out.metered) return into;
  into.meter_stride = static_cast<std::uint32_t>(out.metered->stride);
  into.metered = graph.create(
      gpu::ImageDesc{.name = "metered",
                     .format = VK_FORMAT_R32_SFLOAT,
                     .extent = {gpu::Commands::groups(scene.size.width, into.meter_stride),
                                gpu::Commands::groups(scene.size.height, into.meter_stride)}});
  return into;
}

}  // namespace

Shaded ShadePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const ShadedFrom* from, const ShadeIn& in, const ShadeOut& out) {
  ShadeTarget into = target(graph, scene, out);
  if (from)
    shade(graph, pipelines, scene, *from, in, into);
  else
    shade_sky_everywhere(graph, pipelines, scene, in, into);
  Shaded shaded(into.radiance);
  shaded.picture_ = into.picture;
  shaded.metered_ = into.metered;
  return shaded;
}

}  // namespace skerry::render
