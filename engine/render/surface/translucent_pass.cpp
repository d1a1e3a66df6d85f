#include "engine/render/surface/translucent_pass.h"

#include <shader_names.h>
#include <array>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/tiles.h"
#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

namespace {

/// Of the growth of quads, by which walls stand out of water that they end in: seen at a slant,
/// level water grows less over the picture. Panes that overlapped more would hide one another.
constexpr float kAcrossShores = 4.0f;

}  // namespace

TranslucentPass::Layers TranslucentPass::draw(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                              const SceneRefs& scene, const CulledDraws& draws,
                                              const Geometry& geometry, const Kept& kept) {
  static constexpr std::array<const char*, 4> kNames{"draw_translucent_0", "draw_translucent_1",
                                                     "draw_translucent_2", "draw_translucent_3"};
  Layers out;
  out.count = static_cast<std::uint32_t>(kept.layers);
  out.shares = kept.shares;
  const gpu::ImageRef opaque_depth = geometry.depth();
  const glm::uvec4 shown = scene.layers_area;
  const VkRect2D area{{static_cast<std::int32_t>(shown.x), static_cast<std::int32_t>(shown.y)},
                      {shown.z - shown.x, shown.w - shown.y}};
  out.surfaces = graph.create(gpu::ImageDesc{.name = "translucent surfaces",
                                             .format = VK_FORMAT_R32_UINT,
                                             .extent = scene.size,
                                             .layers = kept.shares ? 2 * out.count + 1 : out.count,
                                             .array = true});
  for (std::uint32_t k = 0; k < out.count; ++k) {
    gpu::ImageRef& depth = out.depth[k];
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
          // Only depth says where the layer has a surface, and only in the area: a clear of both
          // images takes 0.3 ms of a GPU with few raster units at 1920x1080, and drawing the water
          // a hundredth of it.
          b.area(area);
          out.surfaces = b.color(out.surfaces, gpu::Load::discarded(), k);
          depth = b.depth(depth, gpu::Load::cleared({}));
        },
        [scene, draws, opaque_depth, previous, program](gpu::Commands& c) {
          DrawPush push = draw_push(scene, draws, 0);
          push.level_growth *= kAcrossShores;
          gpu::bind(c, program,
                    gpu::sampled<shared::kDepthsBinding>(opaque_depth, scene.point_sampler),
                    gpu::sampled<shared::kPreviousDepthsBinding>(previous, scene.point_sampler),
                    drawn_from(scene, draws), gpu::constants(push));
          draw_list(c, scene, draws, 0, DrawList::kTranslucent);
        });
  }
  out.tiles = classify_tiles(graph, pipelines, scene, "classify_translucent_tiles",
                             {.words = out.surfaces,
                              .depth = out.depth[0],
                              .area = shown,
                              .area_alone = !kept.inside_medium});
  return out;
}

namespace {

/// What shade_translucent.comp reads.
class LayerReads {
 public:
  LayerReads(const SceneRefs& scene, const TranslucentPass::In& in)
      : scene_(scene),
        layers_(in.layers),
        opaque_depth_(in.geometry.depth()),
        maps_(in.shadows.maps()),
        mirrors_(in.settings.water_mirror == WaterMirror::kWorld && scene.occupancy_grids),
        foam_(bool{scene.occupancy_grids}),
        walls_(scene, in.settings, foam_),
        clouds_(clouds_before_light(scene)),
        lights_(in.lights ? *in.lights : ClusteredLights::none(scene)),
        lit_(in.lights != nullptr) {}

