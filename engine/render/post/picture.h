#pragma once
#include <cstdint>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::render {

/// The picture that frames are made for, at the sizes at which it is drawn and shown, and the sum
/// of its parts.
class Picture {
 public:
  explicit Picture(gpu::Device& device) : device_(&device) {}

  struct Sizes {
    VkExtent2D shown, drawn;  ///< [pixels]; equal, or `drawn` is smaller
    bool mixed = false;       ///< with pictures of earlier frames
  };
  /// Makes room for a picture, and for the sum of its parts if there are several.
  /// Errors: a size that the device cannot draw; out of memory.
  Result<void> resize(const Sizes& sizes, int samples_per_edge, std::uint32_t parts);
  /// RGBA8, as drawn. @pre resize()
  gpu::Image& image() { return image_; }
  /// RGBA8, what a frame makes by itself: the picture, unless that is `mixed` from it and earlier
  /// ones. @pre resize(), for pictures that are mixed if this one is
  gpu::Image& fresh(bool mixed) { return mixed ? fresh_ : image_; }
  /// RGBA8, as shown: the same image unless it is enlarged. @pre resize()
  gpu::Image& shown() { return enlarged_ ? enlarged_ : image_; }
  /// RGBA32F, where parts add up; null for a picture in one part.
  gpu::Image* total() { return total_ ? &total_ : nullptr; }

 private:
  Result<void> remake(gpu::Image& image, const gpu::ImageDesc& desc);

  gpu::Device* device_;
  gpu::Image image_;
  gpu::Image fresh_;     // empty: pictures are not mixed
  gpu::Image enlarged_;  // empty: the picture is shown as it is drawn
  gpu::Image total_;     // of a picture's parts; empty when it has one
};

}  // namespace skerry::render
