#include "game/scene_file/setting_keys.h"

#include <fmt/format.h>

#include "game/scene_file/parse.h"

namespace skerry::game {

std::span<const SettingKey> setting_keys() {
  static const std::vector<SettingKey> kAll = [] {
    std::vector<SettingKey> all;
    for (const std::span<const SettingKey> keys :
         {world_keys(), light_keys(), picture_keys(), program_keys(), sound_keys(), play_keys()})
      all.insert(all.end(), keys.begin(), keys.end());
    return all;
  }();
  return kAll;
}

Result<void> apply_setting(std::string_view key, std::string_view value, Settings& settings) {
  std::vector<std::string_view> names;
  for (const SettingKey& entry : setting_keys()) {
    if (entry.key == key) return entry.parse(value, settings);
    names.push_back(entry.key);
  }
  return Error{fmt::format("there is no setting {}: did you mean '{}'? docs/settings.md lists all",
                           quote_text(key), nearest_name(key, names))};
}

Result<void> apply_setting(std::string_view assignment, Settings& settings) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return Error{
        fmt::format("the setting {} has no value: give KEY=VALUE", quote_text(assignment))};
  }
  return apply_setting(assignment.substr(0, equals), assignment.substr(equals + 1), settings);
}

std::vector<std::string> assignments_from(Quality quality, const Settings& settings) {
  const Settings level = settings_of(quality);
  std::vector<std::string> assignments;
  for (const SettingKey& entry : setting_keys()) {
    const std::string value = entry.print(settings);
    if (value != entry.print(level)) assignments.push_back(fmt::format("{}={}", entry.key, value));
  }
  return assignments;
}

}  // namespace skerry::game
