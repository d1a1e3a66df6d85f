#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace skerry::game::ui {

/// What the player can turn to trade beauty for speed.
enum class Knob : std::uint8_t {
  kQuality,
  kViewDistance,
  kViewDetail,
  kScale,
  kShadows,
  kLightShadows,
  kAo,
  kIndirect,
  kBloom,
  kAntialiasing,
  kWater,
  kClouds,
  kCount
};

/// What turning a knob cost or saved: the median of the GPU's times of some frames before, against
/// that of some frames after. What else changes meanwhile counts too, so stand still.
class KnobCosts {
 public:
  /// Frames that a median is of, and frames after a turn that are left out: those were on their
  /// way.
  static constexpr std::size_t kFrames = 9, kSkipped = 4;

  /// @param complete false: more is on its way into view, and what is being measured begins anew.
  void note_frame(double gpu_ms, bool complete = true);
  /// A knob has moved. As long as its cost is being measured, further turns of the same knob count
  /// from where it was before the first.
  void turned(Knob knob);
  /// None: never turned, or no frames were seen before.
  std::optional<double> cost_ms(Knob knob) const { return costs_[index(knob)]; }
  bool measuring(Knob knob) const { return turned_ == knob; }
  bool measuring() const { return turned_.has_value(); }
  /// Median of the last frames; 0 before the first.
  double now_ms() const;

 private:
  static std::size_t index(Knob knob) { return static_cast<std::size_t>(knob); }
  std::vector<double> frames_;  // the last ones, oldest first
  std::array<std::optional<double>, static_cast<std::size_t>(Knob::kCount)> costs_{};
  std::optional<Knob> turned_;
  std::optional<double> before_ms_;
  std::size_t left_ = 0;  // frames until the cost is known
};

}  // namespace skerry::game::ui
