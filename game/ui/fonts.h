#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

struct ImFont;

namespace skerry::game::ui {

/// What a text is for; each is a size of one typeface.
enum class TextSize { kSmall, kBody, kHeading, kTitle };

/// The typeface in every size that a window may ask for. Glyphs are drawn at the size they are
/// shown at, so that they stay crisp. Latin is there from the beginning; other characters come with
/// the first text that has them.
class Fonts {
 public:
  /// Adds the fonts to the current ImGui context's atlas.
  Fonts();
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
  static constexpr std::array<float, 10> kSizes{12, 14, 18, 24, 28, 36, 48, 56, 72, 96};  // pixels
  std::array<ImFont*, kSizes.size()> fonts_{};
  std::set<char32_t> wanted_;           // beyond Latin
  std::vector<unsigned short> ranges_;  // of those, as ImGui reads them while it makes the atlas
  bool outdated_ = false;
};

/// DejaVu Sans where distributions put it; none if it is not installed: then ImGui's own font
/// serves, rasterised bigger.
std::optional<std::filesystem::path> find_typeface();
/// A typeface with Chinese, Japanese and Korean for what that one does not have; none if none of
/// those known here is installed.
std::optional<std::filesystem::path> find_fallback_typeface();

}  // namespace skerry::game::ui
