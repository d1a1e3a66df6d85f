#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct ImFont;

namespace skerry::game::ui {

/// What a text is for; each is a size of one typeface.
enum class TextSize { kSmall, kBody, kHeading, kTitle };

/// DejaVu Sans where distributions put it; none if it is not installed: then ImGui's own font
/// serves, rasterised bigger.
std::optional<std::filesystem::path> find_typeface();
/// Files of typefaces with Chinese and Japanese where distributions put them, the best first.
std::span<const char* const> fallback_typefaces();
/// The first of those that is installed. @param root of the file system.
std::optional<std::filesystem::path> find_fallback_typeface(
    const std::filesystem::path& root = "/");

/// The typeface in every size that a window may ask for. Glyphs are drawn at the size they are
/// shown at, so that they stay crisp. Latin is there from the beginning; other characters come with
/// the first text that has them.
class Fonts {
 public:
  /// Adds the fonts to the current ImGui context's atlas, which reads them as long as this lives.
  /// @param fallback typeface of the characters that DejaVu Sans does not have.
  explicit Fonts(std::optional<std::filesystem::path> fallback = find_fallback_typeface());
  /// The largest that is no larger than asked for, or the smallest there is.
  ImFont* at(TextSize size, float scale) const;

  /// Characters that will be shown, UTF-8 or one alone; with a character of an alphabet comes all
  /// of that alphabet. Before fit().
  void want(std::string_view text);
  void want(char32_t character);
  /// Makes the atlas anew if characters are wanted that it does not have; between frames. Fonts
  /// that at() returned before are gone then. @return whether it did.
  bool fit();

 private:
  void make();
  std::optional<std::filesystem::path> fallback_;
  std::string typeface_bytes_, fallback_bytes_;  // of the files; empty: not read
  static constexpr std::array<float, 10> kSizes{12, 14, 18, 24, 28, 36, 48, 56, 72, 96};  // pixels
  std::array<ImFont*, kSizes.size()> fonts_{};
  std::set<char32_t> wanted_;           // beyond Latin
  std::vector<unsigned short> ranges_;  // of those, as ImGui reads them while it makes the atlas
  bool outdated_ = false;
};

}  // namespace skerry::game::ui