  std::vector<gpu::SpecConstant> constants() const {
    std::vector<gpu::SpecConstant> own = clouds_.with_clouds(
        with_light({{shared::kWaterLayersConstant, layers_.count}}, scene_, bool{maps_}));
    if (layers_.mirrored_clouds) own.push_back({shared::kMirroredCloudsConstant, 1});
    if (layers_.shares) own.push_back({shared::kGlassConstant, 1});
    if (layers_.tail_depths) own.push_back({shared::kTailConstant, 1});
    if (mirrors_) own.push_back({shared::kMirrorWorldConstant, 1});
    if (foam_) own.push_back({shared::kFoamConstant, 1});
    return lit_ ? walls_.with_walls(lights_.with_panes(std::move(own))) : own;
  }
  void declare(gpu::PassBuilder& b) const {
    for (const gpu::BufferRef ref :
         {scene_.frame, scene_.islands, scene_.materials, scene_.indirect, scene_.island_skies})
      b.read(ref, Use::kComputeRead);
    clouds_.declare_light(b);
    if (layers_.mirrored_clouds) b.read(layers_.mirrored_clouds, Use::kComputeSampled);
    lights_.declare(b);
    walls_.declare(b);
    for (std::uint32_t k = 0; k < layers_.count; ++k)
      b.read(layers_.depth[k], Use::kComputeSampled);
    for (const gpu::ImageRef ref : {layers_.tail_depths, layers_.tail_light})
      if (ref) b.read(ref, Use::kComputeSampled);
    for (const gpu::ImageRef ref :
         {layers_.surfaces, opaque_depth_, scene_.sky_lut, scene_.block_textures})
      b.read(ref, Use::kComputeSampled);
    if (maps_) b.read(maps_, Use::kComputeSampled);
  }
  auto bindings() const {
    return std::tuple{
        gpu::storage<shared::kFrameBinding>(scene_.frame),
        gpu::texels<shared::kIslandsBinding>(scene_.islands),
        gpu::storage<shared::kMaterialsBinding>(scene_.materials),
        gpu::texels<shared::kIndirectBinding>(scene_.indirect),
        gpu::texels<shared::kIslandSkiesBinding>(scene_.island_skies),
        gpu::sampled<shared::kDepthsBinding>(opaque_depth_, scene_.point_sampler),
        gpu::sampled<shared::kSkyTableBinding>(scene_.sky_lut, scene_.sky_sampler),
        gpu::sampled<shared::kShadowMapsBinding>(maps_or_others(scene_, maps_),
                                                 scene_.point_sampler),
        gpu::sampled<shared::kBlockTexturesBinding>(scene_.block_textures, scene_.block_sampler),
        clouds_.light_bindings(),
        // Where none are known, something that is never read is bound in their place.
        gpu::sampled<shared::kMirroredCloudsBinding>(
            layers_.mirrored_clouds ? layers_.mirrored_clouds : scene_.sky_lut,
            scene_.point_sampler),
        layers_.bindings(scene_.point_sampler), lights_.bindings(), walls_.bindings()};
  }

 private:
  SceneRefs scene_;
  TranslucentPass::Layers layers_;
  gpu::ImageRef opaque_depth_, maps_;
  bool mirrors_, foam_;  // by voxels
  WallReads walls_;
  CloudRefs clouds_;
  ClusteredLights lights_;
  bool lit_;
};

struct ChangedTiles {
  Tiles tiles;
  std::vector<TileKind> kinds;
};

/// By which rays something is seen through level water: shared::kBentIntoWater ...
std::uint32_t bent_for(const TranslucentPass::In& in) {
  return in.inside_medium ? shared::kBentIntoAir : shared::kBentIntoWater;
}

/// What is seen through level water by the rays that it bends, in place on the radiance of `tiles`.
gpu::ImageRef bend_rays(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                        const TranslucentPass::In& in, const Tiles& tiles, gpu::ImageRef radiance) {
  gpu::ImageRef bent = graph.create(gpu::ImageDesc{
      .name = "bent light", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = scene.size});
  const TranslucentPass::Layers& layers = in.layers;
  const gpu::ImageRef depths = in.geometry.depth(), first = layers.depth[0],
                      second = layers.depth[layers.count > 1 ? 1 : 0];
  graph.add_pass(
      "bend_rays",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, tiles);
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        for (const gpu::ImageRef ref : {layers.surfaces, depths, first, second})
          b.read(ref, Use::kComputeSampled);
        b.read(radiance, Use::kComputeRead);
        bent = b.write(bent, Use::kComputeWrite);
      },
      [scene, words = layers.surfaces, depths, first, second, tiles, radiance, bent,
       program = gpu::compute(pipelines, programs::kBendRays,
                              {{shared::kWaterLayersConstant, layers.count},
                               {shared::kBentConstant, bent_for(in)}})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::texels<shared::kIslandsBinding>(scene.islands),
                  gpu::storage<shared::kMaterialsBinding>(scene.materials),
                  gpu::sampled<shared::kDepthsBinding>(depths, scene.point_sampler),
                  gpu::sampled<shared::kLayerSurfacesBinding>(words, scene.point_sampler),
                  gpu::sampled<shared::kLayerDepthsBinding>(first, scene.point_sampler),
                  gpu::sampled<shared::kLayerDepthsBinding + 1u>(second, scene.point_sampler),
                  gpu::storage<shared::kRadianceBinding>(radiance),
                  gpu::storage<shared::kBentLightBinding>(bent),
                  tiles.bindings(TileKind::kCovered));
        dispatch_tiles(c, tiles, TileKind::kCovered);
      });
  graph.add_pass(
      "put_bent_rays",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, tiles);
        b.read(scene.frame, Use::kComputeRead);
        b.read(first, Use::kComputeSampled);
        b.read(bent, Use::kComputeRead);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [scene, first, tiles, radiance, bent,
       program = gpu::compute(pipelines, programs::kPutBentRays)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::sampled<shared::kLayerDepthsBinding>(first, scene.point_sampler),
                  gpu::storage<shared::kRadianceBinding>(radiance),
                  gpu::storage<shared::kBentLightBinding>(bent),
                  tiles.bindings(TileKind::kCovered));
        dispatch_tiles(c, tiles, TileKind::kCovered);
      });
  return radiance;
}

