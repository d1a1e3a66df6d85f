// The keys of `--set`, and reading and writing settings by them.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/settings.h"

namespace skerry::game {

/// One key of `--set`.
struct SettingKey {
  std::string_view key;
  std::string_view values;  ///< what is accepted, for help and docs
  std::string_view meaning;
  Result<void> (*parse)(std::string_view value, Settings& into);
  std::string (*print)(const Settings& from);  ///< text that parse reads back as the same value
};

/// All keys, in the order of the documentation.
std::span<const SettingKey> setting_keys();

/// Sets one key. Errors name the accepted values, and the nearest key or value to what was typed.
Result<void> apply_setting(std::string_view key, std::string_view value, Settings& settings);
/// Same from "key=value".
Result<void> apply_setting(std::string_view assignment, Settings& settings);

/// The "key=value" assignments that turn settings_of(quality) into `settings`.
std::vector<std::string> assignments_from(Quality quality, const Settings& settings);

/// The parts of setting_keys(). Which world is shown, and how much of it: world.*, sky.*,
/// ambient.*, view.*.
std::span<const SettingKey> world_keys();
/// How surfaces are sampled and lit: aa.*, render.*, shadow.*, texture.*, gbuffer.*, lights.*,
/// ao.*, indirect.
std::span<const SettingKey> light_keys();
/// What follows shading, and clouds: exposure.*, bloom.*, clouds.*, tone, display.*.
std::span<const SettingKey> picture_keys();
/// Which renderer draws, what it leaves out, what it may take: renderer, shading.*, debug.*,
/// lights.*, leave.out, upload.*, memory.*, jobs.*, water.*, reference.*.
std::span<const SettingKey> program_keys();
/// How loud play is: sound.*.
std::span<const SettingKey> sound_keys();
/// How screens look, and how keys work in play: ui.*, play.*.
std::span<const SettingKey> play_keys();

}  // namespace skerry::game
