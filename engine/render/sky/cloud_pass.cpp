#include "engine/render/sky/cloud_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {
namespace {

using gpu::Use;

enum class Part : std::uint8_t { kAll, kBefore, kBehind };  // of water or glass

/// What both steps of blend_clouds.comp read.
class ViewReads {
 public:
  ViewReads(const SceneRefs& scene, const CloudPass::View& view, const RenderSettings& settings,
            Part part)
      : scene_(scene),
        clouds_(*scene.clouds),
        maps_(view.shadow_maps),
        surfaces_(scene.no_words),
        lights_(view.lights ? *view.lights : ClusteredLights::none(scene)),
        walls_(scene, settings, false),
        part_(part) {
    if (view.geometry) {
      surfaces_ = view.geometry->surfaces();
      depth_ = view.geometry->depth();
      depth16_ = view.geometry->store().depth == DepthStore::kD16;
    }
    if (part != Part::kAll) layer_depth_ = view.layer_depth;
  }

  std::vector<gpu::SpecConstant> constants(std::vector<gpu::SpecConstant> own) const {
    if (!depth_) own.push_back({shared::kSkyAloneConstant, 1});
    if (depth16_) own.push_back({shared::kDepth16Constant, 1});
    if (layer_depth_) own.push_back({shared::kTranslucentConstant, 1});
    if (part_ == Part::kBehind) own.push_back({shared::kBehindConstant, 1});
    own = clouds_.with_clouds(with_light(std::move(own), scene_, bool{maps_}));
    return lit() ? walls_.with_walls(lights_.with_lights(std::move(own))) : own;
  }
  void declare(gpu::PassBuilder& b) const {
    b.read(scene_.frame, Use::kComputeRead);
    b.read(surfaces_, Use::kComputeRead);
    b.read(depth_or_other(), Use::kComputeSampled);
    if (layer_depth_) b.read(layer_depth_, Use::kComputeSampled);
    b.read(maps_or_others(scene_, maps_), Use::kComputeSampled);
    b.read(scene_.sky_lut, Use::kComputeSampled);
    clouds_.declare_light(b);
    clouds_.declare_media(b);
    lights_.declare(b);
    walls_.declare(b);
    b.read(scene_.islands, Use::kComputeRead);
  }
  auto bindings() const {
    return std::tuple{gpu::storage<shared::kFrameBinding>(scene_.frame),
                      gpu::storage<shared::kSurfacesBinding>(surfaces_),
                      gpu::sampled<shared::kDepthsBinding>(depth_or_other(), scene_.point_sampler),
                      // Without water no layer is read; the binding is valid even so.
                      gpu::sampled<shared::kLayerDepthsBinding>(
                          layer_depth_ ? layer_depth_ : depth_or_other(), scene_.point_sampler),
                      gpu::sampled<shared::kSkyTableBinding>(scene_.sky_lut, scene_.sky_sampler),
                      gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene_, maps_),
                                                               scene_.point_sampler),
                      clouds_.light_bindings(), clouds_.media_bindings(), lights_.bindings(),
                      walls_.bindings(), gpu::texels<shared::kIslandsBinding>(scene_.islands)};
  }

 private:
  bool lit() const { return lights_.kinds != 0; }
  gpu::ImageRef depth_or_other() const { return depth_ ? depth_ : scene_.sky_lut; }

  const SceneRefs scene_;
  CloudRefs clouds_;
  gpu::ImageRef maps_, surfaces_, depth_, layer_depth_;
  ClusteredLights lights_;
  WallReads walls_;
  bool depth16_ = false;
  Part part_;
};

void dispatch_over(gpu::Commands& c, VkExtent2D size) {
  c.dispatch(gpu::Commands::groups(size.width, 8), gpu::Commands::groups(size.height, 8), 1);
}

void dispatch_over_fours(gpu::Commands& c, VkExtent2D size) {
  c.dispatch(gpu::Commands::groups(size.width, 16), gpu::Commands::groups(size.height, 16), 1);
}

/// A texel for four pixels.
gpu::ImageRef coarse_image(gpu::FrameGraph& graph, const SceneRefs& scene, const char* name) {
  return graph.create(
      gpu::ImageDesc{.name = name,
                     .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                     .extent = {(scene.size.width + 1) / 2, (scene.size.height + 1) / 2}});
}

/// What a step of blend_clouds.comp writes; what it does not is bound to another of its images.
struct Written {
  gpu::BufferRef stats;
  gpu::ImageRef radiance, marched;

  auto bindings() const {
    return std::tuple{gpu::storage<shared::kPixelStatsBinding>(stats),
                      gpu::storage<shared::kRadianceBinding>(radiance),
                      gpu::storage<shared::kMarchedCloudsBinding>(marched)};
  }
};

