#pragma once
#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace skerry::gpu {

class Device;

/// Who touched a resource last, so that the next barrier is exact. Kept by the frame graph and the
/// uploader.
struct AccessState {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool written =
      false;  ///< the last access wrote; else `stages` are the readers that saw the last write
  std::uint64_t last_value =
      0;  ///< timeline value of the submit that touches it last; 0: never on the GPU
};

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
  bool operator==(const BufferDesc&) const = default;
};

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
    return name == other.name && format == other.format && extent.width == other.extent.width &&
           extent.height == other.extent.height && mips == other.mips && layers == other.layers &&
           usage == other.usage && array == other.array && depth == other.depth;
  }
};

struct SamplerDesc {
  VkFilter mag = VK_FILTER_LINEAR, min = VK_FILTER_LINEAR;
  VkSamplerMipmapMode mip = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  bool compare = false;  ///< depth comparison GREATER_OR_EQUAL (reverse-Z)
  bool operator==(const SamplerDesc&) const = default;
};

/// A move-only buffer with its memory. Usable from construction to destruction; its destructor
/// retires it with the device's timeline.
class Buffer {
 public:
  Buffer() = default;  ///< owns nothing
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    Buffer(std::move(other)).swap(*this);
    return *this;
  }
  ~Buffer();
  VkBuffer handle() const { return handle_; }
  std::uint64_t size_bytes() const { return size_; }
  std::uint64_t allocated_bytes() const { return allocated_; }  ///< device memory it takes
  std::byte* mapped() const { return mapped_; }                 ///< null unless host memory
  const std::string& name() const { return name_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  AccessState state;

 private:
  friend class Device;
  void swap(Buffer& other) noexcept;
  Device* device_ = nullptr;
  VkBuffer handle_{};
  VkDeviceMemory memory_{};
  std::uint64_t size_ = 0, allocated_ = 0;
  std::byte* mapped_ = nullptr;
  std::string name_;
};

/// A move-only 2D image (array) or 3D image with its memory and views. Same life as Buffer.
class Image {
 public:
  Image() = default;
  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(Image&& other) noexcept {
    Image(std::move(other)).swap(*this);
    return *this;
  }
  ~Image();
  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }  ///< all mips and layers
  /// One mip of one layer, 2D: for attachments and storage writes. Created on first use.
  VkImageView view_of(std::uint32_t mip, std::uint32_t layer) const;
  const ImageDesc& desc() const { return desc_; }
  VkImageAspectFlags aspect() const;
  std::uint64_t allocated_bytes() const { return allocated_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  AccessState state;

 private:
  friend class Device;
  void swap(Image& other) noexcept;
  void adopt(Device& device, VkDeviceMemory memory, std::uint64_t allocated, const ImageDesc& desc);
  struct Views;
  Device* device_ = nullptr;
  VkImage handle_{};
  VkImageView view_{};
  VkDeviceMemory memory_{};
  std::uint64_t allocated_ = 0;
  Views* views_ = nullptr;
  ImageDesc desc_;
};

}  // namespace skerry::gpu
