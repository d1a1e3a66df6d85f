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
  gpu::ImageRef out = graph.import(picture);
  const gpu::ImageRef radiance = shaded.radiance(), glow = bloom ? bloom->glow : gpu::ImageRef{};
  const shared::BloomStep step = bloom ? bloom->step : shared::BloomStep{};
  std::vector<gpu::SpecConstant> constants = with_picture({}, scene);
  if (glow) constants.push_back({shared::kBloomConstant, 1});
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
      [scene, radiance, glow, step, out,
       program =
           gpu::compute(pipelines, programs::kDevelop, std::move(constants))](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
                  gpu::storage<shared::kRadianceBinding>(radiance),
                  gpu::storage<shared::kCoarseBloomBinding>(glow ? glow : radiance),
                  gpu::storage<shared::kTargetBinding>(out),
                  gpu::storage<shared::kExposureBinding>(scene.exposure));
        c.push(step);
        c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                   gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return Developed(out);
}

namespace {

bool shows_lights(DebugView view) {
  return view == DebugView::kClusters || view == DebugView::kLightCount;
}

gpu::ImageRef show_lights(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                          const Geometry& geometry, const ClusteredLights& lights, DebugView view,
                          gpu::ImageRef out) {
  const SurfaceReads surfaces(geometry);
  const auto program = gpu::compute(
      pipelines, programs::kShowLights,
      lights.with_lights({{shared::kReachingConstant, view == DebugView::kLightCount ? 1u : 0u}}));
  graph.add_pass(
      "show_lights",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands})
          b.read(ref, Use::kComputeRead);
        lights.declare(b);
        surfaces.declare(b);
        out = b.write(out, Use::kComputeWrite);
      },
      [program, scene, lights, surfaces, out](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kIslandsBinding>(scene.islands),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::storage<shared::kPictureBinding>(out), lights.bindings());
        c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                   gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return out;
}

}  // namespace

Developed DevelopPass::add_debug(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                 SceneRefs& scene, const Geometry& geometry, const Shadows& shadows,
                                 const ClusteredLights* lights, DebugView view,
                                 gpu::Image& picture) {
  gpu::ImageRef out = graph.import(picture);
  if (lights && shows_lights(view))
    return Developed(show_lights(graph, pipelines, scene, geometry, *lights, view, out));
  const SurfaceReads surfaces(geometry);
  const gpu::ImageRef maps = shadows.maps();
  const OccupancyReads occupancy(scene, scene.corners && view == DebugView::kCorners);
  const auto program = gpu::compute(
      pipelines, programs::kShowChannel,
      with_picture(with_corners(surfaces.with_store(with_light(
                                    {{shared::kChannelConstant, static_cast<std::uint32_t>(view)}},
                                    scene, bool{maps})),
                                bool{occupancy}),
                   scene));
  graph.add_pass(
      "show_channel",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.exposure})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        occupancy.declare(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        out = b.write(out, Use::kComputeWrite);
      },
      [program, scene, surfaces, occupancy, maps, out](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::storage<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            surfaces.bindings(scene.point_sampler), occupancy.bindings(),
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
