#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/render/frame/fixed_pos.h"
#include "shaders/shared/clouds.h"

namespace skerry::render {

/// 8^3 samples, index z + 8 * y + 64 * x; `values` must outlive what is made of it.
struct CloudBrick {
  glm::ivec3 origin{0};  ///< of the first sample [index], a multiple of 8
  const float* values = nullptr;
};

/// A cube of samples of one value.
struct CloudTile {
  glm::ivec3 origin{0};  ///< a multiple of edge
  int edge = 8;          ///< samples, a multiple of 8
  float value = 0.0f;
};

enum class CloudRole : std::uint8_t { kDensity, kEmission };

/// A sparse grid that is drawn as a cloud. Between samples, which lie at whole indices, it is
/// trilinear; beyond bricks and tiles it is 0, and so is what is negative.
struct CloudVolumeDesc {
  FixedPos origin{};                  ///< that blocks_from_index is relative to
  glm::dmat4 blocks_from_index{1.0};  ///< affine, invertible
  CloudRole role = CloudRole::kDensity;
  std::vector<CloudBrick> bricks;
  std::vector<CloudTile> tiles;
};

}  // namespace skerry::render
