#pragma once
#include <array>
#include <cstddef>

namespace skerry::world {

/// Axes (0 x, 1 y, 2 z) of a face's plane, as shaders/shared/geometry.h has them.
struct FaceAxes {
  std::size_t normal, u, v;
};

/// @param face one of the six directions, +x, -x, +y, -y, +z, -z.
constexpr FaceAxes axes_of_face(std::size_t face) {
  constexpr std::array<FaceAxes, 3> kAxes{{{0, 2, 1}, {1, 0, 2}, {2, 0, 1}}};
  return kAxes[face / 2];
}

}  // namespace skerry::world
