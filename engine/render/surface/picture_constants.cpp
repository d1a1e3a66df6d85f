#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

std::vector<gpu::SpecConstant> with_picture(std::vector<gpu::SpecConstant> own,
                                            const SceneRefs& scene) {
  own.push_back({shared::kToneConstant, static_cast<std::uint32_t>(scene.tone)});
  own.push_back({shared::kCalibratedConstant, scene.calibrated ? 1u : 0u});
  if (!scene.count_pixels) own.push_back({shared::kCountPixelsConstant, 0});
  return own;
}

}  // namespace skerry::render
