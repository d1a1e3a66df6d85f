#include "engine/render/surface/shade_target.h"

#include "engine/core/check.h"
#include "engine/render/surface/picture_constants.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

namespace {

TileKind kept(TileKind kind) {
  switch (kind) {
    case TileKind::kCovered:
      return TileKind::kKeptCovered;
    case TileKind::kOpen:
      return TileKind::kKeptOpen;
    case TileKind::kLampLit:
      return TileKind::kKeptLampLit;
    case TileKind::kSmoothSky:
      return TileKind::kKeptSmoothSky;
    case TileKind::kPlainSquares:
      return TileKind::kKeptPlainSquares;
    case TileKind::kMixedSquares:
      return TileKind::kKeptMixedSquares;
    default:
      SKERRY_ASSERT(kind == TileKind::kDetailed);
      return TileKind::kKeptDetailed;
  }
}

}  // namespace

void ShadeTarget::declare(gpu::PassBuilder& b, const SceneRefs& scene) {
  for (gpu::ImageRef* const image : {&radiance, &picture, &metered})
    if (*image) *image = b.write(*image, Use::kComputeWrite);
  if (picture) b.read(scene.exposure, Use::kComputeRead);
}

std::vector<OutputTiles> ShadeTarget::tiles_of(TileKind kind) const {
  const bool keep{radiance};
  if (!layer_tiles) return {{kind, keep}};
  return {{kind, false}, {kept(kind), true}};
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
