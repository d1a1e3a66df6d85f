#include "tools/skerry/scene/scene_device.h"

#include <fmt/format.h>

#include <utility>

#include "engine/core/log.h"
#include "engine/platform/files.h"

namespace skerry::tools {
namespace {

/// Empty, for none, when the user has no folder for caches.
std::string pipeline_cache_file() {
  const std::filesystem::path folder = platform::cache_dir();
  if (folder.empty()) return {};
  if (const Result<void> made = platform::make_dirs(folder); !made) {
    log_warning("compiled shaders are not kept: " + made.error().message);
    return {};
  }
  return (folder / "pipelines.bin").string();
}

}  // namespace

Result<std::unique_ptr<gpu::Device>> open_device(const game::SceneOptions& scene,
                                                 std::vector<const char*> surface_extensions) {
  gpu::DeviceOptions options;
  options.surface_extensions = std::move(surface_extensions);
  options.index = scene.device;
  options.validate = scene.validate;
  options.pipeline_cache_path = pipeline_cache_file();
  return gpu::Device::create(options);
}

Result<void> check_size(const gpu::Device& device, const game::PictureSize& size) {
  const std::uint32_t most = device.limits().max_image_edge;
  if (size.width <= most && size.height <= most) return {};
  return Error{fmt::format(
      "--size {}x{} is too large: {} takes up to {} pixels along an edge; choose a smaller size",
      size.width, size.height, device.info().name, most)};
}

int fail(int status, const Error& error) {
  log_error(error.message);
  return status;
}

int status_after(const gpu::Device& device) {
  const int count = device.validation_message_count();
  if (count == 0) return kDone;
  return fail(kValidationMessage,
              {std::to_string(count) +
               " validation messages were printed above; this is a bug in Skerry or the driver"});
}

}  // namespace skerry::tools
