#pragma once
#include <volk.h>

#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/platform/window.h"
#include "game/scene_file/options.h"

namespace skerry::game {

/// The main loop: plays in a window until it is closed. Keys: docs/controls.md.
/// @param notes shown to the player on the screen to begin with, each in one line.
/// @param at_title begins with the title, else in the options' world.
/// @param surface of the window, made with the device's instance; the caller destroys it
/// afterwards. Errors: the device cannot present to the window, or runs out of memory.
Result<void> play(platform::Window& window, gpu::Device& device, VkSurfaceKHR surface,
                  const SceneOptions& options, bool at_title,
                  const std::vector<std::string>& notes);

}  // namespace skerry::game
