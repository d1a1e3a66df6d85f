#include "engine/render/surface/sample_pass.h"

#include <shader_names.h>

#include <bit>
#include <cstddef>
#include <string>
#include <utility>

#include "engine/core/check.h"
#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/occupancy_reads.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

using gpu::Use;

/// The pixels whose coordinates are multiples of `step`.
struct SampleLevel {
  std::uint32_t step = 1;
  gpu::ImageRef coarser;          ///< samples of the next coarser one; empty: there is none
  gpu::ImageRef own;              ///< samples; empty at step 1, which writes radiance
  gpu::ImageRef radiance;         ///< of the picture
  gpu::BufferRef listed, pixels;  ///< shared::TileDispatch in groups of 64, and x | y << 16

  /// What is bound where samples are read and written; where there are none, the other one, which
  /// is then not used.
  gpu::ImageRef read() const { return coarser ? coarser : own; }
  gpu::ImageRef written() const { return own ? own : coarser; }
};

constexpr VkExtent2D points(VkExtent2D size, std::uint32_t step) {
  return {(size.width + step - 1) / step, (size.height + step - 1) / step};
}

std::vector<gpu::SpecConstant> choosing_constants(const SampleLevel& level, const SampleIn& on,
                                                  const RenderSettings& settings) {
  std::vector<gpu::SpecConstant> constants{
      {shared::kTextureTapsConstant, static_cast<std::uint32_t>(settings.texture_taps)},
      {shared::kStepConstant, level.step},
      {shared::kToleranceConstant, std::bit_cast<std::uint32_t>(settings.shading_tolerance)}};
  if (!level.coarser) constants.push_back({shared::kFirstConstant, 1});
  if (on.geometry.store().depth == DepthStore::kD16)
    constants.push_back({shared::kDepth16Constant, 1});
  return constants;
}

void add_clear(gpu::FrameGraph& graph, SampleLevel& level) {
  graph.add_pass(
      "choose_samples_" + std::to_string(level.step) + "_clear",
      [&](gpu::PassBuilder& b) { level.listed = b.write(level.listed, Use::kTransferWrite); },
      [listed = level.listed](gpu::Commands& c) {
        c.fill(listed, offsetof(shared::TileDispatch, groups_x), 4, 0);
        c.fill(listed, offsetof(shared::TileDispatch, groups_y), 8, 1);
        c.fill(listed, offsetof(shared::TileDispatch, tiles), 4, 0);
      });
}

/// The finest level writes no samples: the coarser ones stand in where the shader may write.
void declare_coarser(gpu::PassBuilder& b, SampleLevel& level) {
  if (!level.coarser) return;
  if (level.own) return b.read(level.coarser, Use::kComputeRead);
  level.coarser = b.write(level.coarser, Use::kComputeWrite);
}

/// Lists the level's pixels that need light of their own; the others get it at once.
void add_choosing(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                  const SampleIn& on, SampleLevel& level,
                  std::vector<gpu::SpecConstant> constants) {
  const SurfaceReads surfaces(on.geometry);
  graph.add_pass(
      "choose_samples_" + std::to_string(level.step),
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        declare_coarser(b, level);
        declare_tiles(b, on.tiles);
        level.listed = b.write(level.listed, Use::kComputeWrite);
        level.pixels = b.write(level.pixels, Use::kComputeWrite);
        if (level.own) level.own = b.write(level.own, Use::kComputeWrite);
        level.radiance = b.write(level.radiance, Use::kComputeWrite);
      },
      [scene, surfaces, level, tiles = on.tiles,
       program = gpu::compute(pipelines, programs::kChooseSamples, std::move(constants))](
          gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::storage<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kSurfacesBinding>(surfaces.words),
            gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::storage<shared::kRadianceBinding>(level.radiance),
            gpu::storage<shared::kCoarserSamplesBinding>(level.read()),
            gpu::storage<shared::kOwnSamplesBinding>(level.written()),
            gpu::storage<shared::kListedBinding>(level.listed),
            gpu::storage<shared::kListedPixelsBinding>(level.pixels),
            tiles.bindings(TileKind::kCovered));
        if (level.step == 1) return dispatch_tiles(c, tiles, TileKind::kCovered);
        const VkExtent2D size = points(scene.size, level.step);
        c.dispatch(gpu::Commands::groups(size.width, shared::kTileEdge),
                   gpu::Commands::groups(size.height, shared::kTileEdge), 1);
      });
}

