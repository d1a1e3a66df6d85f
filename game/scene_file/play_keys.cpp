#include <fmt/format.h>

#include "game/scene_file/parse.h"
#include "game/scene_file/setting_keys.h"
#include "game/scene_file/setting_values.h"

namespace skerry::game {
namespace {

constexpr std::array<std::string_view, 2> kHoldNames{"hold", "toggle"};

Result<void> parse_language(std::string_view text, Settings& s) {
  s.ui.language.reset();
  if (text == "auto") return {};
  const Result<std::size_t> language = parse_name(text, "ui.language", kLanguageCodes);
  if (!language) return language.error();
  s.ui.language = static_cast<Language>(*language);
  return {};
}

constexpr SettingKey kPlayKeys[] = {
    {"ui.scale", "0.5 to 2", "Size of text, buttons and displays, times the usual.",
     [](std::string_view t, Settings& s) {
       return into_number(parse_number(t, "ui.scale", kMinUiScale, kMaxUiScale), s.ui.scale);
     },
     [](const Settings& s) { return fmt::format("{}", s.ui.scale); }},
    {"ui.language", "auto, en, de, fr, es, ru, zh or ja",
     "Language of the screens; auto: the system's.", parse_language,
     [](const Settings& s) {
       return s.ui.language ? name_of(kLanguageCodes, *s.ui.language) : std::string("auto");
     }},
    {"play.sprint", "hold or toggle",
     "toggle: one press begins to sprint; another, or standing still, ends it.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "play.sprint", kHoldNames), s.play.toggle_sprint);
     },
     [](const Settings& s) { return name_of(kHoldNames, s.play.toggle_sprint); }},
    {"play.crouch", "hold or toggle",
     "toggle: one press begins to crouch, another ends it. Flying, the key sinks while held.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "play.crouch", kHoldNames), s.play.toggle_crouch);
     },
     [](const Settings& s) { return name_of(kHoldNames, s.play.toggle_crouch); }},
    {"play.repeat", "0 or 1",
     "Digging and placing go on while the button is held; 0: once a press.",
     [](std::string_view t, Settings& s) {
       return into_name(parse_name(t, "play.repeat", kSwitchNames), s.play.repeat);
     },
     [](const Settings& s) { return name_of(kSwitchNames, s.play.repeat); }},
};

}  // namespace

std::span<const SettingKey> play_keys() {
  return kPlayKeys;
}

}  // namespace skerry::game
