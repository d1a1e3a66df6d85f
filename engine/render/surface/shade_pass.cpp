#include "engine/render/surface/shade_pass.h"

#include <shader_names.h>
#include <bit>
#include <utility>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/occupancy_reads.h"
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
  return in.sampled && in.sampled->settings.shading_tolerance > 0.0f && !scene.panorama;
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
  return scene.on_cpu && !in.sampled && !in.oracle && from.shadows.maps() &&
         !from.geometry.stored() && std::has_single_bit(scene.bodies);
}

/// As classify_tiles(), with kSunless and kInWater.
Tiles classify_lit_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                         const ShadedFrom& from) {
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
        out.dispatches = b.write(out.dispatches, Use::kComputeWrite);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [scene, surfaces, layers, maps = from.shadows.maps(), out, tiles,
       program = gpu::compute(
           pipelines, programs::kClassifyLitTiles,
           surfaces.with_depth(with_light({{shared::kUnderWaterConstant, under_water ? 1u : 0u}},
                                          scene, true)))](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::texels<shared::kIslandsBinding>(scene.islands),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::sampled<shared::kLayerDepthsBinding>(layers, scene.point_sampler),
                  gpu::sampled<shared::kShadowMapsBinding>(maps, scene.point_sampler),
                  gpu::storage<shared::kTileDispatchesBinding>(out.dispatches),
                  gpu::storage<shared::kTilesBinding>(out.lists));
        dispatch_items(c, tiles);
      });
  return out;
}

/// Whether squares are told apart that one light's four points are found for at once.
bool looks_for_squares(const ShadeIn& in) {
  return in.sampled && in.sampled->rate == shared::kSquareEdge &&
         in.sampled->settings.shading_tolerance > 0.0f;
}

/// As classify_tiles(), with kDetailed and with squares if they are looked for, and with kKept...
/// if there are `layer_tiles`, dispatches of those that show water or glass.
Tiles classify_shaded_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const ShadeIn& in, const Geometry& geometry,
                            gpu::BufferRef layer_tiles) {
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
        out.dispatches = b.write(out.dispatches, Use::kComputeWrite);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [scene, layers, surfaces, out, tiles,
       program = gpu::compute(pipelines, programs::kClassifyShadedTiles,
                              surfaces.with_depth(std::move(constants)))](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kSkyBinding>(scene.sky),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::storage<shared::kLayerTilesBinding>(layers),
                  gpu::storage<shared::kTileDispatchesBinding>(out.dispatches),
                  gpu::storage<shared::kTilesBinding>(out.lists));
        dispatch_items(c, tiles);
      });
  return out;
}

/// Adds surfaces, at every pixel of their tiles.
/// @param some_sunless whether the tiles are of classify_lit_tiles().
void shade_surfaces(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const ShadeIn& in, const SampleIn& on, bool some_sunless, ShadeTarget& into) {
  const Tiles& tiles = on.tiles;
  const SurfaceReads surfaces(on.geometry);
  const gpu::ImageRef maps = on.shadows.maps();
  const OccupancyReads occupancy(scene, scene.ao && scene.bodies != 0);
  const CloudRefs clouds = clouds_before_light(scene);
  const auto program = [&](TileKind kind, bool keep) {
    std::vector<gpu::SpecConstant> constants =
        with_light({{shared::kTextureTapsConstant, static_cast<std::uint32_t>(in.texture_taps)}},
                   scene, bool{maps});
    constants =
        clouds.with_clouds(with_ao(surfaces.with_store(std::move(constants)), bool{occupancy}));
    // Nothing under water is in a sunless tile, and glass takes no light of the sky.
    if (kind == TileKind::kSunless)
      constants.push_back({shared::kSunlessConstant, 1});
    else
      constants =
          on.media.with_media(std::move(constants), !some_sunless || kind == TileKind::kInWater);
    return gpu::compute(pipelines, programs::kShadeSurfaces,
                        into.with_output(std::move(constants), scene, keep));
  };
  auto programs = programs_of(into, TileKind::kCovered,
                              [&](bool keep) { return program(TileKind::kCovered, keep); });
  if (some_sunless) {
    programs.push_back(std::pair(TileKind::kSunless, program(TileKind::kSunless, true)));
    if (on.media.has_water())
      programs.push_back(std::pair(TileKind::kInWater, program(TileKind::kInWater, true)));
  }
  graph.add_pass(
      "shade_surfaces",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.indirect, scene.island_skies})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        surfaces.declare(b);
        occupancy.declare(b);
        on.media.declare(b, scene);
        clouds.declare_light(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        into.declare(b, scene);
      },
      [programs = std::move(programs), scene, tiles, surfaces, occupancy, media = on.media, clouds,
       maps, into](gpu::Commands& c) {
        const std::tuple bindings{
            gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::texels<shared::kIndirectBinding>(scene.indirect),
            gpu::texels<shared::kIslandSkiesBinding>(scene.island_skies),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            surfaces.bindings(scene.point_sampler),
            occupancy.bindings(),
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
  if (!some_sunless && into.picture && into.radiance && from.layers.count != 0)
    into.layer_tiles = from.layers.tiles.dispatches;
  const Tiles tiles =
      into.layer_tiles || sky_may_differ(scene, in)
          ? classify_shaded_tiles(graph, pipelines, scene, in, from.geometry, into.layer_tiles)
      : some_sunless ? classify_lit_tiles(graph, pipelines, scene, from)
                     : classify_tiles(graph, pipelines, scene, "classify_tiles",
                                      {.words = from.geometry.surfaces(),
                                       .depth = from.geometry.depth(),
                                       .kept = from.geometry.store().depth,
                                       .area = {0, 0, scene.size.width, scene.size.height}});
  std::vector<OutputTiles> lit = into.tiles_of(TileKind::kCovered);
  if (some_sunless) lit.push_back({TileKind::kInWater, true});
  const MediaLight media =
      MediaLight::add(graph, pipelines, scene,
                      {from.geometry, from.layers, from.glass, from.shadows.maps()}, tiles, lit);
  const SampleIn on{from.geometry, from.shadows, media, tiles};
  if (in.sampled)
    add_sample_passes(graph, pipelines, scene, on, *in.sampled, into);
  else
    shade_surfaces(graph, pipelines, scene, in, on, some_sunless, into);
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
                  gpu::storage<shared::kTilesBinding>(scene.materials),
                  gpu::storage<shared::kTileDispatchesBinding>(scene.materials),
                  gpu::constants(0u));
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
