#include "engine/render/surface/picture_constants.h"

namespace skerry::render {

std::vector<gpu::SpecConstant> with_picture(std::vector<gpu::SpecConstant> own,
                                            const SceneRefs& scene) {
  own.push_back({30, static_cast<std::uint32_t>(scene.tone)});
  own.push_back({31, scene.calibrated ? 1u : 0u});
  return own;
}

}  // namespace skerry::render
