#include "game/ui/fonts.h"

#include <imgui.h>
#include <imgui_internal.h>  // how it reads UTF-8

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace skerry::game::ui {
namespace {

constexpr float kSmall = 14.0f, kBody = 18.0f, kHeading = 28.0f, kTitle = 72.0f;  // at scale 1

float wanted_size(TextSize size) {
  switch (size) {
    case TextSize::kSmall:
      return kSmall;
    case TextSize::kBody:
      return kBody;
    case TextSize::kHeading:
      return kHeading;
    case TextSize::kTitle:
      return kTitle;
  }
  return kBody;
}

// What names and messages need. The large sizes are for words of ours alone.
constexpr ImWchar kLatin[] = {0x20, 0x7e, 0xa0, 0x17f, 0x2010, 0x2026, 0};
constexpr ImWchar kAscii[] = {0x20, 0x7e, 0};
constexpr float kLargest = 56.0f;  // with all of kLatin

// Alphabets that come as a whole, so that a text that is being typed asks for a new atlas once. All
// others, above all Chinese, come character by character.
struct Alphabet {
  char32_t first, last;
};
constexpr Alphabet kAlphabets[] = {
    {0x0370, 0x03ff},  // Greek
    {0x0400, 0x052f},  // Cyrillic
    {0x0590, 0x05ff},  // Hebrew
    {0x3000, 0x30ff},  // Japanese: signs, Hiragana, Katakana
};
constexpr std::size_t kMostWanted =
    4000;  // characters; an atlas of more is larger than devices take

/// The first of a text, taken from it. What is no UTF-8 is left out, byte by byte.
std::optional<char32_t> next_character(std::string_view& text) {
  while (!text.empty()) {
    unsigned character = 0;
    const int bytes = ImTextCharFromUtf8(&character, text.data(), text.data() + text.size());
    text.remove_prefix(static_cast<std::size_t>(std::max(bytes, 1)));
    if (bytes > 0 && character != IM_UNICODE_CODEPOINT_INVALID) return character;
  }
  return std::nullopt;
}

bool is_latin(char32_t character) {
  return character <= 0x17f || (character >= 0x2010 && character <= 0x2026);
}

std::optional<std::filesystem::path> first_file(std::initializer_list<const char*> paths) {
  for (const char* path : paths) {
    std::error_code code;
    if (std::filesystem::is_regular_file(path, code)) return path;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::filesystem::path> find_typeface() {
  return first_file({"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                     "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                     "/usr/share/fonts/dejavu/DejaVuSans.ttf",
                     "/usr/share/fonts/TTF/DejaVuSans.ttf"});
}

std::optional<std::filesystem::path> find_fallback_typeface() {
  return first_file({"/usr/share/fonts/truetype/wqy/wqy-microhei.ttc",
                     "/usr/share/fonts/wqy-microhei-fonts/wqy-microhei.ttc",
                     "/usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf"});
}

Fonts::Fonts() {
  make();
}

void Fonts::make() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  const std::optional<std::filesystem::path> typeface = find_typeface();
  const std::optional<std::filesystem::path> fallback =
      wanted_.empty() ? std::nullopt : find_fallback_typeface();
  ranges_.clear();
  for (const char32_t character : wanted_)
    ranges_.insert(ranges_.end(), 2, static_cast<unsigned short>(character));
  ranges_.push_back(0);
  static_assert(sizeof(ImWchar) == sizeof(unsigned short));
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    ImFontConfig config;
    config.OversampleH = 1;  // with glyphs on whole pixels, more would only blur
    config.PixelSnapH = true;
    config.SizePixels = kSizes[i];
    const bool all = kSizes[i] <= kLargest;
    fonts_[i] = typeface ? atlas.AddFontFromFileTTF(typeface->c_str(), kSizes[i], &config,
                                                    all ? kLatin : kAscii)
                         : atlas.AddFontDefault(&config);
    if (!all || wanted_.empty()) continue;
    config.MergeMode = true;  // what a font has already, a later one leaves as it is
    for (const auto& path : {typeface, fallback})
      if (path) atlas.AddFontFromFileTTF(path->c_str(), kSizes[i], &config, ranges_.data());
  }
}

void Fonts::want(std::string_view text) {
  while (const std::optional<char32_t> character = next_character(text)) want(*character);
}

void Fonts::want(char32_t character) {
  if (is_latin(character) || character > 0xffff || wanted_.contains(character) ||
      wanted_.size() >= kMostWanted)
    return;
  outdated_ = true;
  wanted_.insert(character);
  for (const Alphabet& alphabet : kAlphabets)
    if (character >= alphabet.first && character <= alphabet.last)
      for (char32_t c = alphabet.first; c <= alphabet.last; ++c) wanted_.insert(c);
}

bool Fonts::fit() {
  const bool outdated = std::exchange(outdated_, false);
  if (outdated) make();
  return outdated;
}

ImFont* Fonts::at(TextSize size, float scale) const {
  const float largest = size == TextSize::kTitle ? kSizes.back() : kLargest;
  const float wanted = std::min(wanted_size(size) * scale + 0.5f, largest);
  const auto above = std::upper_bound(kSizes.begin(), kSizes.end(), wanted);
  return fonts_[static_cast<std::size_t>(above == kSizes.begin() ? 0 : above - kSizes.begin() - 1)];
}

}  // namespace skerry::game::ui
