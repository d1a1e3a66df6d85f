#pragma once
#include <volk.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace skerry::gpu {

/// Whether cached bytes start with a whole, known header made by exactly this device and driver.
/// Drivers are not required to survive anything else.
bool pipeline_cache_fits(std::span<const std::byte> bytes,
                         const VkPhysicalDeviceProperties& device);

/// The file's bytes if they fit, else none. A missing file is normal; a damaged or foreign one is
/// worth a log line.
std::vector<std::byte> load_pipeline_cache(const std::string& path,
                                           const VkPhysicalDeviceProperties& device);

/// Writes to a temporary name, then renames. Failure is only logged: the next start compiles again.
void save_pipeline_cache(const std::string& path, std::span<const std::byte> bytes);

}  // namespace skerry::gpu
