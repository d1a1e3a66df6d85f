#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/core/result.h"
#include "engine/render/frame/settings.h"
#include "engine/render/sky/panorama_sky.h"
#include "game/words/language.h"

namespace skerry::game {

inline constexpr std::uint32_t kMinViewDistance = 32, kMaxViewDistance = 16384;  ///< blocks

inline constexpr double kMinDisplayPeak = 0.1, kMaxDisplayBlack = 0.2;

enum class Quality : std::uint8_t { kLow, kMedium, kHigh, kUltra };
/// How the picture is made. kReference: on the CPU, exactly and slowly; screenshots only.
enum class RendererKind : std::uint8_t { kDeferred, kAuto, kReference };
/// kPixel: everything averaged over the pixel. kCentre: geometry through the pixel's centre alone,
/// as the GPU samples it, light and textures still averaged.
enum class ReferenceFilter : std::uint8_t { kPixel, kCentre };
/// Whether frames wait for the display: gpu::Sync.
enum class VerticalSync : std::uint8_t { kOff, kOn, kAdaptive };
enum class UploadMode : std::uint8_t { kUpdate, kStaging, kMapped };

/// How often play draws, and when. Rates are frames a second.
struct FrameSettings {
  static constexpr std::uint32_t kLeastRate = 5, kMostRate = 1000;
  static constexpr std::uint32_t kNoCap = 0, kDisplayCap = 1;
  std::optional<std::uint32_t> wanted;  ///< what quality auto aims at; none: by device and display
  std::uint32_t cap = kDisplayCap;      ///< the most, kNoCap, or as often as the display refreshes
  std::uint32_t unfocused = 10;         ///< the most while another window has the focus
  VerticalSync sync = VerticalSync::kOff;
  bool operator==(const FrameSettings&) const = default;
};

/// How loud play is: amplitudes, 0 .. 1.
struct SoundSettings {
  float master = 0.8f;  ///< scales the others
  float effects = 1.0f, ambience = 1.0f, interface = 1.0f;
  bool captions = false;  ///< lines that say what is heard
  bool operator==(const SoundSettings&) const = default;
};

inline constexpr double kMinUiScale = 0.5, kMaxUiScale = 2.0;

/// How text, buttons and displays look.
struct UiSettings {
  float scale = 1.0f;                     ///< times the usual size, kMinUiScale .. kMaxUiScale
  std::optional<Language> language = {};  ///< none: that of the system
  bool operator==(const UiSettings&) const = default;
};

/// How keys and buttons work in play.
struct PlaySettings {
  bool toggle_sprint = false, toggle_crouch = false;  ///< by a press; else while held
  bool repeat = true;  ///< digging and placing go on while the button is held
  bool operator==(const PlaySettings&) const = default;
};

/// Everything `--set` reaches, with the defaults of quality `medium`. docs/settings.md says what
/// each means to a player.
struct Settings {
  render::RenderSettings render;               ///< of every frame
  std::array<std::int64_t, 3> world_offset{};  ///< whole blocks, +-2^40: moves every island
  std::optional<std::uint32_t>
      world_islands;          ///< only so many islands, nearest to the spawn first; none: all
  double world_time_s = 0.0;  ///< seconds of island motion, +-1e9
  double moon_phase = 0.5;    ///< 0 new, 0.5 full, 1 new again
  render::PanoramaPlacement ambient;   ///< of the scene's panorama, when it is read
  std::uint32_t view_distance = 1000;  ///< blocks, 32 .. 16384
  std::uint32_t view_detail = 192;     ///< blocks drawn at full detail, 32 .. 4096
  double view_error = 1.0;  ///< pixels that coarser sections of an island may be off by; 0: none
  std::uint32_t shadow_samples = 1;   ///< places on the discs of sun and moon, 1 .. 1024
  std::uint32_t lights_random = 0;    ///< torches scattered over what the first camera sees
  bool lights_held = false;           ///< a torch in the hand
  std::optional<double> exposure_ev;  ///< stops, -20 .. 20; none: metered
  RendererKind renderer = RendererKind::kAuto;
  UploadMode upload_path = UploadMode::kUpdate;
  std::uint64_t upload_budget_bytes = 8u << 20;    ///< a frame, 65536 .. 2^30
  std::optional<std::uint32_t> memory_budget_mib;  ///< for the world, 8 .. 2^20; none: by device
  std::uint32_t jobs_threads = 0;                  ///< 0: threads_beside_frames(); .. 256
  FrameSettings frames;
  SoundSettings sound;
  UiSettings ui;
  PlaySettings play;
  std::uint32_t reference_samples = 64;  ///< a pixel, 1 .. 65536
  ReferenceFilter reference_filter = ReferenceFilter::kPixel;
  bool operator==(const Settings&) const = default;
};

/// What a quality level stands for; everything else is as in Settings' defaults.
struct QualityLevel {
  std::string_view name;
  std::uint32_t view_distance, view_detail;
  int shadow_size;
  float bloom_intensity;
  std::uint32_t lights_shadows;
  int cloud_steps, cloud_resolution;
  float render_scale;
  int shading_rate;
};
const QualityLevel& quality_level(Quality quality);
Result<Quality> parse_quality(std::string_view text);
Settings settings_of(Quality quality);
/// Changes what a level stands for, and nothing else.
void set_quality(Quality quality, Settings& settings);

}  // namespace skerry::game
