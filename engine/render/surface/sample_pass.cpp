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

constexpr VkDeviceSize kDispatches = shared::kSampleLists * sizeof(shared::TileDispatch);

/// One of two passes: the points of a grid, then all pixels.
struct SamplePass {
  std::uint32_t step;     ///< pixels between the grid's points
  bool every_pixel;       ///< the second pass
  gpu::ImageRef samples;  ///< light at the grid's points
  ShadeTarget into;       ///< of the second pass
  /// shared::TileDispatch[kSampleLists] in groups of 64; then x | y << 16 of pixels that ask no
  /// light from the beginning, of the others from the end.
  gpu::BufferRef listed;

  std::string name(const char* what) const { return what + std::to_string(every_pixel ? 1 : step); }
  /// The second pass reads samples, and writes none: they stand in where the shader may write.
  void declare_samples(gpu::PassBuilder& b) { samples = b.write(samples, Use::kComputeWrite); }
  /// Whether there are programs that keep radiance, and such as do not.
  bool looks_for_layers() const { return every_pixel && into.layer_tiles; }
};

constexpr VkExtent2D points(VkExtent2D size, std::uint32_t step) {
  return {(size.width + step - 1) / step, (size.height + step - 1) / step};
}

std::vector<gpu::SpecConstant> choosing_constants(const SamplePass& pass, const SampleIn& on,
                                                  const SampledLight& light, bool squares) {
  const RenderSettings& settings = light.settings;
  std::vector<gpu::SpecConstant> constants{{shared::kStepConstant, pass.step}};
  if (squares) constants.push_back({shared::kSquaresConstant, 1});
  if (pass.every_pixel) {
    constants.push_back(
        {shared::kTextureTapsConstant, static_cast<std::uint32_t>(settings.texture_taps)});
    constants.push_back(
        {shared::kToleranceConstant, std::bit_cast<std::uint32_t>(settings.shading_tolerance)});
  }
  if (on.geometry.store().depth == DepthStore::kD16)
    constants.push_back({shared::kDepth16Constant, 1});
  if (!light.lights) return constants;
  constants.push_back({shared::kLitConstant, 1});
  if (light.lights->oracle) constants.push_back({shared::kOracleConstant, 1});
  return constants;
}

void add_clear(gpu::FrameGraph& graph, SamplePass& pass) {
  graph.add_pass(
      pass.name("choose_samples_") + "_clear",
      [&](gpu::PassBuilder& b) { pass.listed = b.write(pass.listed, Use::kTransferWrite); },
      [listed = pass.listed](gpu::Commands& c) { c.fill(listed, 0, kDispatches, 0); });
}

void add_sizing(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                SamplePass& pass) {
  const bool looks = pass.looks_for_layers();
  // In place of what is then never read.
  const gpu::BufferRef layers = looks ? pass.into.layer_tiles : scene.frame;
  graph.add_pass(
      pass.name("size_samples_"),
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, layers}) b.read(ref, Use::kComputeRead);
        pass.listed = b.write(pass.listed, Use::kComputeWrite);
      },
      [frame = scene.frame, layers, listed = pass.listed,
       program =
           gpu::compute(pipelines, programs::kSizeSamples,
                        {{shared::kTranslucentConstant, looks ? 1u : 0u}})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(frame),
                  gpu::storage<shared::kLayerTilesBinding>(layers),
                  gpu::storage<shared::kListedPixelsBinding>(listed));
        c.dispatch(1, 1, 1);
      });
}

