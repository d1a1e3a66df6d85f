#pragma once
#include <volk.h>

#include <cstdint>
#include <string>

namespace skerry::gpu {

enum class Memory : std::uint8_t {
  kDevice,    ///< fastest for the GPU, not mapped
  kUpload,    ///< mapped, coherent, written by the CPU
  kReadback,  ///< mapped, coherent, cached where possible, read by the CPU
  kMapped,    ///< device-local and mapped (ReBAR, or a CPU device); falls back to kUpload's type
};

struct BufferDesc {
  std::string name;
  std::uint64_t size_bytes = 0;
  VkBufferUsageFlags usage = 0;
  Memory memory = Memory::kDevice;
  bool texels = false;  ///< shaders fetch texels of it, RGBA32_UINT; wants the usage for that
  bool operator==(const BufferDesc&) const = default;
};

constexpr bool same_size(VkExtent2D a, VkExtent2D b) {
  return a.width == b.width && a.height == b.height;
}

struct ImageDesc {
  std::string name;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkExtent2D extent{};
  std::uint32_t mips = 1;
  std::uint32_t layers = 1;
  VkImageUsageFlags usage = 0;
  bool array = false;       ///< view as an array even with one layer
  std::uint32_t depth = 0;  ///< texels; not 0: a 3D image, of one layer
  bool operator==(const ImageDesc& other) const {
    return name == other.name && format == other.format && same_size(extent, other.extent) &&
           mips == other.mips && layers == other.layers && usage == other.usage &&
           array == other.array && depth == other.depth;
  }
};

struct SamplerDesc {
  VkFilter mag = VK_FILTER_LINEAR, min = VK_FILTER_LINEAR;
  VkSamplerMipmapMode mip = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  bool compare = false;  ///< depth comparison GREATER_OR_EQUAL (reverse-Z)
  bool operator==(const SamplerDesc&) const = default;
};

}  // namespace skerry::gpu
