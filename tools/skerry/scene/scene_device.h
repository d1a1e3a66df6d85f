#pragma once
#include <memory>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "game/scene_file/options.h"

namespace skerry::tools {

/// Exit statuses of the command-line contract.
inline constexpr int kDone = 0, kFailed = 1, kUsage = 2, kValidationMessage = 3, kNoDevice = 4;

/// Opens the device a scene asks for, with the user's pipeline cache.
/// @param surface_extensions instance extensions a window needs; empty: headless.
Result<std::unique_ptr<gpu::Device>> open_device(const game::SceneOptions& scene,
                                                 std::vector<const char*> surface_extensions = {});

/// Whether the device can draw a picture of this size; the error is for exit status kUsage.
Result<void> check_size(const gpu::Device& device, const game::PictureSize& size);

/// Prints `skerry: message` on stderr and returns the status.
int fail(int status, const Error& error);

/// kDone, or kValidationMessage when the layer said anything.
int status_after(const gpu::Device& device);

}  // namespace skerry::tools
