#include "engine/render/post/develop_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/occupancy_reads.h"
#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

Developed DevelopPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                           Shaded shaded, const Bloom* bloom, gpu::Image& picture) {
  if (shaded.picture()) return Developed(shaded.picture());
  gpu::ImageRef out = graph.import(picture);
  const gpu::ImageRef radiance = shaded.radiance(), glow = bloom ? bloom->glow : gpu::ImageRef{};
  const shared::BloomStep step = bloom ? bloom->step : shared::BloomStep{};
  std::vector<gpu::SpecConstant> constants = with_picture({}, scene);
  const bool columns = glow && scene.on_cpu;
  if (glow) constants.push_back({shared::kBloomConstant, 1});
  if (columns) constants.push_back({shared::kColumnsConstant, 1});
  graph.add_pass(
      "develop",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(scene.exposure, Use::kComputeRead);
        b.read(radiance, Use::kComputeRead);
        if (glow) b.read(glow, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        out = b.write(out, Use::kComputeWrite);
      },
      [scene, radiance, glow, step, out, columns,
       program =
           gpu::compute(pipelines, programs::kDevelop, std::move(constants))](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                  gpu::storage<shared::kRadianceBinding>(radiance),
                  gpu::storage<shared::kCoarseBloomBinding>(glow ? glow : radiance),
                  gpu::storage<shared::kTargetBinding>(out),
                  gpu::storage<shared::kExposureBinding>(scene.exposure), gpu::constants(step));
        if (columns)
          dispatch_spread_columns(c, {scene.size.width, scene.size.height});
        else
          c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                     gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return Developed(out);
}

namespace {

bool shows_lights(DebugView view) {
  return view == DebugView::kClusters || view == DebugView::kLightCount;
}

}  // namespace

Developed DevelopPass::add_debug(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                 SceneRefs& scene, const DebugIn& in, gpu::Image& picture) {
  gpu::ImageRef out = graph.import(picture);
  const bool lit = in.lights && shows_lights(in.view);
  const ClusteredLights clusters = lit ? *in.lights : ClusteredLights::none(scene);
  const SurfaceReads surfaces(in.geometry);
  const gpu::ImageRef maps = in.shadows.maps();
  const OccupancyReads occupancy(scene, scene.ao && in.view == DebugView::kAo);
  const auto program = gpu::compute(
      pipelines, programs::kShowChannel,
      clusters.with_lights(with_picture(
          with_ao(surfaces.with_store(
                      with_light({{shared::kChannelConstant, static_cast<std::uint32_t>(in.view)}},
                                 scene, bool{maps})),
                  bool{occupancy}),
          scene)));
  graph.add_pass(
      lit ? "show_lights" : "show_channel",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.exposure})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        occupancy.declare(b);
        clusters.declare(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        out = b.write(out, Use::kComputeWrite);
      },
      [program, scene, surfaces, occupancy, clusters, maps, out](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            surfaces.bindings(scene.point_sampler), occupancy.bindings(), clusters.bindings(),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::storage<shared::kPictureBinding>(out),
            gpu::storage<shared::kExposureBinding>(scene.exposure),
            gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                     scene.point_sampler));
        c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                   gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return Developed(out);
}

}  // namespace skerry::render
