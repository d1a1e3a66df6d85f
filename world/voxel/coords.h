#pragma once
#include <compare>
#include <cstdint>
#include <glm/vec3.hpp>

namespace skerry::world {

/// Units of a fixed-point coordinate in one block.
inline constexpr std::int64_t kUnitsPerBlock = 65536;
/// Largest distance from the origin the program accepts, in blocks, on any axis.
inline constexpr std::int64_t kMaxBlock = std::int64_t{1} << 40;

/// An exact place in the world: units of 1/65536 block. Differences of two valid places never
/// overflow.
struct WorldPos {
  std::int64_t x = 0, y = 0, z = 0;
  auto operator<=>(const WorldPos&) const = default;
  friend WorldPos operator+(WorldPos a, WorldPos b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend WorldPos operator-(WorldPos a, WorldPos b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

/// A place moved by a small vector [blocks], rounded to the nearest unit.
WorldPos moved(WorldPos from, glm::dvec3 by_blocks);

/// `to - from` in blocks. The subtraction is exact; only the result is rounded to double.
inline glm::dvec3 difference_blocks(WorldPos to, WorldPos from) {
  constexpr double kScale = 1.0 / static_cast<double>(kUnitsPerBlock);
  return {static_cast<double>(to.x - from.x) * kScale, static_cast<double>(to.y - from.y) * kScale,
          static_cast<double>(to.z - from.z) * kScale};
}

/// Integer place in an island's lattice [voxels or chunks].
struct IVec3 {
  std::int32_t x = 0, y = 0, z = 0;
  auto operator<=>(const IVec3&) const = default;
};

/// Floor division and its remainder in [0, b), for b > 0.
constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0);
}
constexpr std::int64_t floor_mod(std::int64_t a, std::int64_t b) {
  return a % b + (a % b < 0 ? b : 0);
}

}  // namespace skerry::world
