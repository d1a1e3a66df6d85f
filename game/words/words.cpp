#include "game/words/words.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <unordered_map>

// cmake/words.cmake embeds a file for each language.
#define SKERRY_WORDS(code) extern "C" const char skerry_words_##code[], skerry_words_##code##_end[]
SKERRY_WORDS(en);
SKERRY_WORDS(de);
SKERRY_WORDS(fr);
SKERRY_WORDS(es);
SKERRY_WORDS(ru);
SKERRY_WORDS(zh);
SKERRY_WORDS(ja);
#undef SKERRY_WORDS

namespace skerry::game {
namespace {

using Table = std::unordered_map<std::string_view, const char*>;

/// Texts of a language by their keys.
struct Spoken {
  std::vector<std::pair<std::string, std::string>> lines;
  Table table;
};

const Spoken& spoken_in(Language language) {
  static const std::array<Spoken, kLanguages> kAll = [] {
    std::array<Spoken, kLanguages> all;
    for (std::size_t i = 0; i < kLanguages; ++i) {
      all[i].lines = read_words(words_of(static_cast<Language>(i)));
      for (const auto& [key, text] : all[i].lines) all[i].table.emplace(key, text.c_str());
    }
    return all;
  }();
  return kAll[static_cast<std::size_t>(language)];
}

std::atomic<Language> spoken_language = Language::kEnglish;

}  // namespace

Language language_of_locale(std::string_view locale) {
  const std::string_view code = locale.substr(0, locale.find_first_of("_.@-"));
  const auto found = std::find(kLanguageCodes.begin(), kLanguageCodes.end(), code);
  return found == kLanguageCodes.end() ? Language::kEnglish
                                       : static_cast<Language>(found - kLanguageCodes.begin());
}

Language system_language() {
  for (const char* variable : {"LC_ALL", "LC_MESSAGES", "LANG"})
    if (const char* value = std::getenv(variable); value && *value != '\0')
      return language_of_locale(value);
  return Language::kEnglish;
}

std::string_view words_of(Language language) {
  const std::array<std::string_view, kLanguages> kFiles{{
      {skerry_words_en, skerry_words_en_end},
      {skerry_words_de, skerry_words_de_end},
      {skerry_words_fr, skerry_words_fr_end},
      {skerry_words_es, skerry_words_es_end},
      {skerry_words_ru, skerry_words_ru_end},
      {skerry_words_zh, skerry_words_zh_end},
      {skerry_words_ja, skerry_words_ja_end},
  }};
  return kFiles[static_cast<std::size_t>(language)];
}

std::vector<std::pair<std::string, std::string>> read_words(std::string_view file) {
  constexpr std::string_view kSign = " = ";
  std::vector<std::pair<std::string, std::string>> lines;
  while (!file.empty()) {
    const std::size_t end = std::min(file.find('\n'), file.size());
    const std::string_view line = file.substr(0, end);
    file.remove_prefix(std::min(end + 1, file.size()));
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t sign = line.find(kSign);
    const std::string_view key = line.substr(0, sign);
    lines.emplace_back(key, sign == line.npos ? key : line.substr(sign + kSign.size()));
  }
  return lines;
}

void speak(Language language) {
  spoken_language = language;
}

const char* tr(const char* english) {
  const Table& table = spoken_in(spoken_language).table;
  const auto found = table.find(english);
  return found == table.end() ? english : found->second;
}

}  // namespace skerry::game
