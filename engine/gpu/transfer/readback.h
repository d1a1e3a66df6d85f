#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {

class Device;

/// Copies bytes out of a buffer and waits for them. For pictures and tests, not for frames. The
/// buffer needs the usage TRANSFER_SRC. Errors: out of memory.
Result<std::vector<std::byte>> read_back(Device& device, Buffer& from, std::uint64_t offset_bytes,
                                         std::uint64_t size_bytes);

/// Copies one mip of one layer, rows tightly packed, and waits. The image needs the usage
/// TRANSFER_SRC.
/// @param texel_bytes size of a texel of its format.
Result<std::vector<std::byte>> read_back(Device& device, Image& from, std::uint32_t texel_bytes,
                                         std::uint32_t mip = 0, std::uint32_t layer = 0);

}  // namespace skerry::gpu
