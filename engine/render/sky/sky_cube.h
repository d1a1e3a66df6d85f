#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>

namespace skerry::render {

/// A smooth sky about the world's axes, a texel in the middle of each of kEdge^2 parts of a cube's
/// sides, between which it is interpolated.
class SkyCube {
 public:
  /// @param radiance by direction (unit).
  explicit SkyCube(const std::function<glm::dvec3(glm::dvec3)>& radiance);
  /// @param d any length but 0.
  glm::vec3 at(const glm::vec3& d) const;

 private:
  static constexpr int kEdge = 20;
  static float place(float u);
  static std::size_t index(int side, int i, int j);
  std::array<glm::vec3, 6 * kEdge * kEdge> texels_;
};

}  // namespace skerry::render
