#pragma once
#include <volk.h>

#include <memory>
#include <span>
#include <vector>

#include "engine/core/result.h"

namespace skerry::gpu {

/// What the Khronos validation layer checks: nothing, synchronisation, or core and synchronisation.
enum class Validation { kOff, kSynchronization, kFull };

/// A Vulkan instance, with the validation layer and its message counter when asked for.
/// Functions are loaded through the instance (loader trampolines), so several devices can live in
/// one process.
class Instance {
 public:
  /// Errors: no Vulkan loader or driver, version below 1.3, a missing surface extension or
  /// validation layer.
  static Result<Instance> create(Validation validation,
                                 std::span<const char* const> surface_extensions);
  Instance(Instance&& other) noexcept;
  Instance& operator=(Instance&&) = delete;
  ~Instance();

  VkInstance handle() const { return handle_; }
  int message_count() const;
  /// All physical devices in the loader's order.
  Result<std::vector<VkPhysicalDevice>> devices() const;

 private:
  struct Messages;
  Instance() = default;
  static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                       VkDebugUtilsMessageTypeFlagsEXT types,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data,
                                       void* user);
  VkDebugUtilsMessengerCreateInfoEXT messenger_info() const;
  VkInstance handle_{};
  VkDebugUtilsMessengerEXT messenger_{};
  std::unique_ptr<Messages> messages_;
};

}  // namespace skerry::gpu
