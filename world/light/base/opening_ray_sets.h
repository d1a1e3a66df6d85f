#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/indirect.h"
#include "world/voxel/coords.h"

namespace skerry::world {

/// The directions of OpeningRays and the ways that they take through voxels. Rays begin in the
/// middle of a face of a voxel, and the order in which one crosses planes between voxels is the
/// same from all faces of its set.
struct OpeningRay {
  /// Planes whose order is kept; beyond, it is worked out anew.
  static constexpr std::size_t kKeptPlanes = 512;
  static constexpr std::size_t kPlanesAWord = 32;

  std::array<float, 3> first{}, every{};  ///< length up to the first plane across an axis; then
  std::array<int, 3> step{};
  /// Two bits a plane, the first lowest: its axis.
  std::array<std::uint64_t, kKeptPlanes / kPlanesAWord> planes{};
};

/// Where a ray crosses planes, one after the other.
class RayCrossings {
 public:
  explicit RayCrossings(const OpeningRay& ray) : ray_(ray), next_(ray.first) {}
  /// Of the next plane.
  std::size_t axis() const {
    const std::size_t near = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[near] ? 2 : near;
  }
  float length() const { return next_[axis()]; }
  void pass() {
    const std::size_t axis = this->axis();
    next_[axis] += ray_.every[axis];
  }

 private:
  const OpeningRay& ray_;
  std::array<float, 3> next_;
};

/// Calls fn(axis) for each plane that a ray crosses, one after the other, until it returns false.
/// @param first how many are left out, a multiple of kPlanesAWord, kKeptPlanes at most.
template <class Fn>
void for_each_plane(const OpeningRay& ray, std::size_t first, const Fn& fn) {
  for (std::size_t word = first / OpeningRay::kPlanesAWord; word < ray.planes.size(); ++word) {
    std::uint64_t planes = ray.planes[word];
    for (std::size_t i = 0; i < OpeningRay::kPlanesAWord; ++i, planes >>= 2)
      if (!fn(static_cast<std::size_t>(planes & 3))) return;
  }
  RayCrossings crossings(ray);
  for (std::size_t i = 0; i < OpeningRay::kKeptPlanes; ++i) crossings.pass();
  for (; fn(crossings.axis()); crossings.pass()) {
  }
}

struct OpeningRaySet {
  static constexpr std::size_t kRays = 64;
  static constexpr int kSets = 8;  ///< of a face direction
  /// Planes after which it is kept where a ray has come.
  static constexpr std::size_t kCountedPlanes = 256;
  using Steps = std::array<std::uint8_t, 3>;  ///< voxels along each axis

  /// Whether coordinates are odd: a bit for each axis.
  static std::size_t parity_of(IVec3 voxel) {
    return static_cast<std::size_t>((voxel.x & 1) | (voxel.y & 1) << 1 | (voxel.z & 1) << 2);
  }
  /// Of the rays that begin in a voxel at a face of that direction.
  static const OpeningRaySet& of(IVec3 front, int face) { return of(parity_of(front), face); }
  static const OpeningRaySet& of(std::size_t parity, int face);

  /// Where a ray comes within the first kCountedPlanes, in its order: the voxels whose coordinates
  /// differ from those of the one that it begins in by odd numbers along the axes in a mask.
  std::span<const Steps> steps(std::size_t ray, std::size_t odd) const {
    const std::size_t at = odd * kRays + ray;
    return std::span(counted).subspan(first_counted[at], first_counted[at + 1] - first_counted[at]);
  }

  std::array<OpeningRay, kRays> rays{};
  std::array<std::uint8_t, kRays> lobes{};
  std::array<std::uint64_t, shared::kSkyLobes> of_lobe{};
  std::array<std::uint8_t, kRays> down{};    ///< a bit an axis along which a ray goes down
  std::array<Steps, kRays> after_counted{};  ///< steps after kCountedPlanes

  std::vector<Steps> counted;
  std::array<std::uint32_t, 8 * kRays + 1> first_counted{};
};

}  // namespace skerry::world
