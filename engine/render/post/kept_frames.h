#pragma once
#include <cstdint>
#include <span>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/uploader.h"
#include "shaders/shared/temporal.h"

namespace skerry::render {

/// What frames of `aa=temporal` leave to the next ones. Nothing is made before the first.
class KeptFrames {
 public:
  explicit KeptFrames(gpu::Device& device) : device_(&device) {}

  /// Makes the images unless they have their size already. Errors: out of memory.
  Result<void> ensure(VkExtent2D size);
  /// Queues a frame's motions. Errors: out of memory.
  Result<void> upload(gpu::Uploader& uploader, std::span<const shared::Motion> motions);
  /// Pictures, RGBA8 as R32_UINT, a layer a slot. @pre ensure()
  gpu::Image& pictures() { return pictures_; }
  /// Which surfaces they show, R32_UINT, see kept_key(), likewise. @pre ensure()
  gpu::Image& keys() { return keys_; }
  gpu::Buffer& motions() { return motions_; }
  /// Grows whenever images are made anew.
  std::uint64_t generation() const { return generation_; }

 private:
  gpu::Device* device_;
  VkExtent2D size_{};
  gpu::Image pictures_, keys_;
  gpu::Buffer motions_;  // texels, room for every island
  std::uint64_t generation_ = 0;
};

}  // namespace skerry::render
