#include "tools/skerry/devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "engine/gpu/device/device.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

std::string_view type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

std::string api_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

void print_text(const std::vector<gpu::DeviceInfo>& list) {
  for (const gpu::DeviceInfo& device : list) {
    fmt::print("{}  {} ({}, Vulkan {}, {}): {}\n", device.index, device.name,
               type_name(device.type), api_text(device.api_version), device.driver,
               device.missing.empty() ? std::string("usable")
                                      : fmt::format("lacks {}", fmt::join(device.missing, ", ")));
  }
}

void print_json(const std::vector<gpu::DeviceInfo>& list) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const gpu::DeviceInfo& device : list) {
    rows.push_back({{"index", device.index},
                    {"name", device.name},
                    {"type", type_name(device.type)},
                    {"driver", device.driver},
                    {"api_version", api_text(device.api_version)},
                    {"usable", device.missing.empty()},
                    {"missing", device.missing}});
  }
  // Names come from drivers: bytes that are not UTF-8 are replaced rather than refused.
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  fmt::print("{}\n", nlohmann::ordered_json{{"devices", rows}}.dump(2, ' ', false, replace));
}

}  // namespace

int devices(bool json) {
  const Result<std::vector<gpu::DeviceInfo>> list = gpu::Device::list();
  if (!list) return fail(kNoDevice, list.error());
  if (json) {
    print_json(*list);
  } else {
    print_text(*list);
  }
  const bool usable =
      std::any_of(list->begin(), list->end(), [](const auto& d) { return d.missing.empty(); });
  if (usable) return kDone;
  return fail(
      kNoDevice,
      {"no Vulkan device can be used: each lacks what is listed above; install a newer driver, or "
       "mesa-vulkan-drivers for the CPU"});
}

}  // namespace skerry::tools
