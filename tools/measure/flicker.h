#pragma once
#include <cstdint>
#include <span>

namespace skerry::measure {

/// How far a channel must change to be seen as a change [1/255].
inline constexpr int kSeenChange = 40;

/// Pixels of pairs of successive frames, of pictures and of the ideal pictures of the same moments.
struct FlickerCounts {
  std::uint64_t pixels = 0;
  std::uint64_t changed = 0;  ///< some channel of the picture changes by more than kSeenChange
  std::uint64_t truly_changed = 0;  ///< some channel of the ideal picture does
  /// The picture's change differs from the ideal one by more than kSeenChange in some channel: a
  /// change that is not there, or one that is missing or late.
  std::uint64_t flickered = 0;
  bool operator==(const FlickerCounts&) const = default;
};

/// A picture of one moment as it is shown, and as it should be: RGBA8, alpha is left out.
struct Moment {
  std::span<const std::uint8_t> shown, ideal;
};

/// Counts the pixels of two successive frames. @pre all pictures have equal size (asserted).
FlickerCounts count_flicker(const Moment& before, const Moment& now);

/// How far a channel may change from one frame to the next where light moves smoothly [1/255].
inline constexpr int kSmoothChange = 2;

/// How far it may where a coarser level of detail takes the place of another [1/255].
inline constexpr int kUnseenChange = 8;

struct StepCounts {
  std::uint64_t pixels = 0;
  std::uint64_t stepped = 0;  ///< some channel changes by more than it may
  int largest = 0;            ///< change of a channel [1/255]
  bool operator==(const StepCounts&) const = default;
};

/// Of two successive pictures: RGBA8, alpha is left out. @pre they have equal size (asserted).
/// @param may how far a channel may change [1/255].
StepCounts count_steps(std::span<const std::uint8_t> before, std::span<const std::uint8_t> now,
                       int may = kSmoothChange);

}  // namespace skerry::measure
