#include "game/words/words.h"

#include <gtest/gtest.h>
#include <test_paths.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

namespace skerry::game {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines lines_of(Language language) {
  return read_words(words_of(language));
}

std::set<std::string> keys_of(Language language) {
  std::set<std::string> keys;
  for (const auto& [key, text] : lines_of(language))
    EXPECT_TRUE(keys.insert(key).second) << "twice: " << key;
  return keys;
}

/// What is filled in, in its order: "{:.1f}", "%d".
std::vector<std::string> places_of(const std::string& text) {
  static const std::regex kPlace(R"(\{[^}]*\}|%[-+0-9.]*[a-zA-Z])");
  std::vector<std::string> places;
  for (std::sregex_iterator at(text.begin(), text.end(), kPlace), end; at != end; ++at)
    places.push_back(at->str());
  return places;
}

TEST(Words, EveryLanguageHasEveryKeyAndNoOther) {
  const std::set<std::string> english = keys_of(Language::kEnglish);
  EXPECT_GT(english.size(), 200u);
  for (std::size_t i = 1; i < kLanguages; ++i)
    EXPECT_EQ(keys_of(static_cast<Language>(i)), english) << kLanguageCodes[i];
}

TEST(Words, PlacesForValuesAgree) {
  for (std::size_t i = 0; i < kLanguages; ++i)
    for (const auto& [key, text] : lines_of(static_cast<Language>(i))) {
      EXPECT_FALSE(text.empty()) << kLanguageCodes[i] << ": " << key;
      EXPECT_EQ(places_of(text), places_of(key)) << kLanguageCodes[i] << ": " << key;
    }
}

/// Texts that the sources give to tr(), tr_format() and word(), adjacent literals joined.
std::set<std::string> texts_in_sources() {
  const std::regex call(R"rx(\b(?:tr|tr_format|word)\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)[,)])rx");
  const std::regex literal(R"rx("((?:[^"\\]|\\.)*)")rx");
  std::set<std::string> texts;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(SKERRY_SOURCE_DIR) / "game")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".h") continue;
    std::ifstream in(entry.path());
    const std::string source(std::istreambuf_iterator<char>(in), {});
    for (std::sregex_iterator at(source.begin(), source.end(), call), end; at != end; ++at) {
      const std::string literals = (*at)[1];
      std::string text;
      for (std::sregex_iterator l(literals.begin(), literals.end(), literal); l != end; ++l)
        text += std::regex_replace((*l)[1].str(), std::regex(R"(\\(.))"), "$1");
      texts.insert(text);
    }
  }
  return texts;
}

TEST(Words, TheFilesHoldWhatTheSourcesAskForAndNoMore) {
  EXPECT_EQ(texts_in_sources(), keys_of(Language::kEnglish));
}

TEST(Words, LinesAreKeysAndTexts) {
  const Lines lines = read_words("# a comment = no line\n\nGo on = Weiter\nBack\nx = a = b");
  EXPECT_EQ(lines, (Lines{{"Go on", "Weiter"}, {"Back", "Back"}, {"x", "a = b"}}));
  EXPECT_TRUE(read_words("").empty());
}

TEST(Words, ALocaleNamesItsLanguage) {
  for (std::size_t i = 0; i < kLanguages; ++i)
    EXPECT_EQ(language_of_locale(std::string(kLanguageCodes[i])), static_cast<Language>(i));
  EXPECT_EQ(language_of_locale("de_AT.UTF-8"), Language::kGerman);
  EXPECT_EQ(language_of_locale("zh_TW"), Language::kChinese);
  EXPECT_EQ(language_of_locale("fr@euro"), Language::kFrench);
  for (const char* none : {"", "C", "C.UTF-8", "POSIX", "nl_NL.UTF-8", "den"})
    EXPECT_EQ(language_of_locale(none), Language::kEnglish) << none;
}

TEST(Words, WhatIsSpokenIsAnswered) {
  speak(Language::kGerman);
  EXPECT_STREQ(tr("Go on"), "Weiter");
  EXPECT_EQ(tr_format("{} blocks broke off and drift away: {}, an island of its own", 3, "Ay"),
            "3 Blöcke brachen ab und treiben davon: Ay, eine eigene Insel");
  EXPECT_STREQ(tr("no key of any file"), "no key of any file");
  speak(Language::kEnglish);
  EXPECT_STREQ(tr("Go on"), "Go on");
}

}  // namespace
}  // namespace skerry::game
