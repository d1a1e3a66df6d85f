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

/// What a file of save_pipeline_cache() holds, if it is whole and fits the device, else none. A
/// missing file is normal; a damaged or foreign one is worth a log line.
std::vector<std::byte> load_pipeline_cache(const std::string& path,
                                           const VkPhysicalDeviceProperties& device);

/// Writes 8 bytes of magic, a checksum of what follows (64 bits, little-endian) and the bytes.
/// Failure is only logged: the next start compiles again.
void save_pipeline_cache(const std::string& path, std::span<const std::byte> bytes);

}  // namespace skerry::gpu
