#pragma once
#include <cstdint>

namespace skerry::render {

/// What the picture shows instead of the lit scene.
enum class DebugView : std::uint8_t {
  kNone,
  kAlbedo,
  kNormal,
  kPosition,
  kMetadata,
  kEmissive,
  kDepth,
  kCascades,
  kShadow
};

/// Knobs of the picture. Defaults are the medium quality level's.
struct RenderSettings {
  double view_distance_blocks =
      1000.0;  ///< all that is drawn lies within; the last cascade reaches as far
  bool shadows = true;
  int shadow_map_size = 2048;  ///< texels along an edge of each cascade, 64..16384
  int shadow_cascades = 4;     ///< maps a light has, 1..4; however few reach as far
  int shadow_taps = 8;         ///< of the shadow filter: 1, 4, 8, 16 or 32
  float shadow_filter_blocks =
      0.06f;                   ///< smallest radius of the shadow filter; never under 1.5 texels
  bool flat_shading = false;   ///< shadow result times light colour, no N.L
  int texture_taps = 2;        ///< samples along the long side of a texture footprint, 1..16
  int translucent_layers = 3;  ///< nearest surfaces of water and glass kept a pixel, 1..4
  DebugView debug_view = DebugView::kNone;
};

}  // namespace skerry::render
