#pragma once
#include <cstdint>
#include <utility>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/settings.h"

namespace skerry::render {

// A frame's phases as types: geometry -> shaded -> developed. Each can only be had from the pass
// that makes it, is handed on by move, and is used up by the next phase. Sampling what was not
// written, or running a phase twice or out of order, does not compile.

/// The G-buffer is complete: what surface is at each pixel, and how far.
class Geometry {
 public:
  Geometry(Geometry&&) = default;
  Geometry& operator=(Geometry&&) = default;
  gpu::ImageRef surfaces() const {
    return surfaces_;
  }  ///< R32_UINT, pack_surface() of shaders/include/frame/common.glsl; read through
     ///< shaders/include/scene/coverage.glsl
  gpu::ImageRef depth() const { return depth_; }          ///< reverse-Z
  gpu::ImageRef normals() const { return normals_; }      ///< empty when they are not kept
  gpu::ImageRef positions() const { return positions_; }  ///< likewise
  const GBufferStore& store() const { return store_; }    ///< how each is kept
  bool stored() const { return normals_ || positions_; }

 private:
  friend struct GeometryPass;
  Geometry() = default;
  gpu::ImageRef surfaces_, depth_, normals_, positions_;
  GBufferStore store_;
};

/// Shadow maps of every body that casts are drawn; or there are none.
class Shadows {
 public:
  Shadows(Shadows&&) = default;
  Shadows& operator=(Shadows&&) = default;
  gpu::ImageRef maps() const { return maps_; }  ///< D32 array; empty when nothing casts

 private:
  friend struct ShadowPass;
  explicit Shadows(gpu::ImageRef maps) : maps_(maps) {}
  gpu::ImageRef maps_;
};

/// Which pixels' radiance is kept as an image: none's, and all go to the picture at once; that of
/// the part of the picture which water or glass may show or mirror, beside the picture; or all
/// pixels', and the develop pass makes the picture.
enum class ByRadiance : std::uint8_t { kNothing, kLayers, kEverything };

/// Every pixel has its light: scene radiance, linear, finite; or it is in the picture already.
class Shaded {
 public:
  Shaded(Shaded&&) = default;
  Shaded& operator=(Shaded&&) = default;
  gpu::ImageRef radiance() const { return radiance_; }  ///< RGBA16F; empty: none is kept
  gpu::ImageRef picture() const { return picture_; }    ///< all pixels are in it; empty: none is
  gpu::ImageRef metered() const { return metered_; }    ///< see ShadeTarget

 private:
  friend struct ShadePass;
  friend struct TranslucentPass;
  friend struct CloudPass;
  friend struct FaultPass;
  friend struct ResolvePass;
  explicit Shaded(gpu::ImageRef radiance) : radiance_(radiance) {}
  gpu::ImageRef radiance_, picture_, metered_;
};

/// The picture as it is shown: RGBA8, sRGB-encoded.
class Developed {
 public:
  Developed(Developed&&) = default;
  Developed& operator=(Developed&&) = default;
  gpu::ImageRef picture() const { return picture_; }

 private:
  friend struct DevelopPass;
  friend struct MeterPass;
  friend struct MarkerPass;
  friend struct EnlargePass;
  friend struct EdgePass;
  friend struct TemporalPass;
  explicit Developed(gpu::ImageRef picture) : picture_(picture) {}
  gpu::ImageRef picture_;
};

}  // namespace skerry::render
