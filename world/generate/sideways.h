#pragma once
#include <cstdint>

#include "world/generate/noise.h"
#include "world/voxel/hash.h"

namespace skerry::world {

/// The sideways shift that turns height-map cliffs into ledges and overhangs: rock at a voxel is
/// what the height map says at a place a few blocks off. The shift changes by less than its own
/// length across a horizontal cell, so connected rock stays connected within a layer; from layer to
/// layer it may change quickly, which makes strata.
namespace sideways {

inline constexpr int kCell = 16;       ///< horizontal lattice spacing, blocks
inline constexpr int kCellHeight = 8;  ///< vertical lattice spacing, blocks

struct Shift {
  int x, z;  ///< Q12 share of the largest shift, -4096..4096
};

constexpr int floor_to(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/// The shift at a lattice corner, at any height.
inline Shift corner(std::uint32_t seed, int cx, int y, int cz) {
  const int layer = floor_to(y, kCellHeight);
  const int t = noise::smooth((y - layer * kCellHeight) * noise::kOne12 / kCellHeight);
  const std::uint32_t low = hash3(seed, cx, layer, cz);
  const std::uint32_t high = hash3(seed, cx, layer + 1, cz);
  const auto part = [](std::uint32_t bits) {
    return static_cast<int>(bits & 0x1fff) - noise::kOne12;
  };
  const auto mix = [t](int a, int b) { return a + (((b - a) * t) >> 12); };
  return {mix(part(low), part(high)), mix(part(low >> 16), part(high >> 16))};
}

/// Between four corners, at (fx, fz) of a cell in blocks.
inline Shift between(const Shift& c00, const Shift& c10, const Shift& c01, const Shift& c11, int fx,
                     int fz) {
  const int u = noise::smooth(fx * (noise::kOne12 / kCell));
  const int v = noise::smooth(fz * (noise::kOne12 / kCell));
  const auto mix = [u, v](int a, int b, int c, int d) {
    const int near = a + (((b - a) * u) >> 12);
    const int far = c + (((d - c) * u) >> 12);
    return near + (((far - near) * v) >> 12);
  };
  return {mix(c00.x, c10.x, c01.x, c11.x), mix(c00.z, c10.z, c01.z, c11.z)};
}

/// The shift at one voxel.
inline Shift at(std::uint32_t seed, int x, int y, int z) {
  const int cx = floor_to(x, kCell);
  const int cz = floor_to(z, kCell);
  return between(corner(seed, cx, y, cz), corner(seed, cx + 1, y, cz), corner(seed, cx, y, cz + 1),
                 corner(seed, cx + 1, y, cz + 1), x - cx * kCell, z - cz * kCell);
}

}  // namespace sideways
}  // namespace skerry::world
