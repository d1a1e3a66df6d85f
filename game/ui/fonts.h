#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>

struct ImFont;

namespace skerry::game::ui {

/// What a text is for; each is a size of one typeface.
enum class TextSize { kSmall, kBody, kHeading, kTitle };

/// The typeface in every size that a window may ask for. Glyphs are drawn at the size they are
/// shown at, so that they stay crisp.
class Fonts {
 public:
  /// Adds the fonts to the current ImGui context's atlas.
  Fonts();
  /// The largest that is no larger than asked for, or the smallest there is.
  ImFont* at(TextSize size, float scale) const;

 private:
  static constexpr std::array<float, 10> kSizes{12, 14, 18, 24, 28, 36, 48, 56, 72, 96};  // pixels
  std::array<ImFont*, kSizes.size()> fonts_{};
};

/// DejaVu Sans where distributions put it; none if it is not installed: then ImGui's own font
/// serves, rasterised bigger.
std::optional<std::filesystem::path> find_typeface();

}  // namespace skerry::game::ui