gpu::ImageRef march(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const ViewReads& reads) {
  gpu::ImageRef coarse = coarse_image(graph, scene, "coarse clouds");
  graph.add_pass(
      "march_clouds",
      [&](gpu::PassBuilder& b) {
        reads.declare(b);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        coarse = b.write(coarse, Use::kComputeWrite);
      },
      [reads, written = Written{scene.pixel_stats, coarse, coarse}, size = scene.size,
       lut = scene.sky_lut, sampler = scene.point_sampler,
       program = gpu::compute(pipelines, programs::kBlendClouds,
                              reads.constants({{shared::kMarchConstant, 1}}))](gpu::Commands& c) {
        gpu::bind(c, program, reads.bindings(), written.bindings(),
                  gpu::sampled<shared::kCoarseCloudsBinding>(lut, sampler));
        dispatch_over_fours(c, size);
      });
  return coarse;
}

struct Blend {
  const char* name;
  const ViewReads& reads;
  gpu::ImageRef coarse;  // empty: every pixel marches
};

gpu::ImageRef blend(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const Blend& in, gpu::ImageRef radiance) {
  const ViewReads& reads = in.reads;
  const gpu::ImageRef coarse = in.coarse;
  std::vector<gpu::SpecConstant> constants;
  if (coarse) constants.push_back({shared::kCoarseConstant, 1});
  graph.add_pass(
      in.name,
      [&](gpu::PassBuilder& b) {
        reads.declare(b);
        if (coarse) b.read(coarse, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [reads, coarse, written = Written{scene.pixel_stats, radiance, radiance}, size = scene.size,
       lut = scene.sky_lut, sampler = scene.point_sampler,
       program = gpu::compute(pipelines, programs::kBlendClouds,
                              reads.constants(std::move(constants)))](gpu::Commands& c) {
        gpu::bind(c, program, reads.bindings(), written.bindings(),
                  gpu::sampled<shared::kCoarseCloudsBinding>(coarse ? coarse : lut, sampler));
        dispatch_over(c, size);
      });
  return radiance;
}

}  // namespace

std::vector<gpu::SpecConstant> CloudRefs::with_clouds(std::vector<gpu::SpecConstant> own) const {
  if (layer) own.push_back({shared::kCloudLayerConstant, 1});
  if (sky) own.push_back({shared::kCloudSkyConstant, 1});
  if (volumes != 0) own.push_back({shared::kCloudVolumesConstant, volumes});
  return own;
}

void CloudRefs::declare_light(gpu::PassBuilder& b) const {
  b.read(constants, Use::kComputeRead);
  b.read(layer_light, Use::kComputeSampled);
  b.read(volume_light, Use::kComputeSampled);
}

void CloudRefs::declare_media(gpu::PassBuilder& b) const {
  for (const gpu::ImageRef ref : {weather, shapes, billows, cells, bricks})
    b.read(ref, Use::kComputeSampled);
}

gpu::ImageRef CloudPass::add_mirrored(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                      const SceneRefs& scene, const View& view,
                                      const TranslucentPass::Layers& layers) {
  gpu::ImageRef mirrored = coarse_image(graph, scene, "mirrored clouds");
  const gpu::ImageRef maps = view.shadow_maps;
  const auto program = gpu::compute(pipelines, programs::kMarchMirroredClouds,
                                    scene.clouds->with_clouds(with_light({}, scene, bool{maps})));
  graph.add_pass(
      "march_mirrored_clouds",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        scene.clouds->declare_light(b);
        scene.clouds->declare_media(b);
        b.read(scene.sky_lut, Use::kComputeSampled);
        b.read(maps_or_others(scene, maps), Use::kComputeSampled);
        b.read(layers.surfaces, Use::kComputeRead);
        b.read(layers.depth[0], Use::kComputeSampled);
        mirrored = b.write(mirrored, Use::kComputeWrite);
      },
      [scene, layers, maps, mirrored, program](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::texels<shared::kIslandsBinding>(scene.islands),
                  gpu::storage<shared::kMaterialsBinding>(scene.materials),
                  scene.clouds->light_bindings(), scene.clouds->media_bindings(),
                  gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.sky_sampler),
                  gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                           scene.point_sampler),
                  gpu::storage<shared::kMirroredCloudsBinding>(mirrored),
                  gpu::sampled<shared::kLayerDepthsBinding>(layers.depth[0], scene.point_sampler),
                  gpu::storage<shared::kLayerSurfacesBinding>(layers.surfaces));
        dispatch_over_fours(c, scene.size);
      });
  return mirrored;
}

Shaded CloudPass::add_behind(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                             const View& view, Shaded shaded, const RenderSettings& settings) {
  const ViewReads reads(scene, view, settings, Part::kBehind);
  return Shaded(
      blend(graph, pipelines, scene, {"blend_clouds_behind_water", reads, {}}, shaded.radiance()));
}

Shaded CloudPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const View& view, Shaded shaded, const RenderSettings& settings) {
  const ViewReads reads(scene, view, settings, view.layer_depth ? Part::kBefore : Part::kAll);
  gpu::ImageRef coarse;
  if (settings.clouds.resolution == 2)
    coarse = march(graph, pipelines, scene, reads);
  else
    graph.leave_out("march_clouds", "clouds.resolution=full");
  return Shaded(blend(graph, pipelines, scene, {"blend_clouds", reads, coarse}, shaded.radiance()));
}

}  // namespace skerry::render
