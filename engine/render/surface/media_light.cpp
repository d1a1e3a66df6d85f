#include "engine/render/surface/media_light.h"

#include <shader_names.h>

namespace skerry::render {

using gpu::Use;

MediaLight MediaLight::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, const In& in, const Tiles& tiles,
                           const std::vector<TileKind>& covered) {
  MediaLight out;
  out.water_ = in.layers.count != 0;
  out.glass_ = static_cast<bool>(in.glass);
  if (!out.water_ && !out.glass_) return out;
  out.image_ = graph.create(
      gpu::ImageDesc{.name = "media light", .format = VK_FORMAT_R32G32_UINT, .extent = scene.size});
  const gpu::ImageRef depth = in.geometry.depth();
  // In place of what is then never read.
  const gpu::ImageRef words = out.water_ ? in.layers.surfaces : scene.no_layers;
  const gpu::ImageRef first = out.water_ ? in.layers.depth[0] : depth;
  out.first_layer_ = first;
  // Glass may stand anywhere before the sun, water only where it is in view.
  const Tiles& asked = out.glass_ ? tiles : in.layers.tiles;
  const std::vector<TileKind> kinds =
      out.glass_ ? covered : std::vector<TileKind>{TileKind::kCovered};
  const gpu::ImageRef maps = out.glass_ ? in.glass : scene.block_textures;
  const gpu::ImageRef shadows = out.glass_ ? in.shadow_maps : scene.block_textures;
  graph.add_pass(
      "find_media_light",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, asked);
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        for (const gpu::ImageRef ref : {depth, words, first, maps, shadows})
          b.read(ref, Use::kComputeSampled);
        out.image_ = b.write(out.image_, Use::kComputeWrite);
      },
      [scene, depth, words, first, maps, shadows, asked, kinds, image = out.image_,
       program = gpu::compute(pipelines, programs::kFindMediaLight, out.with_media({}))](
          gpu::Commands& c) {
        for (const TileKind kind : kinds) {
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::texels<shared::kIslandsBinding>(scene.islands),
                    gpu::storage<shared::kMaterialsBinding>(scene.materials),
                    gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
                    gpu::sampled<shared::kLayerSurfacesBinding>(words, scene.point_sampler),
                    gpu::sampled<shared::kLayerDepthsBinding>(first, scene.point_sampler),
                    gpu::sampled<shared::kGlassMapsBinding>(maps, scene.point_sampler),
                    gpu::sampled<shared::kShadowMapsBinding>(shadows, scene.point_sampler),
                    gpu::storage<shared::kMediaLightBinding>(image), asked.bindings(kind));
          dispatch_tiles(c, asked, kind);
        }
      });
  return out;
}

}  // namespace skerry::render
