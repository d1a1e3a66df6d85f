#include "engine/render/light/wall_reads.h"

#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

WallReads::WallReads(const SceneRefs& scene, const RenderSettings& settings, bool corners)
    : traced_(settings.traced_lights != 0 && scene.light_islands),
      lights_(settings.traced_lights),
      samples_(static_cast<std::uint32_t>(settings.light_samples)),
      occupancy_(scene, corners || traced_),
      islands_(traced_ ? scene.light_islands : scene.materials) {}

std::vector<gpu::SpecConstant> WallReads::with_walls(std::vector<gpu::SpecConstant> own) const {
  if (!traced_) return own;
  own.push_back({shared::kTracedLightsConstant, lights_});
  own.push_back({shared::kLightSamplesConstant, samples_});
  return own;
}

void WallReads::declare(gpu::PassBuilder& builder) const {
  occupancy_.declare(builder);
  builder.read(islands_, gpu::Use::kComputeRead);
}

}  // namespace skerry::render
