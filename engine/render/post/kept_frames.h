#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"
#include "shaders/shared/temporal.h"

namespace skerry::render {

/// What a frame of `aa=temporal` leaves to the next one. Nothing is made before the first.
class KeptFrames {
 public:
  explicit KeptFrames(gpu::Device& device) : device_(&device) {}

  struct Frame {
    gpu::Image surfaces;  ///< R32_UINT, words of the G-buffer
    gpu::Image depth;     ///< D32, reverse-Z
    gpu::Image mixed;     ///< RGBA16F: light of the display, and see mix_frames.comp
  };
  /// Makes the images unless they have their size already. Errors: out of memory.
  Result<void> ensure(VkExtent2D size);
  /// Queues a frame's motions. Errors: out of memory.
  Result<void> upload(gpu::Uploader& uploader, std::span<const shared::Motion> motions);
  /// Two take turns. @pre ensure()
  Frame& of(std::uint32_t frame) { return frames_[frame % 2]; }
  gpu::Buffer& motions() { return motions_; }
  /// Grows whenever images are made anew.
  std::uint64_t generation() const { return generation_; }

 private:
  gpu::Device* device_;
  std::array<Frame, 2> frames_;
  gpu::Buffer motions_;  // texels, room for every island
  std::uint64_t generation_ = 0;
};

}  // namespace skerry::render
