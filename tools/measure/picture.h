#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace skerry::measure {

/// Linear Rec. 709 colour a pixel, rows from the top: scene radiance, or a picture's decoded sRGB.
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<glm::vec3> pixels;  ///< width * height
};

}  // namespace skerry::measure
