#pragma once
#include <cstdint>

#include "engine/render/frame/features.h"

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
  kShadow,
  kAo,
  kClusters,
  kLightCount,
  kExposure  ///< the lit scene, and the meter's histogram over it
};

/// How the G-buffer keeps a surface's normal. Not at all is exact: the normal then comes from the
/// face and its island. The others are for measuring what storing it would cost and lose.
enum class NormalStore : std::uint8_t { kExact, kOct8, kOct16, kRgb8, kRgb10a2, kRgba16f };
/// Where a surface's position comes from: its depth, or an image of positions relative to the
/// camera.
enum class PositionStore : std::uint8_t { kDepth, kRgba16f, kRgba32f };
enum class DepthStore : std::uint8_t { kD32, kD16 };

/// What the G-buffer holds besides the word of each surface.
struct GBufferStore {
  NormalStore normal = NormalStore::kExact;
  PositionStore position = PositionStore::kDepth;
  DepthStore depth = DepthStore::kD32;
  bool operator==(const GBufferStore&) const = default;
};

/// How edges of surfaces are smoothed where a pixel has one sample. docs/decisions/0043.
enum class Antialiasing : std::uint8_t {
  kOff,
  kEdge,     ///< by the share of a pixel that each side of an edge covers
  kTemporal  ///< the same, mixed with what earlier frames showed there. docs/decisions/0088
};

/// From exposed radiance to what a display can show.
enum class ToneCurve : std::uint8_t { kAces, kAgx };

/// What the display in use can show. docs/exposure.md.
struct DisplaySettings {
  float peak = 1.0f;   ///< brightest value of the picture, of the display's white, linear, 0.1..1
  float black = 0.0f;  ///< darkest sRGB value that is seen apart from black, 0..0.2
  bool operator==(const DisplaySettings&) const = default;
};

/// How the camera meters a frame that is given no exposure. docs/exposure.md.
struct MeterSettings {
  float key = 0.35f;     ///< exposed luminance of a landscape under the noon sun, 0.01..1
  float min_ev = -8.0f;  ///< stops; metered exposures stay within
  float max_ev = 4.0f;
  int stride = 4;  ///< one pixel of each stride x stride is looked at, 1..16
  bool operator==(const MeterSettings&) const = default;
};

/// Glow of what is too bright. docs/exposure.md.
struct BloomSettings {
  float intensity = 0.0f;  ///< of the light over the threshold, what is added; 0: no bloom at all
  float threshold = 1.5f;  ///< exposed brightness, 0..100
  int levels = 6;          ///< of the pyramid, 1..8; each doubles the reach
  bool operator==(const BloomSettings&) const = default;
};

/// Clouds, of the layer and of files. docs/clouds.md.
struct CloudSettings {
  float coverage = 0.0f;       ///< of the layer: share of the sky, 0..1; 0: there is no layer
  double altitude = 360.0;     ///< of the layer's base [blocks]
  float thickness = 240.0f;    ///< of the layer [blocks], > 0
  float density = 0.12f;       ///< extinction in the middle of the layer's clouds [1/block]
  float file_density = 0.1f;   ///< extinction of density 1 in a file [1/block]
  float file_emission = 0.2f;  ///< radiance a block that a file's hottest place sends out
  int steps = 24;              ///< of the eye's way through the layer or a file's box, 8..1024
  int shadow_steps = 32;       ///< of the light's way, 4..128
  int resolution = 2;          ///< 1: a ray for every pixel; 2: for every second one each way
  int precision = 8;           ///< bits of a density in a file's bricks: 8, 16 or 32
  bool operator==(const CloudSettings&) const = default;
};

/// Light that does not come straight from sun, moon or a lamp. docs/lights.md.
enum class Indirect : std::uint8_t {
  kOff,  ///< none
  kSky,  ///< of the sky, as far as each face sees it
  kFull  ///< also of weak lamps, which then are no lights of the frame
};

/// From a surface and its lights to radiance. kFlat: shadow result times light colour, without the
/// angle to the light and without corners.
enum class Shading : std::uint8_t { kPbr, kFlat };

/// Whether quads that others hide are looked for, by holding sections against the depths of what
/// the last frame showed. The picture is the same. kAuto: where many quads are in view.
enum class Occlusion : std::uint8_t { kOff, kAuto, kAlways };

/// What water and glass mirror besides lights. docs/decisions/0059.
enum class WaterMirror : std::uint8_t {
  kSky,   ///< the sky, as far as the surface sees it; else what is about it, evenly
  kWorld  ///< what a ray through the voxels of the surface's island meets
};

inline constexpr std::uint32_t kEveryLight = ~0u;  ///< of RenderSettings::lights_shadows

/// Knobs of the picture, named as the keys of docs/settings.md. Defaults are those of quality
/// medium.
struct RenderSettings {
  Occlusion occlusion = Occlusion::kAuto;
  Antialiasing aa = Antialiasing::kOff;
  int aa_samples = 1;  ///< of a pixel, drawn and averaged: 1, 4 or 16
  /// Of the edges of the picture that is shown, 0.25..1: below 1 the scene is drawn smaller, and
  /// the picture is enlarged.
  float render_scale = 1.0f;
  bool shadow_enabled = true;
  int shadow_size = 2048;      ///< texels along an edge of each cascade, 64..16384
  int shadow_cascades = 4;     ///< maps a light has, 1..4; however few reach as far
  double shadow_split = 0.98;  ///< 0 evenly spaced cascades .. 1 each a multiple of the last
  int shadow_taps = 8;         ///< of the shadow filter: 1, 4, 8, 16 or 32
  /// Largest radius of the shadow filter [blocks]. The filter is as wide as the edge that the sun's
  /// disc casts, and a texel at least. 0: a texel everywhere.
  float shadow_blur = 0.15f;
  Shading shading = Shading::kPbr;
  float ao_strength = 0.5f;  ///< share of light that a closed corner takes, 0..1; 0: no corners
  Indirect indirect = Indirect::kFull;
  /// Pixels along a square that takes its light from its corners where they are lit alike, 1 to 4.
  int shading_rate = 1;
  float shading_tolerance = 0.3f;  ///< how much light may differ between them, of the brightest
  int texture_taps = 2;            ///< samples along the long side of a texture footprint, 1..16
  int water_layers = 2;            ///< nearest surfaces of water and glass kept a pixel, 1..4
  WaterMirror water_mirror = WaterMirror::kWorld;
  GBufferStore gbuffer;
  MeterSettings meter;
  BloomSettings bloom;
  ToneCurve tone = ToneCurve::kAces;
  DisplaySettings display;
  CloudSettings clouds;
  /// For how many lights of a pixel walls are looked for: none, kEveryLight, or those that send the
  /// most light to the eye, 1..8; the others are dimmed by the same share.
  std::uint32_t lights_shadows = 4;
  std::uint32_t lights_tile = 16;  ///< pixels along a light cluster's tile: 8, 16, 32 or 64
  int lights_softness = 1;         ///< ways to a light that has a size, 1..16
  bool lights_oracle = false;      ///< every pixel asks every light: slow, to hold clusters against
  FeatureSet leave_out;            ///< absent even where the scene has them
  DebugView debug_view = DebugView::kNone;
  bool operator==(const RenderSettings&) const = default;
};

}  // namespace skerry::render
