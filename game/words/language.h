#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace skerry::game {

/// What the screens are written in.
enum class Language : std::uint8_t {
  kEnglish,
  kGerman,
  kFrench,
  kSpanish,
  kRussian,
  kChinese,
  kJapanese,
  kCount
};
inline constexpr std::size_t kLanguages = static_cast<std::size_t>(Language::kCount);

/// As settings and locales name them (ISO 639-1).
inline constexpr std::array<std::string_view, kLanguages> kLanguageCodes{"en", "de", "fr", "es",
                                                                         "ru", "zh", "ja"};
/// As those who speak them do.
inline constexpr std::array<const char*, kLanguages> kLanguageNames{
    "English", "Deutsch", "Français", "Español", "Русский", "中文", "日本語"};

}  // namespace skerry::game
