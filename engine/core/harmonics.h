#pragma once
#include <array>
#include <cstddef>

namespace skerry {

/// Functions of direction up to degree 2.
inline constexpr std::size_t kHarmonics = 9;

/// Real spherical harmonics of a unit direction: degree 0, then 1 and 2 by ascending order. They
/// are orthonormal over the sphere (R. Ramamoorthi, P. Hanrahan, An Efficient Representation for
/// Irradiance Environment Maps, 2001).
template <class T>
constexpr std::array<T, kHarmonics> harmonics_of(T x, T y, T z) {
  constexpr T k0 = T(0.28209479177387814), k1 = T(0.48860251190291992), k2 = T(1.0925484305920792),
              k20 = T(0.31539156525252005), k22 = T(0.54627421529603959);
  return {k0,
          k1 * y,
          k1 * z,
          k1 * x,
          k2 * x * y,
          k2 * y * z,
          k20 * (T(3) * z * z - T(1)),
          k2 * x * z,
          k22 * (x * x - y * y)};
}

}  // namespace skerry
