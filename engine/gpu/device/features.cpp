#include "engine/gpu/device/features.h"
#include "engine/gpu/device/vk_struct.h"

#include <array>
#include <cstring>

namespace skerry::gpu {
namespace {

/// Descriptor bindings a pipeline may have: the size of the table in Commands, and what lavapipe
/// and every desktop driver offer.
constexpr std::uint32_t kPushDescriptors = 32;
constexpr std::uint32_t kPushConstantBytes = 128;

struct Requirement {
  const char* name;
  VkBool32& (*field)(FeatureChain&);
};

// The feature floor, once: for checking, for naming what lacks, and for switching on.
#define SKERRY_NEED(part, feature)                                         \
  Requirement {                                                            \
#feature, [](FeatureChain & c) -> VkBool32& { return c.part.feature; } \
  }
const std::array kRequirements = {
    SKERRY_NEED(core.features, multiDrawIndirect),
    SKERRY_NEED(core.features, drawIndirectFirstInstance),
    SKERRY_NEED(core.features, depthClamp),
    SKERRY_NEED(core.features, fragmentStoresAndAtomics),
    SKERRY_NEED(core.features, independentBlend),
    SKERRY_NEED(core.features, shaderStorageImageExtendedFormats),
    SKERRY_NEED(core.features, shaderStorageImageWriteWithoutFormat),
    SKERRY_NEED(v11, shaderDrawParameters),
    SKERRY_NEED(v12, drawIndirectCount),
    SKERRY_NEED(v12, scalarBlockLayout),
    SKERRY_NEED(v13,
                maintenance4),  // a fragment shader need not take all that the vertex shader gives
    SKERRY_NEED(v12, timelineSemaphore),
    SKERRY_NEED(v13, dynamicRendering),
    SKERRY_NEED(v13, synchronization2),
};
#undef SKERRY_NEED

bool has_extension(VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> list(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, list.data());
  for (const VkExtensionProperties& extension : list) {
    if (std::strcmp(extension.extensionName, name) == 0) return true;
  }
  return false;
}

void find_missing_features(VkPhysicalDevice device, std::vector<std::string>& missing) {
  FeatureChain chain;
  vkGetPhysicalDeviceFeatures2(device, &chain.core);
  for (const Requirement& requirement : kRequirements) {
    if (!requirement.field(chain)) missing.emplace_back(requirement.name);
  }
}

void find_missing_extensions(VkPhysicalDevice device, bool surface,
                             std::vector<std::string>& missing) {
  if (surface && !has_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
    missing.emplace_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  }
  if (!has_extension(device, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) {
    missing.emplace_back(VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    return;
  }
  auto subgroup = vk_struct<VkPhysicalDeviceSubgroupProperties>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES);
  auto push = vk_struct<VkPhysicalDevicePushDescriptorPropertiesKHR>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR, &subgroup);
  auto properties =
      vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &push);
  vkGetPhysicalDeviceProperties2(device, &properties);
  if ((subgroup.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) == 0 ||
      (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) == 0) {
    missing.emplace_back("subgroup arithmetic in compute shaders");
  }
  if (push.maxPushDescriptors < kPushDescriptors) missing.emplace_back("maxPushDescriptors >= 32");
  if (properties.properties.limits.maxPushConstantsSize < kPushConstantBytes) {
    missing.emplace_back("maxPushConstantsSize >= 128");
  }
}

bool has_timestamps(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  const std::uint32_t ours = find_queue_family(device);
  return ours < count && families[ours].timestampValidBits > 0;
}

int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 3;
    default:
      return 4;
  }
}

std::string missing_text(const DeviceInfo& device) {
  std::string text;
  for (const std::string& name : device.missing) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

FeatureChain::FeatureChain() {
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
}

void require_features(FeatureChain& chain) {
  for (const Requirement& requirement : kRequirements) requirement.field(chain) = VK_TRUE;
}

std::uint32_t find_queue_family(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((families[i].queueFlags & kNeeded) == kNeeded) return i;
  }
  return ~0u;
}

DeviceInfo describe_device(VkPhysicalDevice device, std::uint32_t index, bool surface) {
  VkPhysicalDeviceProperties basic{};
  vkGetPhysicalDeviceProperties(device, &basic);
  DeviceInfo info;
  info.index = index;
  info.name = basic.deviceName;
  info.driver_version = basic.driverVersion;
  info.type = basic.deviceType;
  info.api_version = basic.apiVersion;
  // Below 1.3 the feature structs themselves are unknown to the driver.
  if (basic.apiVersion < VK_API_VERSION_1_3) {
    info.missing.emplace_back("Vulkan 1.3");
    return info;
  }
  auto driver = vk_struct<VkPhysicalDeviceDriverProperties>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
  auto properties = vk_struct<VkPhysicalDeviceProperties2>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver);
  vkGetPhysicalDeviceProperties2(device, &properties);
  info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  find_missing_features(device, info.missing);
  find_missing_extensions(device, surface, info.missing);
  if (find_queue_family(device) == ~0u)
    info.missing.emplace_back("a queue with graphics and compute");
  return info;
}

DeviceLimits read_limits(VkPhysicalDevice device) {
  auto core = vk_struct<VkPhysicalDeviceVulkan13Properties>(
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES);
  auto properties =
      vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &core);
  vkGetPhysicalDeviceProperties2(device, &properties);
  const VkPhysicalDeviceLimits& limits = properties.properties.limits;
  DeviceLimits out;
  out.max_buffer_bytes = core.maxBufferSize;
  out.max_storage_range = limits.maxStorageBufferRange;
  out.max_texels = limits.maxTexelBufferElements;
  out.max_image_edge = limits.maxImageDimension2D;
  out.max_volume_edge = limits.maxImageDimension3D;
  out.max_draw_count = limits.maxDrawIndirectCount;
  VkFormatProperties floats{};
  vkGetPhysicalDeviceFormatProperties(device, VK_FORMAT_R32G32B32A32_SFLOAT, &floats);
  out.sums_floats =
      (floats.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
      out.heap_bytes = std::max<std::uint64_t>(out.heap_bytes, memory.memoryHeaps[i].size);
  out.timestamp_period_ns = has_timestamps(device) ? limits.timestampPeriod : 0.0f;
  return out;
}

Result<std::uint32_t> choose_device(const std::vector<DeviceInfo>& devices,
                                    std::optional<std::uint32_t> wanted) {
  if (wanted) {
    if (*wanted >= devices.size()) {
      return Error{"there is no Vulkan device " + std::to_string(*wanted) + ": this machine has " +
                   std::to_string(devices.size()) + "; `skerry devices` lists them"};
    }
    const DeviceInfo& device = devices[*wanted];
    if (!device.missing.empty()) {
      return Error{"Vulkan device " + std::to_string(*wanted) + " (" + device.name +
                   ") cannot be used: it lacks " + missing_text(device) +
                   "; `skerry devices` lists the others"};
    }
    return *wanted;
  }
  const DeviceInfo* best = nullptr;
  for (const DeviceInfo& device : devices) {
    if (device.missing.empty() && (!best || rank(device.type) < rank(best->type))) best = &device;
  }
  if (best) return best->index;
  std::string text = "no usable Vulkan device:";
  for (const DeviceInfo& device : devices)
    text += " " + device.name + " lacks " + missing_text(device) + ";";
  return Error{text + " update the driver, or install mesa-vulkan-drivers for a software device"};
}

}  // namespace skerry::gpu
