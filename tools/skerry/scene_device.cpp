#include "tools/skerry/scene_device.h"

#include <cstdio>

#include "engine/platform/files.h"

namespace skerry::tools {

Result<std::unique_ptr<gpu::Device>> open_device(const game::SceneOptions& scene) {
  gpu::DeviceOptions options;
  options.index = scene.device;
  options.validate = scene.validate;
  options.pipeline_cache_path = (platform::cache_directory() / "pipelines.bin").string();
  return gpu::Device::create(options);
}

int fail(int status, const Error& error) {
  std::fprintf(stderr, "skerry: %s\n", error.message.c_str());
  return status;
}

int status_after(const gpu::Device& device) {
  const int count = device.validation_message_count();
  if (count == 0) return kDone;
  return fail(kValidationMessage, {std::to_string(count) + " validation messages were printed above; this is a bug in Skerry or the driver"});
}

}  // namespace skerry::tools
