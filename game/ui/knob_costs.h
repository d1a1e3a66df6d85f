#pragma once
#include <algorithm>
#include <array>
#include <cmath>
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
  struct Cost {
    double ms = 0.0;
    double spread_ms = 0.0;  ///< between frames that are drawn alike, before and after together
    /// Whether the knob made the difference, as far as the frames can tell.
    bool certain() const { return std::abs(ms) > std::max(spread_ms, kLeastShown); }
    static constexpr double kLeastShown = 0.05;  // rounds to no tenth of a millisecond
  };
  /// Frames that a median is of, and frames after a turn that are left out: those were on their
  /// way.
  static constexpr std::size_t kFrames = 9, kSkipped = 4;

  /// @param complete false: more is on its way into view, and what is being measured begins anew.
  void note_frame(double gpu_ms, bool complete = true);
  /// A knob has moved. As long as its cost is being measured, further turns of the same knob count
  /// from where it was before the first.
  void turned(Knob knob);
  /// None: never turned, or no frames were seen before.
  std::optional<Cost> cost(Knob knob) const { return costs_[index(knob)]; }
  bool measuring(Knob knob) const { return turned_ == knob; }
  bool measuring() const { return turned_.has_value(); }
  /// Median of the last frames; 0 before the first.
  double now_ms() const { return now().median_ms; }

 private:
  struct Times {
    double median_ms = 0.0;
    double spread_ms = 0.0;  // between the quartiles
  };
  Times now() const;
  static std::size_t index(Knob knob) { return static_cast<std::size_t>(knob); }
  std::vector<double> frames_;  // the last ones, oldest first
  std::array<std::optional<Cost>, static_cast<std::size_t>(Knob::kCount)> costs_{};
  std::optional<Knob> turned_;
  std::optional<Times> before_;
  std::size_t left_ = 0;  // frames until the cost is known
};

}  // namespace skerry::game::ui
