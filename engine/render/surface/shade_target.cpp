#include "engine/render/surface/shade_target.h"

#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

void ShadeTarget::declare(gpu::PassBuilder& b, const SceneRefs& scene) {
  for (gpu::ImageRef* const image : {&radiance, &picture, &metered})
    if (*image) *image = b.write(*image, Use::kComputeWrite);
  if (picture) b.read(scene.exposure, Use::kComputeRead);
}

std::vector<OutputTiles> ShadeTarget::tiles_of(TileKind kind) const {
  const bool keep{radiance};
  if (!layer_tiles) return {{kind, keep}};
  const TileKind kept = kind == TileKind::kCovered ? TileKind::kKeptCovered
                        : kind == TileKind::kOpen  ? TileKind::kKeptOpen
                                                   : TileKind::kKeptDetailed;
  return {{kind, false}, {kept, true}};
}

std::vector<gpu::SpecConstant> ShadeTarget::with_output(std::vector<gpu::SpecConstant> own,
                                                        const SceneRefs& scene, bool keep) const {
  if (!picture) {
    if (!scene.count_pixels) own.push_back({shared::kCountPixelsConstant, 0});
    return own;
  }
  own.push_back({shared::kToPictureConstant, 1});
  own.push_back({shared::kToRadianceConstant, radiance && keep ? 1u : 0u});
  if (metered) own.push_back({shared::kMeterStrideConstant, meter_stride});
  return with_picture(std::move(own), scene);
}

}  // namespace skerry::render
