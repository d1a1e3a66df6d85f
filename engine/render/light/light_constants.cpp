#include "engine/render/light/light_constants.h"

namespace skerry::render {

std::vector<gpu::SpecConstant> with_light(std::vector<gpu::SpecConstant> own,
                                          const SceneRefs& scene, bool shadows) {
  own.push_back({8, scene.bodies});
  if (!scene.haze && scene.bodies != 0) own.push_back({11, 0});
  if (shadows) {
    own.push_back({9, scene.shadow_taps});
    own.push_back({10, scene.shadow_cascades});
    if (scene.samples_per_edge > 1) own.push_back({14, scene.samples_per_edge});
    if (!scene.penumbrae) own.push_back({13, 0});
  }
  return own;
}

std::optional<CloudRefs> clouds_before_light(const SceneRefs& scene) {
  return scene.bodies != 0 ? scene.clouds : std::nullopt;
}

std::vector<gpu::SpecConstant> with_clouds(std::vector<gpu::SpecConstant> own,
                                           const std::optional<CloudRefs>& clouds) {
  return clouds ? clouds->with_clouds(std::move(own)) : own;
}

}  // namespace skerry::render