auto shading_program(gpu::Pipelines& pipelines, const SceneRefs& scene, const SampleIn& on,
                     const SampledLight& light, bool last) {
  const bool maps{on.shadows.maps()};
  std::vector<gpu::SpecConstant> constants = with_light(
      {{shared::kTextureTapsConstant, static_cast<std::uint32_t>(light.settings.texture_taps)}},
      scene, maps);
  if (last) constants.push_back({shared::kEveryPixelConstant, 1});
  constants = clouds_before_light(scene).with_clouds(
      with_ao(SurfaceReads(on.geometry).with_store(std::move(constants)), scene.ao));
  if (light.lights) {
    constants = WallReads(scene, light.settings, scene.ao)
                    .with_walls(light.lights->with_lights(std::move(constants)));
  }
  return gpu::compute(pipelines, programs::kShadeSamples, std::move(constants));
}

/// Works out the light of the listed pixels.
void add_shading(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                 const SampleIn& on, const SampledLight& light, SampleLevel& level) {
  const SurfaceReads surfaces(on.geometry);
  const WallReads walls(scene, light.settings, scene.ao);
  const CloudRefs clouds = clouds_before_light(scene);
  const ClusteredLights lights = light.lights ? *light.lights : ClusteredLights::none(scene);
  const gpu::ImageRef maps = on.shadows.maps();
  graph.add_pass(
      "shade_samples_" + std::to_string(level.step),
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.indirect})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        walls.declare(b);
        clouds.declare_light(b);
        lights.declare(b);
        if (maps) b.read(maps, Use::kComputeSampled);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(scene.sky_lut, Use::kComputeSampled);
        b.read(level.listed, Use::kIndirect);
        b.read(level.listed, Use::kComputeRead);
        b.read(level.pixels, Use::kComputeRead);
        declare_coarser(b, level);
        if (level.own) level.own = b.write(level.own, Use::kComputeWrite);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        level.radiance = b.write(level.radiance, Use::kComputeWrite);
      },
      [program = shading_program(pipelines, scene, on, light, level.step == 1), scene, surfaces,
       walls, clouds, lights, maps, level](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::storage<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            surfaces.bindings(scene.point_sampler), walls.bindings(),
            gpu::texels<shared::kIndirectBinding>(scene.indirect), clouds.light_bindings(),
            lights.bindings(), lights.reach_binding(),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.lut_sampler),
            gpu::storage<shared::kRadianceBinding>(level.radiance),
            gpu::storage<shared::kOwnSamplesBinding>(level.written()),
            gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                     scene.point_sampler),
            gpu::storage<shared::kListedBinding>(level.listed),
            gpu::storage<shared::kListedPixelsBinding>(level.pixels), gpu::constants(level.step));
        c.dispatch_indirect(level.listed, 0);
      });
}

}  // namespace

gpu::ImageRef add_sample_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                                const SampleIn& on, const SampledLight& light,
                                gpu::ImageRef radiance) {
  SKERRY_ASSERT(light.rate == 2 || light.rate == 4);
  gpu::ImageRef coarser;
  for (std::uint32_t step = light.rate; step > 0; step /= 2) {
    const VkExtent2D size = points(scene.size, step);
    SampleLevel level{.step = step,
                      .coarser = coarser,
                      .own = {},
                      .radiance = radiance,
                      .listed = {},
                      .pixels = {}};
    level.listed = graph.create(
        gpu::BufferDesc{"sample dispatch", sizeof(shared::TileDispatch), 0, gpu::Memory::kDevice});
    level.pixels = graph.create(gpu::BufferDesc{
        "sample list", std::uint64_t{size.width} * size.height * 4, 0, gpu::Memory::kDevice});
    if (step != 1)
      level.own = graph.create(gpu::ImageDesc{
          .name = "light samples", .format = VK_FORMAT_R32G32B32A32_UINT, .extent = size});
    add_clear(graph, level);
    add_choosing(graph, pipelines, scene, on, level, choosing_constants(level, on, light.settings));
    add_shading(graph, pipelines, scene, on, light, level);
    radiance = level.radiance;
    coarser = level.own;
  }
  return radiance;
}

}  // namespace skerry::render
