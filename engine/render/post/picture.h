#pragma once
#include <cstdint>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::render {

/// The picture that frames are made for, and the sum of its parts.
class Picture {
 public:
  explicit Picture(gpu::Device& device) : device_(&device) {}

  /// Makes room for a picture, and for the sum of its parts if there are several.
  /// Errors: a size that the device cannot draw; out of memory.
  Result<void> resize(VkExtent2D size, int samples_per_edge, std::uint32_t parts);
  /// RGBA8. @pre resize()
  gpu::Image& image() { return image_; }
  /// RGBA32F, where parts add up; null for a picture in one part.
  gpu::Image* total() { return total_ ? &total_ : nullptr; }

 private:
  Result<void> remake(gpu::Image& image, const gpu::ImageDesc& desc);

  gpu::Device* device_;
  gpu::Image image_;
  gpu::Image total_;  // of a picture's parts; empty when it has one
};

}  // namespace skerry::render
