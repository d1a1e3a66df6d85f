#include "engine/render/light/light_constants.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

std::vector<gpu::SpecConstant> with_light(std::vector<gpu::SpecConstant> own,
                                          const SceneRefs& scene, bool shadows) {
  own.push_back({shared::kBodiesConstant, scene.bodies});
  const bool indirect = scene.indirect_light != Indirect::kOff;
  if (indirect)
    own.push_back({shared::kIndirectConstant, static_cast<std::uint32_t>(scene.indirect_light)});
  if (!scene.haze && (scene.bodies != 0 || indirect)) own.push_back({shared::kHazeConstant, 0});
  if (scene.panorama) own.push_back({shared::kPanoramaConstant, 1});
  if (shadows) {
    own.push_back({shared::kShadowsConstant, 1});
    own.push_back({shared::kShadowTapsConstant, scene.shadow_taps});
    own.push_back({shared::kCascadesConstant, scene.shadow_cascades});
    if (scene.samples_per_edge > 1)
      own.push_back({shared::kSamplesPerEdgeConstant, scene.samples_per_edge});
    if (!scene.shadow_blur) own.push_back({shared::kShadowBlurConstant, 0});
  }
  return own;
}

gpu::ImageRef maps_or_others(const SceneRefs& scene, gpu::ImageRef maps) {
  return maps ? maps : scene.block_textures;
}

CloudRefs clouds_before_light(const SceneRefs& scene) {
  if (scene.clouds && scene.bodies != 0) return *scene.clouds;
  CloudRefs none;
  none.constants = scene.frame;
  none.layer_light = none.volume_light = scene.no_volume;
  none.linear = scene.point_sampler;
  return none;
}

}  // namespace skerry::render
