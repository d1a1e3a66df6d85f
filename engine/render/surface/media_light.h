#pragma once
#include <tuple>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/scene/tiles.h"
#include "engine/render/surface/shade_target.h"
#include "engine/render/surface/translucent_pass.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

/// What water and glass do to the light that comes to what pixels show, for shaders that ask
/// shaders/include/surface/depth_of_pixel.glsl.
class MediaLight {
 public:
  /// None does anything.
  MediaLight() = default;
  struct In {
    const Geometry& geometry;
    const TranslucentPass::Layers& layers;  ///< before the surfaces; without any, none of water
    gpu::ImageRef glass;                    ///< maps of GlassPass; empty: glass takes no light
    gpu::ImageRef shadow_maps;              ///< that those belong to
  };
  /// @param tiles of which those of the kinds `covered` may be asked for.
  static MediaLight add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                        const In& in, const Tiles& tiles, const std::vector<TileKind>& covered);

  /// Whether something may be under water.
  bool has_water() const { return water_; }
  /// @param in_water false: of a program for places that are not under water.
  std::vector<gpu::SpecConstant> with_media(std::vector<gpu::SpecConstant> own,
                                            bool in_water = true) const {
    if (water_ && in_water) own.push_back({shared::kUnderWaterConstant, 1});
    if (glass_) own.push_back({shared::kGlassConstant, 1});
    return own;
  }
  void declare(gpu::PassBuilder& builder, const SceneRefs& scene) const {
    builder.read(image(scene), gpu::Use::kComputeSampled);
    builder.read(first_layer(scene), gpu::Use::kComputeSampled);
  }
  auto bindings(const SceneRefs& scene) const {
    return std::tuple{
        gpu::sampled<shared::kMediaLightBinding>(image(scene), scene.point_sampler),
        gpu::sampled<shared::kLayerDepthsBinding>(first_layer(scene), scene.point_sampler)};
  }

 private:
  /// Something else in place of what is then never read.
  gpu::ImageRef image(const SceneRefs& scene) const { return image_ ? image_ : scene.no_depths; }

  gpu::ImageRef first_layer(const SceneRefs& scene) const {
    return first_layer_ ? first_layer_ : scene.sky_lut;
  }

  gpu::ImageRef first_layer_;  // depths
  gpu::ImageRef image_;        // RG32_UINT, see shaders/surface/find_media_light.comp
  bool water_ = false, glass_ = false;
};

}  // namespace skerry::render
