#pragma once
#include <volk.h>

#include <string>

namespace skerry::gpu {

/// The enumerator's name, e.g. "VK_ERROR_DEVICE_LOST"; "VkResult(n)" for one that is not
/// listed.
std::string result_name(VkResult result);

/// Prints expression, result name, file and line on stderr, then aborts.
[[noreturn]] void gpu_check_failed(const char* expression, VkResult result, const char* file,
                                   int line);

/// For mistakes of the calling code that no result code reports: prints `skerry: text`, then
/// aborts.
[[noreturn]] void gpu_fatal(const std::string& text);

}  // namespace skerry::gpu

/// For Vulkan calls that cannot fail in a correct program on a working device; on in every build.
#define GPU_CHECK(call)                                                              \
  do {                                                                               \
    const VkResult gpu_check_result_ = (call);                                       \
    if (gpu_check_result_ != VK_SUCCESS) {                                           \
      ::skerry::gpu::gpu_check_failed(#call, gpu_check_result_, __FILE__, __LINE__); \
    }                                                                                \
  } while (false)
