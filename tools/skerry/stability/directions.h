#pragma once
#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

namespace skerry::tools::stability {

/// Unit vectors, about evenly spread over the sphere: a spiral.
inline std::vector<glm::dvec3> even_directions(int count) {
  constexpr double kGoldenAngle = 2.399963229728653;
  std::vector<glm::dvec3> out;
  for (int i = 0; i < count; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / count, r = std::sqrt(1.0 - y * y);
    out.emplace_back(r * std::sin(kGoldenAngle * i), y, r * std::cos(kGoldenAngle * i));
  }
  return out;
}

}  // namespace skerry::tools::stability
