#pragma once
#include <volk.h>

#include <cstdint>
#include <string>
#include <vector>

namespace skerry::gpu {

/// What a physical device is and whether Skerry can use it.
struct DeviceInfo {
  std::uint32_t index = 0;  ///< position in the loader's list; what --device takes
  std::string name;
  std::string driver;                ///< driver name and version text
  std::uint32_t driver_version = 0;  ///< vendor's packing
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t api_version = 0;
  std::vector<std::string> missing;  ///< required features and extensions it lacks; empty: usable
};

/// Limits the renderer plans with.
struct DeviceLimits {
  std::uint64_t max_buffer_bytes = 0;   ///< of any buffer
  std::uint64_t max_storage_range = 0;  ///< bytes one storage buffer binding may cover
  std::uint64_t max_texels = 0;         ///< of a buffer that shaders fetch texels of
  std::uint32_t max_image_edge = 0;     ///< pixels, 2D
  std::uint32_t max_volume_edge = 0;    ///< texels, 3D
  std::uint32_t max_draw_count = 0;     ///< of an indirect draw
  std::uint64_t heap_bytes = 0;         ///< of the largest heap of the device's own memory
  float timestamp_period_ns = 0.0f;     ///< 0: the queue cannot measure
  bool sums_floats = false;             ///< drawn colours can be added to RGBA32F images
};

}  // namespace skerry::gpu
