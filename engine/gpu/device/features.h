#pragma once
#include <volk.h>

#include <optional>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device_info.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {

/// The chain of feature structs that Skerry asks of a device. Not copyable: the members point at
/// each other.
struct FeatureChain {
  FeatureChain();
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
  VkPhysicalDeviceFeatures2 core =
      vk_struct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
  VkPhysicalDeviceVulkan11Features v11 = vk_struct<VkPhysicalDeviceVulkan11Features>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
  VkPhysicalDeviceVulkan12Features v12 = vk_struct<VkPhysicalDeviceVulkan12Features>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
  VkPhysicalDeviceVulkan13Features v13 = vk_struct<VkPhysicalDeviceVulkan13Features>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
};

/// Switches on exactly the required features.
void require_features(FeatureChain& chain);

/// The queue family that does graphics and compute, or ~0u.
std::uint32_t find_queue_family(VkPhysicalDevice device);

/// Reads a device's name, driver and what of the feature floor it lacks. @param surface needs
/// VK_KHR_swapchain too.
DeviceInfo describe_device(VkPhysicalDevice device, std::uint32_t index, bool surface);

DeviceLimits read_limits(VkPhysicalDevice device);

/// Index of the best usable device (discrete, integrated, virtual, CPU; the loader's order among
/// equals), or the one asked for. Errors name what is missing.
Result<std::uint32_t> choose_device(const std::vector<DeviceInfo>& devices,
                                    std::optional<std::uint32_t> wanted);

}  // namespace skerry::gpu