/// What is made of radiance as it is shaded.
struct Made {
  gpu::ImageRef picture, metered;
  std::uint32_t meter_stride;
};

/// The same where radiance is another now.
Made refresh_picture(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const ChangedTiles& changed, gpu::ImageRef radiance, Made made) {
  std::vector<gpu::SpecConstant> constants;
  if (made.metered) constants.push_back({shared::kMeterStrideConstant, made.meter_stride});
  graph.add_pass(
      "refresh_picture",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, changed.tiles);
        for (const gpu::BufferRef ref : {scene.frame, scene.exposure})
          b.read(ref, Use::kComputeRead);
        b.read(radiance, Use::kComputeRead);
        for (gpu::ImageRef* const image : {&made.picture, &made.metered})
          if (*image) *image = b.write(*image, Use::kComputeWrite);
      },
      [frame = scene.frame, exposure = scene.exposure, changed, radiance, made,
       program = gpu::compute(pipelines, programs::kRefreshPicture,
                              with_picture(std::move(constants), scene))](gpu::Commands& c) {
        for (const TileKind kind : changed.kinds) {
          gpu::bind(
              c, program, gpu::storage<shared::kFrameBinding>(frame),
              gpu::storage<shared::kRadianceBinding>(radiance),
              gpu::storage<shared::kTargetBinding>(made.picture),
              gpu::storage<shared::kMeteredBinding>(made.metered ? made.metered : made.picture),
              gpu::storage<shared::kExposureBinding>(exposure), changed.tiles.bindings(kind));
          dispatch_tiles(c, changed.tiles, kind);
        }
      });
  return made;
}

}  // namespace

Shaded TranslucentPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                            const In& in, Shaded shaded) {
  // Inside a medium every pixel is looked at through it; else only those with a translucent
  // surface.
  const Tiles& tiles = in.layers.tiles;
  shaded.radiance_ = bend_rays(graph, pipelines, scene, in, tiles, shaded.radiance());
  const LayerReads reads(scene, in);
  std::vector<gpu::SpecConstant> constants = reads.constants();
  constants.push_back({shared::kBentConstant, bent_for(in)});
  if (!scene.count_pixels) constants.push_back({shared::kCountPixelsConstant, 0});
  if (shaded.picture()) constants.push_back({shared::kToPictureConstant, 1});
  std::vector<TileKind> kinds{TileKind::kCovered};
  if (in.inside_medium) kinds.push_back(TileKind::kOpen);
  graph.add_pass(
      "shade_translucent",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, tiles);
        reads.declare(b);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        shaded.radiance_ = b.write(shaded.radiance_, Use::kComputeWrite);
      },
      [reads, tiles, radiance = shaded.radiance(), stats = scene.pixel_stats, kinds,
       program = gpu::compute(pipelines, programs::kShadeTranslucent, std::move(constants))](
          gpu::Commands& c) {
        for (const TileKind kind : kinds) {
          gpu::bind(c, program, reads.bindings(), gpu::storage<shared::kPixelStatsBinding>(stats),
                    gpu::storage<shared::kRadianceBinding>(radiance), tiles.bindings(kind));
          dispatch_tiles(c, tiles, kind);
        }
      });
  if (shaded.picture()) {
    const Made made = refresh_picture(
        graph, pipelines, scene, {tiles, kinds}, shaded.radiance(),
        {shaded.picture(), shaded.metered(), static_cast<std::uint32_t>(in.settings.meter.stride)});
    shaded.picture_ = made.picture;
    shaded.metered_ = made.metered;
  }
  return shaded;
}

}  // namespace skerry::render
