#include "tools/skerry/test/cause.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "engine/core/check.h"
#include "engine/platform/files.h"
#include "tools/skerry/compare/report_pictures.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// A debug view, and the step of a frame (docs/frame.md) that makes what it shows.
struct Channel {
  const char* name;
  const char* pass;
  render::DebugView view;
};

/// In the order of a frame: what one shows depends on those above it.
constexpr Channel kChannels[] = {
    {"depth", "draw_geometry", render::DebugView::kDepth},
    {"position", "draw_geometry", render::DebugView::kPosition},
    {"normal", "draw_geometry", render::DebugView::kNormal},
    {"metadata", "draw_geometry", render::DebugView::kMetadata},
    {"albedo", "draw_geometry", render::DebugView::kAlbedo},
    {"emissive", "draw_geometry", render::DebugView::kEmissive},
    {"cascades", "draw_shadow", render::DebugView::kCascades},
    {"shadow", "draw_shadow", render::DebugView::kShadow},
    {"clusters", "lights: mark, sort", render::DebugView::kClusters},
    {"light_count", "lights: mark, sort", render::DebugView::kLightCount},
    {"ao", "shade_surfaces", render::DebugView::kAo},
};

/// Key of the text in a channel's PNG that says which picture it belongs to.
constexpr const char* kPictureText = "Picture";

fs::path channel_file(const TestScene& scene, std::string_view driver, const Channel& channel) {
  return scene.approved(driver) / "channels" / fmt::format("{}.{}.png", scene.name, channel.name);
}

/// What is kept of a picture. None: nothing, or something of another picture.
std::optional<platform::PngImage> kept_channel(const TestScene& scene, std::string_view driver,
                                               const std::string& picture, const Channel& channel) {
  Result<platform::PngImage> kept = platform::read_png(channel_file(scene, driver, channel));
  if (!kept) return std::nullopt;
  const bool belongs = std::ranges::any_of(kept->text, [&](const platform::PngText& text) {
    return text.key == kPictureText && text.text == picture;
  });
  if (!belongs) return std::nullopt;
  return *std::move(kept);
}

/// None: no pixel differs that is not masked. @pre both have the same size.
std::optional<Cause> difference_of(const Channel& channel, const platform::PngImage& kept,
                                   const platform::PngImage& drawn,
                                   std::span<const game::Mask> masks) {
  Cause cause{channel.name, channel.pass, 0, {}, 0};
  std::uint32_t left = kept.width, top = kept.height, right = 0, bottom = 0;
  for (std::uint32_t y = 0; y < kept.height; ++y) {
    for (std::uint32_t x = 0; x < kept.width; ++x) {
      const std::size_t at = (std::size_t{y} * kept.width + x) * 4;
      int most = 0;
      for (std::size_t c = at; c < at + 3; ++c)
        most = std::max(most, std::abs(int{kept.pixels[c]} - int{drawn.pixels[c]}));
      if (most == 0 || game::is_masked(masks, x, y)) continue;
      ++cause.pixels;
      cause.largest = std::max(cause.largest, most);
      left = std::min(left, x);
      top = std::min(top, y);
      right = std::max(right, x + 1);
      bottom = std::max(bottom, y + 1);
    }
  }
  if (cause.pixels == 0) return std::nullopt;
  cause.around = {left, top, right - left, bottom - top};
  return cause;
}

}  // namespace

std::string text_of(const Cause& cause) {
  if (cause.channel.empty())
    return "all channels of the G-buffer are equal: shading or a later pass differs";
  return fmt::format(
      "{} ({}) is the first to differ: {} {} in [{}, {}, {}, {}], by up to {} of 255",
      cause.channel, cause.pass, cause.pixels, cause.pixels == 1 ? "pixel" : "pixels",
      cause.around.x, cause.around.y, cause.around.width, cause.around.height, cause.largest);
}

std::vector<fs::path> channel_files(const TestScene& scene, std::string_view driver) {
  std::vector<fs::path> files;
  if (!scene.baseline) return files;
  for (const Channel& channel : kChannels) files.push_back(channel_file(scene, driver, channel));
  return files;
}

Result<void> keep_channels(const TestScene& scene, std::string_view driver,
                           const std::string& picture, const DrawChannel& draw) {
  SKERRY_ASSERT(scene.baseline.has_value());
  if (auto made = platform::make_dirs(scene.approved(driver) / "channels"); !made) return made;
  const std::vector<platform::PngText> text{{kPictureText, picture}};
  for (const Channel& channel : kChannels) {
    const Result<platform::PngImage> drawn = draw(channel.view);
    if (!drawn) return drawn.error();
    const platform::PixelView view{drawn->width, drawn->height, 4, drawn->pixels};
    const auto written = platform::write_png(channel_file(scene, driver, channel), view, text);
    if (!written) return written;
  }
  return {};
}

bool has_channels(const TestScene& scene, std::string_view driver, const std::string& picture) {
  return scene.baseline && std::ranges::all_of(kChannels, [&](const Channel& channel) {
           return kept_channel(scene, driver, picture, channel).has_value();
         });
}

Result<std::optional<Cause>> find_cause(const TestScene& scene, std::string_view driver,
                                        const std::string& approved, const DrawChannel& draw) {
  if (!has_channels(scene, driver, approved)) return std::optional<Cause>();
  for (const Channel& channel : kChannels) {
    const std::optional<platform::PngImage> kept = kept_channel(scene, driver, approved, channel);
    const Result<platform::PngImage> drawn = draw(channel.view);
    if (!drawn) return drawn.error();
    if (!kept || !same_size(*kept, *drawn)) return std::optional<Cause>();
    const auto cause = difference_of(channel, *kept, *drawn, scene.expected.masks);
    if (cause) return std::optional<Cause>(cause);
  }
  return std::optional<Cause>(Cause());
}

}  // namespace skerry::tools
