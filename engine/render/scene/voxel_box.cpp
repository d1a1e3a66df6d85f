#include "engine/render/scene/voxel_box.h"

#include <glm/common.hpp>

#include "engine/core/check.h"

namespace skerry::render {
namespace {

std::uint32_t packed(const glm::uvec3& corner) {
  return corner.x | corner.y << 7 | corner.z << 14;
}

/// Axes that a face's u and v run along, as in shaders/scene/draw_quads.vert.
glm::uvec2 axes_of_plane(std::uint32_t axis) {
  return axis == 0 ? glm::uvec2(2, 1) : axis == 1 ? glm::uvec2(0, 2) : glm::uvec2(0, 1);
}

}  // namespace

VoxelBox box_of(std::span<const shared::Quad> quads) {
  SKERRY_ASSERT(!quads.empty());
  glm::uvec3 low(64), high(0);
  for (const shared::Quad& quad : quads) {
    const std::uint32_t face = shared::surface_face(quad.material), axis = face / 2;
    glm::uvec3 first(quad.geometry & 63u, quad.geometry >> 6 & 63u, quad.geometry >> 12 & 63u);
    const bool plant = face >= shared::kFaceCount;  // from corner to corner of its voxel
    if (!plant && face % 2 == 0) ++first[static_cast<int>(axis)];
    glm::uvec3 last = first;
    if (plant) {
      low = glm::min(low, first);
      high = glm::max(high, first + 1u);
      continue;
    }
    const glm::uvec2 plane = axes_of_plane(axis);
    last[static_cast<int>(plane.x)] += (quad.geometry >> 18 & 63u) + 1;
    last[static_cast<int>(plane.y)] += (quad.geometry >> 24 & 63u) + 1;
    low = glm::min(low, first);
    high = glm::max(high, last);
  }
  return {packed(low), packed(high)};
}

}  // namespace skerry::render