/// Lists the grid's points that show a surface.
void add_points(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                const SampleIn& on, const SampledLight& light, SamplePass& pass) {
  const SurfaceReads surfaces(on.geometry);
  const ClusteredLights lights = light.lights ? *light.lights : ClusteredLights::none(scene);
  graph.add_pass(
      pass.name("choose_samples_"),
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        surfaces.declare(b);
        lights.declare_counts(b);
        pass.samples = b.write(pass.samples, Use::kComputeWrite);
        pass.listed = b.write(pass.listed, Use::kComputeWrite);
      },
      [scene, surfaces, pass, lights,
       program = gpu::compute(pipelines, programs::kListPoints,
                              choosing_constants(pass, on, light, false))](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::storage<shared::kSurfacesBinding>(surfaces.words),
                  gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
                  gpu::storage<shared::kSamplesBinding>(pass.samples),
                  gpu::storage<shared::kListedPixelsBinding>(pass.listed), lights.count_bindings());
        const VkExtent2D size = points(scene.size, pass.step);
        c.dispatch(gpu::Commands::groups(size.width, shared::kChooseGroup), size.height, 1);
      });
}

/// Lists the pixels that need light of their own; the others get it at once.
void add_choosing(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                  const SampleIn& on, const SampledLight& light, SamplePass& pass) {
  const SurfaceReads surfaces(on.geometry);
  const ClusteredLights lights = light.lights ? *light.lights : ClusteredLights::none(scene);
  const bool squares = on.tiles.squares;
  const auto program = [&](const auto& shader) {
    return [&](bool keep) {
      return gpu::compute(
          pipelines, shader,
          pass.into.with_output(choosing_constants(pass, on, light, squares), scene, keep));
    };
  };
  auto programs = programs_of(pass.into, squares ? TileKind::kMixedSquares : TileKind::kCovered,
                              program(programs::kChooseSamples));
  auto plain =
      programs_of(pass.into, TileKind::kPlainSquares, program(programs::kLightPlainSquares));
  if (!squares) plain.clear();
  graph.add_pass(
      pass.name("choose_samples_"),
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(pass.samples, Use::kComputeRead);
        declare_tiles(b, on.tiles);
        lights.declare_counts(b);
        pass.listed = b.write(pass.listed, Use::kComputeWrite);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        pass.into.declare(b, scene);
      },
      [scene, surfaces, pass, lights, tiles = on.tiles, plain = std::move(plain),
       programs = std::move(programs)](gpu::Commands& c) {
        const std::tuple bindings{
            gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kSurfacesBinding>(surfaces.words),
            gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            pass.into.bindings(scene),
            gpu::storage<shared::kSamplesBinding>(pass.samples),
            gpu::storage<shared::kListedPixelsBinding>(pass.listed),
            lights.count_bindings()};
        for (const auto& some : plain) {
          gpu::bind(c, some.second, bindings, tiles.bindings(some.first));
          dispatch_tiles(c, tiles, some.first);
        }
        for (const auto& some : programs) {
          gpu::bind(c, some.second, bindings, tiles.bindings(some.first));
          dispatch_tiles(c, tiles, some.first);
        }
      });
}

/// @param lights those that its pixels ask; null: none.
auto shading_program(gpu::Pipelines& pipelines, const SceneRefs& scene, const SampleIn& on,
                     const SampledLight& light, const ClusteredLights* lights,
                     const SamplePass& pass, bool keep) {
  const bool maps{on.shadows.maps()};
  std::vector<gpu::SpecConstant> constants = with_light(
      {{shared::kTextureTapsConstant, static_cast<std::uint32_t>(light.settings.texture_taps)},
       {shared::kStepConstant, pass.step}},
      scene, maps);
  if (pass.every_pixel) constants.push_back({shared::kEveryPixelConstant, 1});
  constants = on.media.with_media(clouds_before_light(scene).with_clouds(
      with_ao(SurfaceReads(on.geometry).with_depth(std::move(constants)), scene.ao)));
  if (lights) {
    constants = WallReads(scene, light.settings, scene.ao)
                    .with_walls(lights->with_panes(std::move(constants)));
  }
  return gpu::compute(pipelines, programs::kShadeSamples,
                      pass.into.with_output(std::move(constants), scene, keep));
}

