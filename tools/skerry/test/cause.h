// Where a picture begins to differ: the channels of the G-buffer of a picture that was approved,
// kept beside the references of a baseline, and the first of them that is another one now.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/platform/image_file.h"
#include "engine/render/frame/settings.h"
#include "tools/skerry/test/scene_set.h"

namespace skerry::tools {

/// The first channel that differs.
struct Cause {
  std::string channel;       ///< as `debug.view` names it; empty: none of them differs
  std::string pass;          ///< that makes it
  std::uint64_t pixels = 0;  ///< that differ and are not masked
  game::Mask around;         ///< the smallest rectangle with all of them
  int largest = 0;           ///< difference of a channel, of 255
  bool operator==(const Cause&) const = default;
};

/// In words: "normal (draw_geometry) is the first to differ: 12 pixels in [3, 4, 20, 10], by up to
/// 7 of 255".
std::string text_of(const Cause& cause);

/// Draws the scene at hand in a debug view.
using DrawChannel = std::function<Result<platform::PngImage>(render::DebugView view)>;

/// The file of a channel of a scene in a baseline; for tasks that depend on it, and tests.
std::vector<std::filesystem::path> channel_files(const TestScene& scene, std::string_view driver);

/// Draws all channels and keeps them with the picture that they belong to.
/// @param picture SHA-256 of it. @pre the scene has a baseline. Errors: of drawing and of writing.
Result<void> keep_channels(const TestScene& scene, std::string_view driver,
                           const std::string& picture, const DrawChannel& draw);

/// Whether all channels of a picture are kept.
bool has_channels(const TestScene& scene, std::string_view driver, const std::string& picture);

/// Draws channels in the order of the passes that make them, until one differs from what is kept of
/// the approved picture. None: no baseline, or it keeps none of this picture in this size.
/// @param approved SHA-256 of the approved picture. Errors: of drawing.
Result<std::optional<Cause>> find_cause(const TestScene& scene, std::string_view driver,
                                        const std::string& approved, const DrawChannel& draw);

}  // namespace skerry::tools
