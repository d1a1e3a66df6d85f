#include "world/light/body_rays.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "world/light/base/face_records.h"
#include "world/light/base/sky_rays.h"
#include "world/light/glass_tints.h"

namespace skerry::world {
namespace {

constexpr int kPlacesAlong = 3;  // of a face

}  // namespace

BodyRays::BodyRays(const AirVolume& air, const glm::vec3& to_body)
    : air_(air), to_body_(to_body), step_(std::numeric_limits<float>::infinity()), bits_(0) {
  for (int axis = 0; axis < 3; ++axis) {
    if (to_body[axis] != 0.0f) step_[axis] = 1.0f / std::abs(to_body[axis]);
    if (step_[axis] < step_[most_]) most_ = axis;
    bits_[axis] = air.opaque.bit_step(axis_vector(axis, to_body[axis] < 0.0f ? -1 : 1));
  }
}

/// Whether leaves or a plant do.
bool BodyRays::stops(std::ptrdiff_t bit, IVec3 voxel, int ray) const {
  const int set = ray % kLeafSets, word = static_cast<int>(floor_div(voxel.z, 64));
  const auto mask = std::uint64_t{1} << (voxel.z & 63);
  if (air_.leaves.bit(bit) && (leaves_that_stop(set, voxel.x, voxel.y, word) & mask) != 0)
    return true;
  return air_.plants.bit(bit) && (plants_that_stop(set, voxel.x, voxel.y, word) & mask) != 0;
}

/// What is left of the light. @param voxel that the place is in, which stops nothing itself.
glm::vec3 BodyRays::along(glm::vec3 from, IVec3 voxel, int ray) const {
  const VoxelBits& opaque = air_.opaque;
  glm::vec3 next;  // where the line meets the next plane of each axis
  glm::ivec3 at = vector_of(voxel);
  const glm::ivec3 low = vector_of(opaque.low()), size = vector_of(opaque.size());
  for (int axis = 0; axis < 3; ++axis) {
    const float to_plane = to_body_[axis] < 0.0f ? from[axis] - static_cast<float>(at[axis])
                                                 : static_cast<float>(at[axis] + 1) - from[axis];
    next[axis] = to_body_[axis] == 0.0f ? step_[axis] : to_plane * step_[axis];
  }
  std::ptrdiff_t bit = opaque.bit_at(voxel);
  const bool stained = !air_.stained.empty();
  glm::vec3 left(1.0f);
  for (float passed = 0.0f;;) {
    const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : next.y <= next.z ? 1 : 2;
    if (stained && air_.stained.voxels().bit(bit))
      left *= left_by_glass(air_.stained.block(bit),
                            (next[axis] - passed) * air_.stained.voxel_blocks());
    passed = next[axis];
    next[axis] += step_[axis];
    at[axis] += to_body_[axis] < 0.0f ? -1 : 1;
    if (static_cast<unsigned>(at[axis] - low[axis]) >= static_cast<unsigned>(size[axis]))
      return left;
    bit += bits_[axis];
    if (opaque.bit(bit)) return glm::vec3(0.0f);
    if (air_.has_leaves && stops(bit, {at.x, at.y, at.z}, ray)) return glm::vec3(0.0f);
  }
}

glm::vec3 BodyRays::on_face(IVec3 front, int face) const {
  const FaceAxes axes(face);
  const float cosine = to_body_[axes.own] * static_cast<float>(axes.sign);
  if (cosine <= 0.0f) return glm::vec3(0.0f);
  glm::vec3 sum(0.0f);
  for (int ray = 0; ray < kPlacesAlong * kPlacesAlong; ++ray) {
    const auto part = [](int i) { return (static_cast<float>(i) + 0.5f) / float{kPlacesAlong}; };
    glm::vec3 from = glm::vec3(vector_of(front));
    from[axes.own] += axes.sign < 0 ? 1.0f : 0.0f;
    from[axes.b] += part(ray % kPlacesAlong);
    from[axes.c] += part(ray / kPlacesAlong);
    sum += along(from, front, ray);
  }
  return sum * (cosine / float{kPlacesAlong * kPlacesAlong});
}

}  // namespace skerry::world