/// Works out the light of the listed pixels.
void add_shading(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                 const SampleIn& on, const SampledLight& light, SamplePass& pass) {
  const SurfaceReads surfaces(on.geometry);
  const WallReads walls(scene, light.settings, scene.ao);
  const CloudRefs clouds = clouds_before_light(scene);
  const ClusteredLights lights = light.lights ? *light.lights : ClusteredLights::none(scene);
  const gpu::ImageRef maps = on.shadows.maps();
  using Program = decltype(shading_program(pipelines, scene, on, light, nullptr, pass, true));
  struct Listed {
    Program program;
    std::uint32_t list;
  };
  std::vector<Listed> programs;
  for (const bool keep : {false, true}) {
    if (!keep && !pass.looks_for_layers()) continue;
    const std::uint32_t first = keep && pass.looks_for_layers() ? shared::kKeepingLists : 0u;
    programs.push_back({shading_program(pipelines, scene, on, light, nullptr, pass, keep), first});
    if (!light.lights) continue;
    programs.push_back(
        {shading_program(pipelines, scene, on, light, light.lights, pass, keep), first + 1});
  }
  graph.add_pass(
      pass.name("shade_samples_"),
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref :
             {scene.frame, scene.islands, scene.materials, scene.indirect, scene.island_skies})
          b.read(ref, Use::kComputeRead);
        surfaces.declare(b);
        walls.declare(b);
        on.media.declare(b, scene);
        clouds.declare_light(b);
        lights.declare(b);
        if (maps) b.read(maps, Use::kComputeSampled);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(scene.sky_lut, Use::kComputeSampled);
        b.read(pass.listed, Use::kIndirect);
        b.read(pass.listed, Use::kComputeRead);
        pass.declare_samples(b);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        pass.into.declare(b, scene);
      },
      [programs = std::move(programs), scene, surfaces, walls, media = on.media, clouds, lights,
       maps, pass](gpu::Commands& c) {
        const std::tuple bindings{
            gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            gpu::storage<shared::kSurfacesBinding>(surfaces.words),
            gpu::sampled<shared::kDepthsBinding>(surfaces.depth, scene.point_sampler),
            walls.bindings(),
            media.bindings(scene),
            gpu::texels<shared::kIndirectBinding>(scene.indirect),
            gpu::texels<shared::kIslandSkiesBinding>(scene.island_skies),
            clouds.light_bindings(),
            lights.bindings(),
            lights.reach_binding(),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::sampled<shared::kSkyTableBinding>(scene.sky_lut, scene.sky_sampler),
            pass.into.bindings(scene),
            gpu::storage<shared::kSamplesBinding>(pass.samples),
            gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene, maps),
                                                     scene.point_sampler),
            gpu::storage<shared::kListedPixelsBinding>(pass.listed)};
        for (const Listed& some : programs) {
          gpu::bind(c, some.program, bindings);
          c.dispatch_indirect(pass.listed, some.list * sizeof(shared::TileDispatch));
        }
      });
}

}  // namespace

void add_sample_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                       const SampleIn& on, const SampledLight& light, ShadeTarget& into) {
  const auto rate = static_cast<std::uint32_t>(light.settings.shading_rate);
  SKERRY_ASSERT(rate > 1);
  SamplePass pass{.step = rate,
                  .every_pixel = false,
                  .samples = graph.create({.name = "light samples",
                                           .format = VK_FORMAT_R32G32B32A32_UINT,
                                           .extent = points(scene.size, rate)}),
                  .into = into,
                  .listed = {}};
  for (const bool every_pixel : {false, true}) {
    pass.every_pixel = every_pixel;
    const VkExtent2D size = points(scene.size, every_pixel ? 1 : rate);
    pass.listed = graph.create(
        gpu::BufferDesc{"sample list", kDispatches + std::uint64_t{size.width} * size.height * 4, 0,
                        gpu::Memory::kDevice});
    add_clear(graph, pass);
    if (every_pixel)
      add_choosing(graph, pipelines, scene, on, light, pass);
    else
      add_points(graph, pipelines, scene, on, light, pass);
    add_sizing(graph, pipelines, scene, pass);
    add_shading(graph, pipelines, scene, on, light, pass);
  }
  into = pass.into;
}

}  // namespace skerry::render
