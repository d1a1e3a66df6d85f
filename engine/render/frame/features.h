#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/render/frame/celestial.h"

namespace skerry::render {

/// What a scene can do without. A frame that lacks one spends nothing on it: no pass, no draw, no
/// pipeline, no memory.
enum class Feature : std::uint8_t {
  kSun,
  kMoon,
  kWater,
  kCutouts,
  kStars,
  kDiscs,
  kHaze,
  kLights,
  kClouds
};
inline constexpr std::array<std::string_view, 9> kFeatureNames{
    "sun", "moon", "water", "cutouts", "stars", "discs", "haze", "lights", "clouds"};

class FeatureSet {
 public:
  bool has(Feature feature) const { return (bits_ & bit(feature)) != 0; }
  void add(Feature feature) { bits_ |= bit(feature); }
  bool operator==(const FeatureSet&) const = default;

 private:
  static std::uint32_t bit(Feature feature) { return 1u << static_cast<std::uint32_t>(feature); }
  std::uint32_t bits_ = 0;
};

/// Which features a frame has, and why not the others.
class FrameFeatures {
 public:
  /// @param left_out are absent whatever the scene says.
  explicit FrameFeatures(const FeatureSet& left_out);
  /// @param why a literal: what the scene lacks. A feature that was left out stays so.
  void set_absent(Feature feature, const char* why);
  bool has(Feature feature) const { return why_not(feature) == nullptr; }
  /// Null if the frame has it.
  const char* why_not(Feature feature) const { return why_[static_cast<std::size_t>(feature)]; }

 private:
  std::array<const char*, kFeatureNames.size()> why_{};
};

/// The sky without these of its bodies: neither light nor disc nor glow is left of them.
Celestial sky_without(Celestial sky, const FeatureSet& left_out);

}  // namespace skerry::render
