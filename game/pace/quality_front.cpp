#include "game/pace/quality_front.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "engine/core/check.h"
#include "game/scene_file/setting_keys.h"

namespace skerry::game {
namespace {

constexpr MeasuredError kErrors[] = {{"render_scale", "0.25", 0.1081},
                                     {"render_scale", "0.33", 0.0900},
                                     {"render_scale", "0.5", 0.0664},
                                     {"render_scale", "1", 0.0},
                                     {"shading_rate", "4, 0.3", 0.0239},
                                     {"shading_rate", "1", 0.0},
                                     {"view_distance", "400", 0.0447},
                                     {"view_distance", "1000", 0.0240},
                                     {"view_distance", "2000", 0.0098},
                                     {"view_distance", "4000", 0.0},
                                     {"view_detail", "128", 0.0139},
                                     {"view_detail", "192", 0.0118},
                                     {"view_detail", "320", 0.0107},
                                     {"view_detail", "512", 0.0020},
                                     {"shadow_size", "1024", 0.0241},
                                     {"shadow_size", "2048", 0.0120},
                                     {"shadow_size", "4096", 0.0},
                                     {"lights_shadows", "nearest:1", 0.0152},
                                     {"lights_shadows", "nearest:4", 0.0086},
                                     {"lights_shadows", "nearest:8", 0.0054},
                                     {"lights_shadows", "all", 0.0}};

constexpr std::string_view kChosenKeys[] = {"view.distance",   "view.detail",       "shadow.size",
                                            "bloom.intensity", "lights.shadows",    "clouds.steps",
                                            "render.scale",    "clouds.resolution", "shading.rate"};

double error_of(std::string_view topic, std::string_view point) {
  for (const MeasuredError& error : kErrors)
    if (error.topic == topic && error.point == point) return error.flip;
  SKERRY_ASSERT(false);
  return 0.0;
}

/// Bloom and clouds are not counted: the first is a matter of taste, and most skies have no second.
double error_of(const FrontPoint& point) {
  const QualityLevel& level = quality_level(point.level);
  const std::string lamps = level.lights_shadows == render::kEveryLight
                                ? "all"
                                : fmt::format("nearest:{}", level.lights_shadows);
  const std::string rate =
      point.shading_rate == 1 ? "1" : fmt::format("{}, 0.3", point.shading_rate);
  return error_of("render_scale", fmt::format("{}", point.render_scale)) +
         error_of("shading_rate", rate) +
         error_of("view_distance", fmt::format("{}", level.view_distance)) +
         error_of("view_detail", fmt::format("{}", level.view_detail)) +
         error_of("shadow_size", fmt::format("{}", level.shadow_size)) +
         error_of("lights_shadows", lamps);
}

std::vector<FrontPoint> make_front() {
  std::vector<FrontPoint> front{
      {Quality::kLow, 0.25f, 4, 25.5},    {Quality::kMedium, 0.25f, 4, 28.5},
      {Quality::kMedium, 0.33f, 4, 31.5}, {Quality::kMedium, 0.5f, 4, 44.3},
      {Quality::kHigh, 0.5f, 4, 61.9},    {Quality::kMedium, 1.0f, 4, 88.3},
      {Quality::kHigh, 1.0f, 4, 137.8},   {Quality::kHigh, 1.0f, 1, 173.9},
      {Quality::kUltra, 1.0f, 1, 330.0}};
  for (FrontPoint& point : front) point.error = error_of(point);
  return front;
}

}  // namespace

std::span<const MeasuredError> measured_errors() {
  return kErrors;
}

std::span<const FrontPoint> quality_front() {
  static const std::vector<FrontPoint> kFront = make_front();
  return kFront;
}

std::string label_of(const FrontPoint& point) {
  std::string label = fmt::format("{} {:.2f}", quality_level(point.level).name, point.render_scale);
  if (point.shading_rate != 1) label += fmt::format(" rate {}", point.shading_rate);
  return label;
}

std::size_t find_point(Quality level, float render_scale) {
  const auto front = quality_front();
  const auto same = [=](const FrontPoint& point) {
    return point.level == level && point.render_scale == render_scale;
  };
  const auto found = std::find_if(front.begin(), front.end(), same);
  SKERRY_ASSERT(found != front.end());
  return static_cast<std::size_t>(found - front.begin());
}

bool is_chosen_by_front(std::string_view key) {
  return std::find(std::begin(kChosenKeys), std::end(kChosenKeys), key) != std::end(kChosenKeys);
}

std::vector<std::string> pins_among(std::span<const std::string> assignments) {
  std::vector<std::string> pins;
  for (const std::string& assignment : assignments)
    if (is_chosen_by_front(assignment.substr(0, assignment.find('=')))) pins.push_back(assignment);
  return pins;
}

void apply_front_point(const FrontPoint& point, std::span<const std::string> pinned,
                       Settings& settings) {
  set_quality(point.level, settings);
  settings.render.render_scale = point.render_scale;
  settings.render.shading_rate = point.shading_rate;
  for (const std::string& assignment : pinned) {
    const Result<void> applied = apply_setting(assignment, settings);
    SKERRY_ASSERT(applied);
  }
}

}  // namespace skerry::game
