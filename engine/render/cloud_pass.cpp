#include "engine/render/cloud_pass.h"

#include <string>

#include "engine/render/light_constants.h"

namespace skerry::render {
namespace {

using gpu::Use;

enum class Part : std::uint8_t { kAll, kBefore, kBehind };  // of water or glass

/// What programs that include cloud_view.glsl read.
class ViewReads {
 public:
  ViewReads(const SceneRefs& scene, const CloudPass::View& view, Part part)
      : scene_(scene), clouds_(*scene.clouds), maps_(view.shadow_maps), part_(part) {
    if (view.geometry) {
      surfaces_ = view.geometry->surfaces();
      depth_ = view.geometry->depth();
      depth16_ = view.geometry->store().depth == DepthStore::kD16;
    }
    if (part != Part::kAll) layer_depth_ = view.layer_depth;
    if (view.lights) lights_ = *view.lights;
  }

  std::string program(const char* name) const {
    if (!depth_) return std::string(name) + "_sky.comp";
    return std::string(name) + (maps_ ? "" : "_unshadowed") + (lights_ ? "_lit.comp" : ".comp");
  }
  std::vector<gpu::SpecConstant> constants(std::vector<gpu::SpecConstant> own) const {
    if (depth16_) own.push_back({6, 1});
    if (layer_depth_) own.push_back({22, 1});
    if (part_ == Part::kBehind) own.push_back({23, 1});
    own = clouds_.with_clouds(with_light(std::move(own), scene_, bool{maps_}));
    return lights_ ? lights_->with_lights(std::move(own)) : own;
  }
  void declare(gpu::PassBuilder& b) const {
    b.read(scene_.frame, Use::kComputeRead);
    if (depth_) {
      b.read(surfaces_, Use::kComputeRead);
      b.read(depth_, Use::kComputeSampled);
    }
    if (layer_depth_) b.read(layer_depth_, Use::kComputeSampled);
    if (maps_) b.read(maps_, Use::kComputeSampled);
    b.read(scene_.sky_lut, Use::kComputeSampled);
    clouds_.declare_light(b);
    clouds_.declare_media(b);
    if (lights_) lights_->declare(b);
  }
  void bind(gpu::Commands& c) const {
    c.storage(0, scene_.frame);
    if (depth_) {
      c.storage(5, surfaces_);
      c.sampled(6, depth_, scene_.point_sampler);
      // Without water no layer is read; the binding is valid even so.
      c.sampled(15, layer_depth_ ? layer_depth_ : depth_, scene_.point_sampler);
    }
    c.sampled(8, scene_.sky_lut, scene_.lut_sampler);
    if (maps_) c.sampled(12, maps_, scene_.point_sampler);
    clouds_.bind_light(c);
    clouds_.bind_media(c);
    if (lights_) lights_->bind(c);
  }

 private:
  const SceneRefs scene_;
  CloudRefs clouds_;
  gpu::ImageRef maps_, surfaces_, depth_, layer_depth_;
  std::optional<ClusteredLights> lights_;
  bool depth16_ = false;
  Part part_;
};

void dispatch_over(gpu::Commands& c, VkExtent2D size) {
  c.dispatch(gpu::Commands::groups(size.width, 8), gpu::Commands::groups(size.height, 8), 1);
}

gpu::ImageRef march(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                    const ViewReads& reads) {
  const VkExtent2D size{(scene.size.width + 1) / 2, (scene.size.height + 1) / 2};
  gpu::ImageRef coarse = graph.create(gpu::ImageDesc{
      .name = "coarse clouds", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = size});
  graph.add_pass(
      "march_clouds",
      [&](gpu::PassBuilder& b) {
        reads.declare(b);
        coarse = b.write(coarse, Use::kComputeWrite);
      },
      [reads, coarse, size,
       &pipeline = pipelines.get(gpu::ComputeDesc{reads.program("march_clouds"),
                                                  reads.constants({})})](gpu::Commands& c) {
        c.bind(pipeline);
        reads.bind(c);
        c.storage(14, coarse);
        dispatch_over(c, size);
      });
  return coarse;
}

gpu::ImageRef blend(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const char* name, const ViewReads& reads, gpu::ImageRef coarse,
                    gpu::ImageRef radiance) {
  std::vector<gpu::SpecConstant> constants;
  if (coarse) constants.push_back({24, 1});
  graph.add_pass(
      name,
      [&](gpu::PassBuilder& b) {
        reads.declare(b);
        if (coarse) b.read(coarse, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [reads, coarse, radiance, stats = scene.pixel_stats, size = scene.size, lut = scene.sky_lut,
       sampler = scene.point_sampler,
       &pipeline = pipelines.get(
           gpu::ComputeDesc{reads.program("blend_clouds"), reads.constants(std::move(constants))})](
          gpu::Commands& c) {
        c.bind(pipeline);
        reads.bind(c);
        c.storage(4, stats);
        c.storage(9, radiance);
        c.sampled(14, coarse ? coarse : lut, sampler);
        dispatch_over(c, size);
      });
  return radiance;
}

}  // namespace

std::vector<gpu::SpecConstant> CloudRefs::with_clouds(std::vector<gpu::SpecConstant> own) const {
  if (layer) own.push_back({20, 1});
  if (volumes != 0) own.push_back({21, volumes});
  return own;
}

void CloudRefs::declare_light(gpu::PassBuilder& b) const {
  b.read(constants, Use::kComputeRead);
  b.read(layer_light, Use::kComputeSampled);
  b.read(volume_light, Use::kComputeSampled);
}

void CloudRefs::bind_light(gpu::Commands& c) const {
  c.storage(3, constants);
  c.sampled(30, layer_light, linear);
  c.sampled(31, volume_light, linear);
}

void CloudRefs::declare_media(gpu::PassBuilder& b) const {
  for (const gpu::ImageRef ref : {noise, cells, bricks}) b.read(ref, Use::kComputeSampled);
}

void CloudRefs::bind_media(gpu::Commands& c) const {
  c.sampled(10, noise, repeating);
  c.sampled(11, cells, nearest);
  c.sampled(13, bricks, linear);
}

Shaded CloudPass::add_behind(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                             const View& view, Shaded shaded) {
  const ViewReads reads(scene, view, Part::kBehind);
  return Shaded(
      blend(graph, pipelines, scene, "blend_clouds_behind_water", reads, {}, shaded.radiance()));
}

Shaded CloudPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const View& view, Shaded shaded, const CloudSettings& settings) {
  const ViewReads reads(scene, view, view.layer_depth ? Part::kBefore : Part::kAll);
  gpu::ImageRef coarse;
  if (settings.resolution == 2)
    coarse = march(graph, pipelines, scene, reads);
  else
    graph.leave_out("march_clouds", "clouds.resolution=full");
  return Shaded(blend(graph, pipelines, scene, "blend_clouds", reads, coarse, shaded.radiance()));
}

}  // namespace skerry::render
