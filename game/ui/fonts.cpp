#include "game/ui/fonts.h"

#include <imgui.h>

#include <algorithm>

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
constexpr float kLargest = 36.0f;  // with all of kLatin

}  // namespace

std::optional<std::filesystem::path> find_typeface() {
  for (const char* path :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf"}) {
    std::error_code code;
    if (std::filesystem::is_regular_file(path, code)) return path;
  }
  return std::nullopt;
}

Fonts::Fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const std::optional<std::filesystem::path> typeface = find_typeface();
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    ImFontConfig config;
    config.OversampleH = 1;  // with glyphs on whole pixels, more would only blur
    config.PixelSnapH = true;
    config.SizePixels = kSizes[i];
    fonts_[i] = typeface ? atlas.AddFontFromFileTTF(typeface->c_str(), kSizes[i], &config,
                                                    kSizes[i] <= kLargest ? kLatin : kAscii)
                         : atlas.AddFontDefault(&config);
  }
}

ImFont* Fonts::at(TextSize size, float scale) const {
  const float wanted = wanted_size(size) * scale + 0.5f;
  const auto above = std::upper_bound(kSizes.begin(), kSizes.end(), wanted);
  return fonts_[static_cast<std::size_t>(above == kSizes.begin() ? 0 : above - kSizes.begin() - 1)];
}

}  // namespace skerry::game::ui
