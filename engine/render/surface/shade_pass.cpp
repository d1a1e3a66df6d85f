#include "engine/render/surface/shade_pass.h"

#include <string>
#include <utility>

#include "engine/render/light/light_constants.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/occupancy_reads.h"
#include "engine/render/scene/tiles.h"
#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

using gpu::Use;

std::vector<gpu::SpecConstant> with_target(std::vector<gpu::SpecConstant> own,
                                           const SceneRefs& scene, bool to_picture) {
  return to_picture ? with_picture(std::move(own), scene) : own;
}

std::vector<gpu::SpecConstant> constants_of_sky(const ShadeIn& in) {
  return {{0, in.stars ? 1u : 0u}, {1, in.discs ? 1u : 0u}};
}

/// Adds surfaces and sky, both into `target`. @return its last version.
gpu::ImageRef shade(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const Geometry& geometry, const Shadows& shadows, const ShadeIn& in,
                    gpu::ImageRef target, bool to_picture) {
  const Tiles tiles =
      classify_tiles(graph, pipelines, "classify_tiles", geometry.surfaces(), scene.size);
  const SurfaceReads surfaces(geometry);
  const gpu::ImageRef maps = shadows.maps();
  const OccupancyReads occupancy(scene, scene.corners && scene.bodies != 0);
  const std::optional<CloudRefs> clouds = clouds_before_light(scene);
  const std::string suffix = to_picture ? "_to_picture.comp" : ".comp";
  const gpu::Pipeline& surface_pipeline = pipelines.get(gpu::ComputeDesc{
      std::string("shade_surfaces") + (maps ? "" : "_unshadowed") + surfaces.suffix() +
          (clouds ? "_clouded" : "") + suffix,
      with_target(with_clouds(with_corners(surfaces.with_store(with_light(
                                               {{0, static_cast<std::uint32_t>(in.texture_taps)}},
                                               scene, bool{maps})),
                                           bool{occupancy}),
                              clouds),
                  scene, to_picture)});
  graph.add_pass(
      "shade_surfaces",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        surfaces.declare(b);
        occupancy.declare(b);
        if (clouds) clouds->declare_light(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        if (to_picture) b.read(scene.exposure, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        target = b.write(target, Use::kComputeWrite);
      },
      [&surface_pipeline, scene, tiles, surfaces, occupancy, clouds, maps, target,
       to_picture](gpu::Commands& c) {
        c.bind(surface_pipeline);
        c.storage(0, scene.frame);
        c.storage(1, scene.islands);
        c.storage(2, scene.materials);
        c.storage(4, scene.pixel_stats);
        surfaces.bind(c, scene.point_sampler, 5, 6);
        occupancy.bind(c);
        if (clouds) clouds->bind_light(c);
        c.sampled(7, scene.block_textures, scene.block_sampler);
        c.sampled(8, scene.sky_lut, scene.lut_sampler);
        c.storage(9, target);
        if (maps) c.sampled(12, maps, scene.point_sampler);
        if (to_picture) c.storage(22, scene.exposure);
        dispatch_tiles(c, tiles, TileKind::kCovered);
      });
  const gpu::Pipeline& sky_pipeline = pipelines.get(
      gpu::ComputeDesc{"shade_sky" + suffix, with_target(constants_of_sky(in), scene, to_picture)});
  const gpu::ImageRef words = geometry.surfaces();
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky}) b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        b.read(words, Use::kComputeRead);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (to_picture) b.read(scene.exposure, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        target = b.write(target, Use::kComputeWrite);
      },
      [&sky_pipeline, scene, tiles, words, target, to_picture](gpu::Commands& c) {
        c.bind(sky_pipeline);
        c.storage(0, scene.frame);
        c.storage(3, scene.sky);
        c.storage(4, scene.pixel_stats);
        c.storage(5, words);
        c.sampled(8, scene.sky_lut, scene.lut_sampler);
        c.storage(9, target);
        if (to_picture) c.storage(22, scene.exposure);
        dispatch_tiles(c, tiles, TileKind::kOpen);
      });
  return target;
}

/// Sky for every pixel into `target`. @return its last version.
gpu::ImageRef shade_sky_everywhere(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                   SceneRefs& scene, const ShadeIn& in, gpu::ImageRef target,
                                   bool to_picture) {
  const gpu::Pipeline& pipeline = pipelines.get(gpu::ComputeDesc{
      to_picture ? "shade_sky_everywhere_to_picture.comp" : "shade_sky_everywhere.comp",
      with_target(constants_of_sky(in), scene, to_picture)});
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sky}) b.read(ref, Use::kComputeRead);
        b.read(scene.sky_lut, Use::kComputeSampled);
        if (to_picture) b.read(scene.exposure, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        target = b.write(target, Use::kComputeWrite);
      },
      [&pipeline, scene, target, to_picture](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(3, scene.sky);
        c.storage(4, scene.pixel_stats);
        c.sampled(8, scene.sky_lut, scene.lut_sampler);
        c.storage(9, target);
        if (to_picture) c.storage(22, scene.exposure);
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
                      const Geometry& geometry, const Shadows& shadows, const ShadeIn& in) {
  return Shaded(
      shade(graph, pipelines, scene, geometry, shadows, in, radiance(graph, scene), false));
}

Developed ShadePass::add_to_picture(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                    SceneRefs& scene, const Geometry& geometry,
                                    const Shadows& shadows, const ShadeIn& in,
                                    gpu::Image& picture) {
  return Developed(
      shade(graph, pipelines, scene, geometry, shadows, in, graph.import(picture), true));
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
