#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/frame/settings.h"

namespace skerry::game {

inline constexpr std::uint32_t kMinViewDistance = 32, kMaxViewDistance = 16384;  ///< blocks

inline constexpr double kMinDisplayPeak = 0.1, kMaxDisplayBlack = 0.2;

enum class Quality : std::uint8_t { kLow, kMedium, kHigh, kUltra };
enum class Shading : std::uint8_t { kPbr, kFlat };
/// How the picture is made. kReference: on the CPU, exactly and slowly; screenshots only.
enum class RendererKind : std::uint8_t { kDeferred, kAuto, kReference };
/// kPixel: everything averaged over the pixel. kCentre: geometry through the pixel's centre alone,
/// as the GPU samples it, light and textures still averaged.
enum class ReferenceFilter : std::uint8_t { kPixel, kCentre };
using render::DebugView;
enum class UploadMode : std::uint8_t { kUpdate, kStaging, kMapped };

/// Everything `--set` reaches, with the defaults of quality `medium`. docs/settings.md says what
/// each means to a player.
struct Settings {
  std::array<std::int64_t, 3> world_offset{};  ///< whole blocks, +-2^40: moves every island
  std::optional<std::uint32_t>
      world_islands;          ///< only so many islands, nearest to the spawn first; none: all
  double world_time_s = 0.0;  ///< seconds of island motion, +-1e9
  double moon_phase = 0.5;    ///< 0 new, 0.5 full, 1 new again
  std::uint32_t view_distance = 1000;  ///< blocks, 32 .. 16384
  std::uint32_t view_detail = 192;     ///< blocks drawn at full detail, 32 .. 4096
  std::uint32_t aa_samples = 1;        ///< a pixel, drawn and averaged: 1, 4 or 16
  double render_scale = 1.0;  ///< of the picture's edges, 0.25 .. 1: drawn smaller, then enlarged
  bool shadow_enabled = true;
  std::uint32_t shadow_size = 2048;   ///< texels along a cascade's edge, power of two, 256 .. 8192
  std::uint32_t shadow_cascades = 4;  ///< maps a light has, 1 .. 4
  std::uint32_t shadow_taps = 8;      ///< of the shadow filter: 1, 4, 8, 16 or 32
  std::uint32_t shadow_samples = 1;   ///< places on the discs of sun and moon, 1 .. 1024
  double shadow_split = 0.98;         ///< 0 evenly spaced maps .. 1 each a multiple of the last
  double shadow_blur = 0.15;          ///< largest radius of the shadow filter [blocks], 0 .. 1
  std::uint32_t texture_taps = 2;     ///< along the long side of a texture footprint, 1 .. 16
  render::GBufferStore gbuffer;       ///< for measuring
  std::uint32_t lights_random = 0;    ///< torches scattered over what the first camera sees
  bool lights_held = false;           ///< a torch in the hand
  double ao_strength = 0.5;           ///< share of light that a closed corner takes, 0 .. 0.9
  render::Indirect indirect = render::Indirect::kFull;
  std::optional<double> exposure_ev;  ///< stops, -20 .. 20; none: metered
  render::MeterSettings meter;        ///< of what has no exposure of its own
  render::ToneCurve tone = render::ToneCurve::kAces;
  render::DisplaySettings display;
  render::BloomSettings bloom;
  render::CloudSettings clouds;
  RendererKind renderer = RendererKind::kAuto;
  Shading shading = Shading::kPbr;
  std::uint32_t shading_rate = 1;  ///< pixels along a block that is lit once: 1, 2 or 4
  double shading_tolerance = 0.1;  ///< light that may differ within such a block, 0 .. 1
  DebugView debug_view = DebugView::kNone;
  UploadMode upload_path = UploadMode::kUpdate;
  std::uint64_t upload_budget_bytes = 8u << 20;    ///< a frame, 65536 .. 2^30
  std::optional<std::uint32_t> memory_budget_mib;  ///< for the world, 8 .. 2^20; none: by device
  std::uint32_t jobs_threads = 0;                  ///< 0: one a core; .. 256
  /// Lights of a pixel that walls are looked for before: 0 none, 1 .. 8, or render::kEveryLight.
  std::uint32_t lights_shadows = 4;
  std::uint32_t lights_tile = 16;        ///< pixels along a light cluster's tile: 8, 16, 32, 64
  std::uint32_t lights_softness = 1;     ///< ways to a light that has a size, 1 .. 16
  bool lights_oracle = false;            ///< every pixel asks every light
  render::FeatureSet leave_out;          ///< drawn of no scene
  std::uint32_t water_layers = 2;        ///< nearest translucent surfaces kept a pixel, 1 .. 4
  std::uint32_t reference_samples = 64;  ///< a pixel, 1 .. 65536
  ReferenceFilter reference_filter = ReferenceFilter::kPixel;
  bool operator==(const Settings&) const = default;
};

/// One key of `--set`.
struct SettingKey {
  std::string_view key;
  std::string_view values;  ///< what is accepted, for help and docs
  std::string_view meaning;
  Result<void> (*parse)(std::string_view value, Settings& into);
  std::string (*print)(const Settings& from);  ///< text that parse reads back as the same value
};

/// All keys, in the order of the documentation.
std::span<const SettingKey> setting_keys();

/// Sets one key. Errors name the accepted values, and the nearest key or value to what was typed.
Result<void> apply_setting(std::string_view key, std::string_view value, Settings& settings);
/// Same from "key=value".
Result<void> apply_setting(std::string_view assignment, Settings& settings);

/// What a quality level stands for; everything else is as in Settings' defaults.
struct QualityLevel {
  std::string_view name;
  std::uint32_t view_distance, view_detail, shadow_size;
  float bloom_intensity;
  std::uint32_t lights_shadows;
  int cloud_steps, cloud_resolution;
  double render_scale;
};
const QualityLevel& quality_level(Quality quality);
Result<Quality> parse_quality(std::string_view text);
Settings settings_of(Quality quality);
/// Changes what a level stands for, and nothing else.
void set_quality(Quality quality, Settings& settings);

/// The "key=value" assignments that turn settings_of(quality) into `settings`.
std::vector<std::string> assignments_from(Quality quality, const Settings& settings);

}  // namespace skerry::game
