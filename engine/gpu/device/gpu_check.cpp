#include "engine/gpu/device/gpu_check.h"

#include <cstdlib>

#include "engine/core/log.h"

namespace skerry::gpu {

std::string result_name(VkResult result) {
  switch (result) {
#define SKERRY_NAME(name) \
  case name:              \
    return #name
    SKERRY_NAME(VK_SUCCESS);
    SKERRY_NAME(VK_NOT_READY);
    SKERRY_NAME(VK_TIMEOUT);
    SKERRY_NAME(VK_EVENT_SET);
    SKERRY_NAME(VK_EVENT_RESET);
    SKERRY_NAME(VK_INCOMPLETE);
    SKERRY_NAME(VK_SUBOPTIMAL_KHR);
    SKERRY_NAME(VK_ERROR_OUT_OF_HOST_MEMORY);
    SKERRY_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY);
    SKERRY_NAME(VK_ERROR_INITIALIZATION_FAILED);
    SKERRY_NAME(VK_ERROR_DEVICE_LOST);
    SKERRY_NAME(VK_ERROR_MEMORY_MAP_FAILED);
    SKERRY_NAME(VK_ERROR_LAYER_NOT_PRESENT);
    SKERRY_NAME(VK_ERROR_EXTENSION_NOT_PRESENT);
    SKERRY_NAME(VK_ERROR_FEATURE_NOT_PRESENT);
    SKERRY_NAME(VK_ERROR_INCOMPATIBLE_DRIVER);
    SKERRY_NAME(VK_ERROR_TOO_MANY_OBJECTS);
    SKERRY_NAME(VK_ERROR_FORMAT_NOT_SUPPORTED);
    SKERRY_NAME(VK_ERROR_FRAGMENTED_POOL);
    SKERRY_NAME(VK_ERROR_OUT_OF_POOL_MEMORY);
    SKERRY_NAME(VK_ERROR_INVALID_EXTERNAL_HANDLE);
    SKERRY_NAME(VK_ERROR_FRAGMENTATION);
    SKERRY_NAME(VK_ERROR_SURFACE_LOST_KHR);
    SKERRY_NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
    SKERRY_NAME(VK_ERROR_OUT_OF_DATE_KHR);
    SKERRY_NAME(VK_ERROR_VALIDATION_FAILED_EXT);
    SKERRY_NAME(VK_ERROR_INVALID_SHADER_NV);
    SKERRY_NAME(VK_ERROR_UNKNOWN);
#undef SKERRY_NAME
    default:
      return "VkResult(" + std::to_string(static_cast<int>(result)) + ")";
  }
}

void gpu_check_failed(const char* expression, VkResult result, const char* file, int line) {
  gpu_fatal(std::string(expression) + " returned " + result_name(result) + " at " + file + ":" +
            std::to_string(line));
}

void gpu_fatal(const std::string& text) {
  log_error(text);
  std::abort();
}

}  // namespace skerry::gpu
