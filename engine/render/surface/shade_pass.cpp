#include "engine/render/surface/shade_pass.h"

#include <shader_names.h>
#include <utility>

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

std::vector<gpu::SpecConstant> with_target(std::vector<gpu::SpecConstant> own,
                                           const SceneRefs& scene, bool to_picture) {
  if (!to_picture) return own;
  own.push_back({shared::kToPictureConstant, 1});
  return with_picture(std::move(own), scene);
}

/// What output.glsl reads; shading that is not for the picture at once reads no exposure.
gpu::BufferRef exposure_or_other(const SceneRefs& scene, bool to_picture) {
  return to_picture ? scene.exposure : scene.frame;
}

std::vector<gpu::SpecConstant> constants_of_sky(const ShadeIn& in) {
  return {{shared::kStarsConstant, in.stars ? 1u : 0u},
          {shared::kDiscsConstant, in.discs ? 1u : 0u}};
}

/// What shading writes to.
struct Target {
  gpu::ImageRef image;
  bool to_picture = false;
};

/// Adds surfaces, at every pixel of their tiles.
void shade_surfaces(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const ShadeIn& in, const SampleIn& on, Target& into) {
  const Tiles& tiles = on.tiles;
  gpu::ImageRef& target = into.image;
  const bool to_picture = into.to_picture;
  const SurfaceReads surfaces(on.geometry);
  const gpu::ImageRef maps = on.shadows.maps();
  const OccupancyReads occupancy(scene, scene.ao && scene.bodies != 0);
  const CloudRefs clouds = clouds_before_light(scene);
  const auto surface_program = gpu::compute(
      pipelines, programs::kShadeSurfaces,
      with_target(
          clouds.with_clouds(with_ao(
              surfaces.with_store(with_light(
                  {{shared::kTextureTapsConstant, static_cast<std::uint32_t>(in.texture_taps)}},
                  scene, bool{maps})),
              bool{occupancy})),
          scene, to_picture));
  graph.add_pass(
      "shade_surfaces",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.indirect})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        surfaces.declare(b);
        occupancy.declare(b);
        clouds.declare_light(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        if (to_picture) b.read(scene.exposure, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        target = b.write(target, Use::kComputeWrite);
      },
      [surface_program, scene, tiles, surfaces, occupancy, clouds, maps, target,
       to_picture](gpu::Commands& c) {
        gpu::bind(
            c, surface_program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::storage<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::texels<shared::kIndirectBinding>(scene.indirect),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            surfaces.bindings(scene.point_sampler), occupancy.bindings(), clouds.light_bindings(),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.lut_sampler),
            gpu::storage<shared::kTargetBinding>(target),
            gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                     scene.point_sampler),
            gpu::storage<shared::kExposureBinding>(exposure_or_other(scene, to_picture)),
            tiles.bindings(TileKind::kCovered));
        dispatch_tiles(c, tiles, TileKind::kCovered);
      });
}

/// Adds sky to the pixels without a surface.
void shade_sky(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
               const ShadeIn& in, const SampleIn& on, Target& into) {
  gpu::ImageRef& target = into.image;
  const bool to_picture = into.to_picture;
  const Tiles& tiles = on.tiles;
  const SurfaceReads surfaces(on.geometry);
  const auto sky_program =
      gpu::compute(pipelines, programs::kShadeSky,
                   with_target(surfaces.with_depth(constants_of_sky(in)), scene, to_picture));
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky}) b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        surfaces.declare(b);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (to_picture) b.read(scene.exposure, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        target = b.write(target, Use::kComputeWrite);
      },
      [sky_program, scene, tiles, surfaces, target, to_picture](gpu::Commands& c) {
        gpu::bind(c, sky_program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kSkyBinding>(scene.sky),
                  gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.lut_sampler),
                  gpu::storage<shared::kTargetBinding>(target),
                  gpu::storage<shared::kExposureBinding>(exposure_or_other(scene, to_picture)),
                  tiles.bindings(TileKind::kOpen));
        dispatch_tiles(c, tiles, TileKind::kOpen);
      });
}

/// Adds surfaces and sky, both into `target`. @return its last version.
gpu::ImageRef shade(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const ShadedFrom& from, const ShadeIn& in, Target target) {
  const SampleIn on{from.geometry, from.shadows,
                    classify_tiles(graph, pipelines, scene, "classify_tiles",
                                   {.words = from.geometry.surfaces(),
                                    .depth = from.geometry.depth(),
                                    .kept = from.geometry.store().depth,
                                    .area = {0, 0, scene.size.width, scene.size.height}})};
  if (in.sampled)
    target.image = add_sample_passes(graph, pipelines, scene, on, *in.sampled, target.image);
  else
    shade_surfaces(graph, pipelines, scene, in, on, target);
  shade_sky(graph, pipelines, scene, in, on, target);
  return target.image;
}

/// Sky for every pixel into `target`. @return its last version.
gpu::ImageRef shade_sky_everywhere(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                   SceneRefs& scene, const ShadeIn& in, gpu::ImageRef target,
                                   bool to_picture) {
  std::vector<gpu::SpecConstant> constants = constants_of_sky(in);
  constants.push_back({shared::kSkyAloneConstant, 1});
  const auto program = gpu::compute(pipelines, programs::kShadeSky,
                                    with_target(std::move(constants), scene, to_picture));
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky, scene.materials})
          b.read(ref, Use::kComputeRead);
        b.read(scene.no_words, Use::kComputeRead);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (to_picture) b.read(scene.exposure, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        target = b.write(target, Use::kComputeWrite);
      },
      [program, scene, target, to_picture](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kSkyBinding>(scene.sky),
                  gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                  gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.lut_sampler),
                  gpu::storage<shared::kTargetBinding>(target),
                  gpu::storage<shared::kExposureBinding>(exposure_or_other(scene, to_picture)),
                  // Neither surfaces nor tiles are read.
                  gpu::storage<shared::kSurfacesBinding>(scene.no_words),
                  gpu::sampled<shared::kDepthsBinding>(scene.sky_lut, scene.point_sampler),
                  gpu::storage<shared::kTilesBinding>(scene.materials),
                  gpu::storage<shared::kTileDispatchesBinding>(scene.materials),
                  gpu::constants(0u));
        c.dispatch(gpu::Commands::groups(scene.size.width, shared::kTileEdge),
                   gpu::Commands::groups(scene.size.height, shared::kTileEdge), 1);
      });
  return target;
}

gpu::ImageRef radiance(gpu::FrameGraph& graph, const SceneRefs& scene) {
  return graph.create(gpu::ImageDesc{
      .name = "radiance", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = scene.size});
}

}  // namespace

Shaded ShadePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const ShadedFrom& from, const ShadeIn& in) {
  return Shaded(shade(graph, pipelines, scene, from, in, {radiance(graph, scene), false}));
}

Developed ShadePass::add_to_picture(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                    SceneRefs& scene, const ShadedFrom& from, const ShadeIn& in,
                                    gpu::Image& picture) {
  return Developed(shade(graph, pipelines, scene, from, in, {graph.import(picture), true}));
}

Shaded ShadePass::add_sky_only(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                               const ShadeIn& in) {
  return Shaded(shade_sky_everywhere(graph, pipelines, scene, in, radiance(graph, scene), false));
}

Developed ShadePass::add_sky_only_to_picture(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                             SceneRefs& scene, const ShadeIn& in,
                                             gpu::Image& picture) {
  return Developed(shade_sky_everywhere(graph, pipelines, scene, in, graph.import(picture), true));
}

}  // namespace skerry::render
