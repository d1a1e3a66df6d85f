#include "game/scene_file/settings.h"

#include <array>

#include "game/scene_file/setting_values.h"

namespace skerry::game {
namespace {

constexpr std::array<QualityLevel, 4> kLevels{
    {{"low", 400, 128, 1024, 0.0f, 1, 16, 2, 0.5f, 4},
     {"medium", 1000, 192, 2048, 0.0f, 4, 24, 2, 1.0f, 1},
     {"high", 2000, 320, 4096, 0.1f, 8, 48, 1, 1.0f, 1},
     {"ultra", 4000, 512, 4096, 0.1f, render::kEveryLight, 96, 1, 1.0f, 1}}};

}  // namespace

const QualityLevel& quality_level(Quality quality) {
  return kLevels[static_cast<std::size_t>(quality)];
}

Result<Quality> parse_quality(std::string_view text) {
  std::array<std::string_view, kLevels.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kLevels[i].name;
  const Result<std::size_t> level = parse_name(text, "the quality", names);
  if (!level) return level.error();
  return static_cast<Quality>(*level);
}

Settings settings_of(Quality quality) {
  Settings settings;
  set_quality(quality, settings);
  return settings;
}

void set_quality(Quality quality, Settings& settings) {
  const QualityLevel& level = quality_level(quality);
  settings.view_distance = level.view_distance;
  settings.view_detail = level.view_detail;
  settings.render.shadow_size = level.shadow_size;
  settings.render.bloom.intensity = level.bloom_intensity;
  settings.render.lights_shadows = level.lights_shadows;
  settings.render.clouds.steps = level.cloud_steps;
  settings.render.clouds.resolution = level.cloud_resolution;
  settings.render.render_scale = level.render_scale;
  settings.render.shading_rate = level.shading_rate;
}

}  // namespace skerry::game
