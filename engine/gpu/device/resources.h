#pragma once
#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "engine/gpu/device/resource_desc.h"

namespace skerry::gpu {

class Device;

/// Whoever made a resource: destroys it once the GPU no longer uses it.
class ResourceOwner {
 public:
  virtual VkDevice handle() const = 0;
  /// Called by resources when they die: destroyed after every submit made so far (and the one being
  /// recorded) has completed.
  virtual void retire(std::uint64_t object, VkObjectType type, VkDeviceMemory memory,
                      std::uint64_t bytes, const std::string& name) = 0;
  virtual void set_name(std::uint64_t object, VkObjectType type, const char* name) = 0;

 protected:
  ~ResourceOwner() = default;
};

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
  VkBufferView texels() const { return texels_; }               ///< null unless asked for
  const std::string& name() const { return name_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  AccessState state;

 private:
  friend class Device;
  void swap(Buffer& other) noexcept;
  ResourceOwner* owner_ = nullptr;
  VkBuffer handle_{};
  VkBufferView texels_{};
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
  void adopt(ResourceOwner& owner, VkDeviceMemory memory, std::uint64_t allocated,
             const ImageDesc& desc);
  struct Views;
  ResourceOwner* owner_ = nullptr;
  VkImage handle_{};
  VkImageView view_{};
  VkDeviceMemory memory_{};
  std::uint64_t allocated_ = 0;
  Views* views_ = nullptr;
  ImageDesc desc_;
};

}  // namespace skerry::gpu
