#include "game/ui/fonts.h"

#include <imgui.h>
#include <imgui_internal.h>  // how it reads UTF-8

#include <algorithm>
#include <utility>

#include "engine/platform/files.h"

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

constexpr std::array kTypefaces{"usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                "usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                "usr/share/fonts/dejavu/DejaVuSans.ttf",
                                "usr/share/fonts/TTF/DejaVuSans.ttf"};
// Droid Sans comes last: it has no Korean.
constexpr std::array kFallbackTypefaces{
    "usr/share/fonts/truetype/wqy/wqy-microhei.ttc",
    "usr/share/fonts/wqy-microhei-fonts/wqy-microhei.ttc",
    "usr/share/fonts/opentype/noto/NotoSansCJK-Regular.ttc",
    "usr/share/fonts/google-noto-sans-cjk-fonts/NotoSansCJK-Regular.ttc",
    "usr/share/fonts/noto-cjk/NotoSansCJK-Regular.ttc",
    "usr/share/fonts/truetype/wqy/wqy-zenhei.ttc",
    "usr/share/fonts/wqy-zenhei-fonts/wqy-zenhei.ttc",
    "usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf"};
constexpr std::uint64_t kMostTypefaceBytes = 64u << 20;

std::optional<std::filesystem::path> first_file(const std::filesystem::path& root,
                                                std::span<const char* const> files) {
  for (const char* file : files) {
    std::error_code code;
    if (std::filesystem::is_regular_file(root / file, code)) return root / file;
  }
  return std::nullopt;
}

/// The file's bytes, read once; empty if it cannot be read.
std::string& read_once(const std::optional<std::filesystem::path>& file, std::string& bytes) {
  if (!file || !bytes.empty()) return bytes;
  if (Result<std::string> read = platform::read_text(*file, kMostTypefaceBytes))
    bytes = *std::move(read);
  return bytes;
}

}  // namespace

std::optional<std::filesystem::path> find_typeface() {
  return first_file("/", kTypefaces);
}

std::span<const char* const> fallback_typefaces() {
  return kFallbackTypefaces;
}

std::optional<std::filesystem::path> find_fallback_typeface(const std::filesystem::path& root) {
  return first_file(root, kFallbackTypefaces);
}

Fonts::Fonts(std::optional<std::filesystem::path> fallback) : fallback_(std::move(fallback)) {
  make();
}

void Fonts::make() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  std::string& typeface = read_once(find_typeface(), typeface_bytes_);
  if (!wanted_.empty()) read_once(fallback_, fallback_bytes_);
  const auto add = [&atlas](std::string& file, float size, ImFontConfig& config,
                            const ImWchar* ranges) {
    config.FontDataOwnedByAtlas = false;  // the sizes share it
    return atlas.AddFontFromMemoryTTF(file.data(), static_cast<int>(file.size()), size, &config,
                                      ranges);
  };
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
    fonts_[i] = typeface.empty() ? atlas.AddFontDefault(&config)
                                 : add(typeface, kSizes[i], config, all ? kLatin : kAscii);
    if (!all || wanted_.empty()) continue;
    config.MergeMode = true;  // what a font has already, a later one leaves as it is
    for (std::string* file : {&typeface, &fallback_bytes_})
      if (!file->empty()) add(*file, kSizes[i], config, ranges_.data());
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
