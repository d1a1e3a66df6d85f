#include "engine/render/surface/layer_light.h"

#include <shader_names.h>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

gpu::ImageRef add_layer_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              const LayerLightIn& in) {
  const TranslucentPass::Layers& layers = in.layers;
  gpu::ImageRef words = layers.surfaces;
  std::vector<gpu::SpecConstant> constants{{shared::kWaterLayersConstant, layers.count}};
  std::vector<TileKind> kinds{TileKind::kCovered};
  if (in.inside_medium) {
    constants.push_back({shared::kUnderWaterConstant, 1});
    kinds.push_back(TileKind::kOpen);
  }
  graph.add_pass(
      "find_layer_light",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, layers.tiles);
        for (const gpu::BufferRef ref : {in.scene.frame, in.scene.islands, in.scene.materials})
          b.read(ref, Use::kComputeRead);
        for (const gpu::ImageRef ref : {in.glass, in.shadows.maps()})
          b.read(ref, Use::kComputeSampled);
        for (std::uint32_t k = 0; k < layers.count; ++k)
          b.read(layers.depth[k], Use::kComputeSampled);
        words = b.write(words, Use::kComputeWrite);
      },
      [scene = in.scene, glass = in.glass, shadows = in.shadows.maps(), layers, words, kinds,
       program = gpu::compute(pipelines, programs::kFindLayerLight, std::move(constants))](
          gpu::Commands& c) {
        for (const TileKind kind : kinds) {
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::texels<shared::kIslandsBinding>(scene.islands),
                    gpu::storage<shared::kMaterialsBinding>(scene.materials),
                    gpu::sampled<shared::kGlassMapsBinding>(glass, scene.point_sampler),
                    gpu::sampled<shared::kShadowMapsBinding>(shadows, scene.point_sampler),
                    gpu::storage<shared::kLayerSurfacesBinding>(words, gpu::kAllLayers),
                    layers.depth_bindings(scene.point_sampler), layers.tiles.bindings(kind));
          dispatch_tiles(c, layers.tiles, kind);
        }
      });
  return words;
}

}  // namespace skerry::render
