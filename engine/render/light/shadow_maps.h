#pragma once
#include <cstdint>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"
#include "engine/render/light/shadow_plan.h"

namespace skerry::gpu {
class Device;
}

namespace skerry::render {

/// The array of shadow maps. What its layers show is ShadowHistory's to say.
class ShadowMaps {
 public:
  explicit ShadowMaps(gpu::Device& device) : device_(&device) {}

  /// Makes the array as a frame needs it, or frees it if nothing casts. An array with room for sun
  /// and moon stays when one of them sets. Errors: out of memory, and then there is no array.
  Result<void> ensure(const ShadowLayout& layout);
  /// Null when nothing casts.
  gpu::Image* maps() { return maps_ ? &maps_ : nullptr; }
  /// Changes whenever the array is made anew, and with it the contents of all layers is lost.
  std::uint64_t generation() const { return generation_; }

 private:
  gpu::Device* device_;
  gpu::Image maps_;
  ShadowLayout layout_;  // that maps_ was made for
  std::uint64_t generation_ = 0;
};

}  // namespace skerry::render
