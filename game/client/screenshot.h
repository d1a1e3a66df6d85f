#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "game/scene_file/options.h"
#include "game/worlds/gallery.h"

namespace skerry::game {

/// Writes an RGBA8 picture as PNG into the user's screenshot folder, under a name of date and time
/// that no file has yet. The command that draws the scene again is in its text chunk "Command".
/// @param from the same view, of the island that the player is on, if of any.
/// @return the path. Errors: no folder to write to, no memory.
Result<std::filesystem::path> save_screenshot(gpu::Device& device, gpu::Image& picture,
                                              const SceneOptions& scene,
                                              const std::optional<IslandView>& from);

/// "skerry-20250131-235959.png" in `folder`, with "-2", "-3" ... before the ending while such a
/// file exists. @param time_s Unix time, UTC.
std::filesystem::path free_screenshot_path(const std::filesystem::path& folder,
                                           std::int64_t time_s);

}  // namespace skerry::game
