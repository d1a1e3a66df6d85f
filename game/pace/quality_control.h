// Chooses how the next frame is drawn from how long the last ones took: a pure function, so that
// machines of every kind can be simulated (tests/game/pace, `skerry stability pace`).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace skerry::game {

/// Why a point of the front was chosen.
enum class Reason : std::uint8_t {
  kStart,    ///< nothing has been measured yet
  kProbing,  ///< this point is being measured
  kFits,     ///< the best of the measured ones that is quick enough
  kLate,     ///< the one before was too slow
  kSpare     ///< the one before left time over
};

/// What one frame tells the control.
struct FrameFacts {
  double now_s = 0.0;    ///< a clock that never goes back
  double work_ms = 0.0;  ///< that the frame took, without waiting for a cap or the display
  bool settled = true;   ///< nothing that would disturb a probe streams in or is compiled
  bool held = false;     ///< the choice must not change: photo mode, a screen, no focus
};

/// The whole state between two frames. Points are indices of the front, from the cheapest to the
/// most exact.
struct QualityControl {
  std::size_t point = 0;
  std::vector<double> priors_ms;                ///< by point: of the machine of quality_front()
  std::vector<std::optional<double>> costs_ms;  ///< by point: measured on this one, at one load
  Reason reason = Reason::kStart;
  std::vector<std::size_t> probes;  ///< points still to be measured, the next one last
  double mean_ms = 0.0;             ///< of the last half second

  struct Sample {
    double now_s = 0.0, ms = 0.0;
  };
  std::vector<Sample> samples;     ///< since the last change, of at most kLongWindow
  int to_skip = 0;                 ///< frames that were begun before the change
  double changed_s = 0.0;          ///< when the point changed last
  std::optional<double> raised_s;  ///< when it was raised last
  double raise_wait_s = 0.0;       ///< that must pass before it is raised
  double before_raise_ms = 0.0;    ///< mean before it was raised; 0: the raise has been measured
  std::size_t before_raise = 0;
};

inline constexpr double kShortWindow = 0.5;  ///< seconds of frames that a step down looks at
inline constexpr double kLongWindow = 2.0;   ///< and a step up
inline constexpr double kLateShare = 1.1;    ///< of the budget: more steps down
inline constexpr double kAimShare = 0.85;    ///< of the budget: what is chosen is to take no more
inline constexpr double kGuessShare = 0.7;   ///< the same of points that were never measured
inline constexpr double kFirstRaiseWait = 4.0, kLongestRaiseWait = 300.0;  ///< seconds

/// A control that begins at `point`. @param costs_ms what was learnt of this machine before; empty:
/// nothing, and `probes` are measured first. @param priors_ms by point, all above 0.
QualityControl begin_control(std::size_t point, std::vector<double> priors_ms,
                             std::vector<std::optional<double>> costs_ms,
                             std::span<const std::size_t> probes);

/// The control after one more frame. @param budget_ms time for a frame at the rate wanted, above 0.
/// Frame times that are no positive number are ignored.
QualityControl next_control(QualityControl control, const FrameFacts& frame, double budget_ms);

/// What a point is expected to take at the load of the measured costs: measured itself, or from the
/// nearest one that was. None: nothing was measured.
std::optional<double> expected_ms(const QualityControl& control, std::size_t point);

}  // namespace skerry::game
