#include "engine/render/light/wall_reads.h"

#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

WallReads::WallReads(const SceneRefs& scene, const RenderSettings& settings, bool looks_up)
    : traced_(settings.lights_shadows != 0 && scene.light_islands),
      lights_(settings.lights_shadows),
      samples_(static_cast<std::uint32_t>(settings.lights_softness)),
      occupancy_(scene, looks_up || traced_),
      islands_(traced_ ? scene.light_islands : scene.materials) {}

std::vector<gpu::SpecConstant> WallReads::with_walls(std::vector<gpu::SpecConstant> own) const {
  if (!traced_) return own;
  own.push_back({shared::kLightsShadowsConstant, lights_});
  own.push_back({shared::kLightsSoftnessConstant, samples_});
  return own;
}

void WallReads::declare(gpu::PassBuilder& builder) const {
  occupancy_.declare(builder);
  builder.read(islands_, gpu::Use::kComputeRead);
}

}  // namespace skerry::render
