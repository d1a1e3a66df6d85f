#include <fmt/format.h>

#include "game/scene_file/parse.h"
#include "game/scene_file/setting_keys.h"
#include "game/scene_file/setting_values.h"

namespace skerry::game {
namespace {

Result<void> parse_volume(std::string_view text, std::string_view key, float& volume) {
  return into_number(parse_number(text, key, 0.0, 1.0), volume);
}

constexpr SettingKey kSoundKeys[] = {
    {"sound.master", "0 to 1", "Loudness of play; 0: silence. Scales the other three.",
     [](std::string_view t, Settings& s) {
       return parse_volume(t, "sound.master", s.sound.master);
     },
     [](const Settings& s) { return fmt::format("{}", s.sound.master); }},
    {"sound.effects", "0 to 1",
     "Loudness of steps, digging, placing, splashes, islands that grind.",
     [](std::string_view t, Settings& s) {
       return parse_volume(t, "sound.effects", s.sound.effects);
     },
     [](const Settings& s) { return fmt::format("{}", s.sound.effects); }},
    {"sound.ambience", "0 to 1", "Loudness of wind, torches, lava and water.",
     [](std::string_view t, Settings& s) {
       return parse_volume(t, "sound.ambience", s.sound.ambience);
     },
     [](const Settings& s) { return fmt::format("{}", s.sound.ambience); }},
    {"sound.interface", "0 to 1", "Loudness of the screens' clicks.",
     [](std::string_view t, Settings& s) {
       return parse_volume(t, "sound.interface", s.sound.interface);
     },
     [](const Settings& s) { return fmt::format("{}", s.sound.interface); }},
    {"sound.captions", "0 or 1", "Lines that say what is heard, and from which side.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "sound.captions", kSwitchNames), s.sound.captions);
     },
     [](const Settings& s) { return name_of(kSwitchNames, s.sound.captions); }},
};

}  // namespace

std::span<const SettingKey> sound_keys() {
  return kSoundKeys;
}

}  // namespace skerry::game
