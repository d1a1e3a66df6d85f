#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "shaders/shared/geometry.h"

namespace skerry::render {

/// A box in a section's voxels, 0..64 along each axis.
struct VoxelBox {
  std::uint32_t low = 0, high = 0;  ///< packed like shared::Section::bounds_min and bounds_max

  glm::vec3 low_corner() const { return unpacked(low); }
  glm::vec3 high_corner() const { return unpacked(high); }

 private:
  static glm::vec3 unpacked(std::uint32_t packed) {
    return {packed & 127u, (packed >> 7) & 127u, (packed >> 14) & 127u};
  }
};

/// Of a section's quads of glass.
struct GlassBox {
  VoxelBox box;
  bool stained = false;  ///< some are
};

/// The tight box of faces. @param quads not empty.
VoxelBox box_of(std::span<const shared::Quad> quads);

}  // namespace skerry::render
