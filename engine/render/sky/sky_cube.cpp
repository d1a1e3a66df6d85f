#include "engine/render/sky/sky_cube.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace skerry::render {

SkyCube::SkyCube(const std::function<glm::dvec3(glm::dvec3)>& radiance) {
  for (int side = 0; side < 6; ++side)
    for (int j = 0; j < kEdge; ++j)
      for (int i = 0; i < kEdge; ++i) {
        const double u = (2.0 * i + 1.0) / kEdge - 1.0, v = (2.0 * j + 1.0) / kEdge - 1.0;
        glm::dvec3 d;
        d[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
        d[(side / 2 + 1) % 3] = u;
        d[(side / 2 + 2) % 3] = v;
        texels_[index(side, i, j)] = glm::vec3(radiance(glm::normalize(d)));
      }
}

glm::vec3 SkyCube::at(const glm::vec3& d) const {
  const glm::vec3 size = glm::abs(d);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int side = 2 * axis + (d[axis] < 0.0f ? 1 : 0);
  const float u = place(d[(axis + 1) % 3] / size[axis]), v = place(d[(axis + 2) % 3] / size[axis]);
  const int i = std::min(static_cast<int>(u), kEdge - 2),
            j = std::min(static_cast<int>(v), kEdge - 2);
  const float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
  return glm::mix(glm::mix(texels_[index(side, i, j)], texels_[index(side, i + 1, j)], fu),
                  glm::mix(texels_[index(side, i, j + 1)], texels_[index(side, i + 1, j + 1)], fu),
                  fv);
}

float SkyCube::place(float u) {
  return std::clamp((u + 1.0f) * (0.5f * kEdge) - 0.5f, 0.0f, kEdge - 1.0f);
}

std::size_t SkyCube::index(int side, int i, int j) {
  return static_cast<std::size_t>((side * kEdge + j) * kEdge + i);
}

}  // namespace skerry::render
