// The settings that `--quality auto` chooses among, and the error that each is known to cost.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "game/scene_file/settings.h"

namespace skerry::game {

/// Mean FLIP of a topic's point of `skerry report` against the topic's last point, over its scenes.
struct MeasuredError {
  std::string_view topic, point;  ///< names in tools/skerry/report/topics.cpp
  double flip = 0.0;
};
/// Measured on lavapipe (Mesa 22.3.6, 2026-11-23), column change_flip_mean of the rows `all`, by
///     skerry report render_scale shading_rate view_distance view_detail shadow_size lights_shadows
///       --size 320x180 --out DIR
/// tests/tools/report/quality_errors_test.cpp draws those of pixels again and allows differences of
/// kErrorTolerance.
std::span<const MeasuredError> measured_errors();
inline constexpr double kErrorTolerance = 0.002;  ///< FLIP

/// One setting of the front.
struct FrontPoint {
  Quality level = Quality::kMedium;  ///< what is not named here
  float render_scale = 1.0f;
  int shading_rate = 1;
  /// Of a frame at 1280x720 on two cores by lavapipe, as docs/performance.md has it: until a
  /// machine has been measured, only the ratios of these are used.
  double prior_ms = 1.0;
  /// FLIP against level ultra with every pixel shaded: the sum of the settings' measured errors.
  double error = 0.0;
};

/// From the cheapest to the most exact; errors fall from each to the next.
std::span<const FrontPoint> quality_front();
/// "medium 0.75", "medium 1.00 rate 4": unique.
std::string label_of(const FrontPoint& point);
/// The first point of that level and scale. @pre there is one.
std::size_t find_point(Quality level, float render_scale);

/// Whether a key of `--set` is among those that a point decides.
bool is_chosen_by_front(std::string_view key);
/// Those of some "KEY=VALUE" whose keys a point decides.
std::vector<std::string> pins_among(std::span<const std::string> assignments);
/// Makes the settings those of a point; others stay. @param pinned "KEY=VALUE", valid, applied
/// afterwards: what was asked for by name.
void apply_front_point(const FrontPoint& point, std::span<const std::string> pinned,
                       Settings& settings);

}  // namespace skerry::game
