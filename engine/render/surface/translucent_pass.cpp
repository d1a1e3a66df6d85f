#include "engine/render/surface/translucent_pass.h"

#include <shader_names.h>
#include <array>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

TranslucentPass::Layers TranslucentPass::draw(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                              const SceneRefs& scene, const CulledDraws& draws,
                                              const Geometry& geometry, int layers) {
  static constexpr std::array<const char*, 4> kNames{"draw_translucent_0", "draw_translucent_1",
                                                     "draw_translucent_2", "draw_translucent_3"};
  Layers out;
  out.count = static_cast<std::uint32_t>(layers);
  const gpu::ImageRef opaque_depth = geometry.depth();
  for (std::uint32_t k = 0; k < out.count; ++k) {
    gpu::ImageRef& words = out.surfaces[k];
    gpu::ImageRef& depth = out.depth[k];
    words = graph.create(gpu::ImageDesc{
        .name = "translucent surfaces", .format = VK_FORMAT_R32_UINT, .extent = scene.size});
    depth = graph.create(gpu::ImageDesc{
        .name = "translucent depth", .format = VK_FORMAT_D32_SFLOAT, .extent = scene.size});
    const gpu::ImageRef previous = k == 0 ? opaque_depth : out.depth[k - 1];
    const auto program = gpu::graphics(
        pipelines, programs::kDrawQuadsVert, programs::kWriteLayerFrag,
        gpu::GraphicsDesc{.constants = {{shared::kFirstLayerConstant, k == 0 ? 1u : 0u}},
                          .color_formats = {VK_FORMAT_R32_UINT},
                          .depth_format = VK_FORMAT_D32_SFLOAT,
                          .cull = VK_CULL_MODE_NONE});
    graph.add_pass(
        kNames[k],
        [&](gpu::PassBuilder& b) {
          declare_draws(b, scene, draws);
          b.read(opaque_depth, Use::kFragmentRead);
          if (k > 0) b.read(previous, Use::kFragmentRead);
          words = b.color(words, gpu::Load::cleared({}));
          depth = b.depth(depth, gpu::Load::cleared({}));
        },
        [scene, draws, opaque_depth, previous, program](gpu::Commands& c) {
          gpu::bind(c, program,
                    gpu::sampled<shared::kDepthsBinding>(opaque_depth, scene.point_sampler),
                    gpu::sampled<shared::kPreviousDepthsBinding>(previous, scene.point_sampler),
                    draw_bindings(scene, draws));
          draw_list(c, scene, draws, 0, DrawList::kTranslucent);
        });
  }
  return out;
}

Shaded TranslucentPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                            const Geometry& geometry, const Shadows& shadows, const Layers& layers,
                            const ClusteredLights* lights, Shaded shaded,
                            const RenderSettings& settings, bool inside_medium) {
  const gpu::ImageRef opaque_depth = geometry.depth();
  // Inside a medium every pixel is looked at through it; else only those with a translucent
  // surface.
  const Tiles tiles = classify_tiles(graph, pipelines, "classify_translucent_tiles",
                                     layers.surfaces[0], scene.size);
  gpu::ImageRef radiance = shaded.radiance();
  const gpu::ImageRef maps = shadows.maps();
  std::vector<gpu::SpecConstant> constants =
      with_light({{shared::kLayersConstant, layers.count}}, scene, bool{maps});
  const WallReads walls(scene, settings, false);
  const CloudRefs clouds = clouds_before_light(scene);
  constants = clouds.with_clouds(std::move(constants));
  if (layers.mirrored_clouds) constants.push_back({shared::kMirroredCloudsConstant, 1});
  const ClusteredLights lit = lights ? *lights : ClusteredLights::none(scene);
  if (lights) constants = walls.with_walls(lit.with_lights(std::move(constants)));
  const auto program = gpu::compute(pipelines, programs::kShadeTranslucent, std::move(constants));
  graph.add_pass(
      "shade_translucent",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, tiles);
        clouds.declare_light(b);
        if (layers.mirrored_clouds) b.read(layers.mirrored_clouds, Use::kComputeSampled);
        lit.declare(b);
        walls.declare(b);
        for (std::uint32_t k = 0; k < layers.count; ++k) {
          b.read(layers.surfaces[k], Use::kComputeRead);
          b.read(layers.depth[k], Use::kComputeSampled);
        }
        for (const gpu::ImageRef ref : {opaque_depth, scene.sky_lut, scene.block_textures})
          b.read(ref, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [scene, layers, tiles, inside_medium, opaque_depth, maps, radiance, walls, clouds, program,
       lit](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::storage<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            gpu::sampled<shared::kDepthsBinding>(opaque_depth, scene.point_sampler),
            gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.lut_sampler),
            gpu::storage<shared::kRadianceBinding>(radiance),
            gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                     scene.point_sampler),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            clouds.light_bindings(),
            // Where none are known, something that is never read is bound in their place.
            gpu::sampled<shared::kMirroredCloudsBinding>(
                layers.mirrored_clouds ? layers.mirrored_clouds : scene.sky_lut,
                scene.point_sampler),
            layers.bindings(scene.point_sampler), lit.bindings(), walls.bindings(),
            tiles.bindings());
        dispatch_tiles(c, tiles, TileKind::kCovered);
        if (inside_medium) dispatch_tiles(c, tiles, TileKind::kOpen);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
