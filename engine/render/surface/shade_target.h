#pragma once
#include <tuple>
#include <utility>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

/// Tiles of a kind, and whether their program keeps radiance.
struct OutputTiles {
  TileKind kind;
  bool keep;
};

/// What shading passes write to, as shaders/include/post/output.glsl has it.
struct ShadeTarget {
  gpu::ImageRef radiance;  ///< RGBA16F; empty: no pixel's is kept
  gpu::ImageRef picture;   ///< RGBA8, of all pixels; empty: none. If both, radiance is that of
                           ///< FrameConstants::radiance_area
  gpu::ImageRef metered;   ///< R32F, luminance for the meter, a texel for each meter_stride x
                           ///< meter_stride pixels; empty: none is kept
  std::uint32_t meter_stride = 0;  ///< 0 without `metered`
  gpu::BufferRef layer_tiles;      ///< dispatches of the tiles that show water or glass: without
                                   ///< any no radiance is kept. Empty: it is not looked at

  void declare(gpu::PassBuilder& b, const SceneRefs& scene);
  /// The lists of tiles that stand for all of a kind that has a kept one, as the frame's
  /// tiles are sorted by `layer_tiles`; each asks for a program of its own.
  std::vector<OutputTiles> tiles_of(TileKind kind) const;
  /// A shader's own specialization constants and those of output.glsl. @param keep false: no
  /// radiance, where it is beside the picture.
  std::vector<gpu::SpecConstant> with_output(std::vector<gpu::SpecConstant> own,
                                             const SceneRefs& scene, bool keep = true) const;
  auto bindings(const SceneRefs& scene) const {
    const gpu::ImageRef some = radiance ? radiance : picture;
    return std::tuple{
        gpu::storage<shared::kRadianceBinding>(some),
        gpu::storage<shared::kTargetBinding>(picture ? picture : some),
        gpu::storage<shared::kMeteredBinding>(metered ? metered : some),
        gpu::storage<shared::kExposureBinding>(picture ? scene.exposure : scene.frame)};
  }
};

/// A program for each list of tiles of a kind. @param make from whether it keeps radiance.
template <typename Make>
auto programs_of(const ShadeTarget& into, TileKind kind, const Make& make) {
  std::vector<std::pair<TileKind, decltype(make(true))>> out;
  for (const OutputTiles& some : into.tiles_of(kind))
    out.push_back(std::pair(some.kind, make(some.keep)));
  return out;
}

}  // namespace skerry::render
