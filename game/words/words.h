// The words of the screens in the language that the player reads.
#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "game/words/language.h"

namespace skerry::game {

/// The language of a locale such as "de_AT.UTF-8"; English where there is none of it.
Language language_of_locale(std::string_view locale);
/// That of the environment: LC_ALL, LC_MESSAGES, LANG, the first that is set.
Language system_language();

/// The file of a language, as it is embedded (game/words/*.txt).
std::string_view words_of(Language language);
/// Its lines "ENGLISH = TEXT"; English has "ENGLISH" alone. Lines that begin with # and empty ones
/// are left out.
std::vector<std::pair<std::string, std::string>> read_words(std::string_view file);

/// From now on tr() answers in a language; to begin with in English. Any thread.
void speak(Language language);

/// A text in the language that is spoken. @param english of the program itself: the key of the
/// files. @return as given, if the file has no such line.
const char* tr(const char* english);

/// Marks a text of the program that tr() is given elsewhere: a test looks for all of them.
constexpr const char* word(const char* english) {
  return english;
}

/// tr() with values for its places. @param english a format of fmt.
template <class... Values>
std::string tr_format(const char* english, const Values&... values) {
  return fmt::format(fmt::runtime(tr(english)), values...);
}

}  // namespace skerry::game
