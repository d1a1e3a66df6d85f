#include <algorithm>
#include <cmath>

#include "tools/reference/clouds.h"

namespace skerry::reference {
namespace {

constexpr int kEdge = 128;

/// An integer hash of a cell of a lattice that repeats.
std::uint32_t cell_hash(glm::ivec3 cell, int cells, std::uint32_t seed) {
  const auto wrap = [&](int v) { return static_cast<std::uint32_t>((v % cells + cells) % cells); };
  const std::uint32_t base = seed * 64;
  std::uint32_t h = (wrap(cell.x) + base) * 1664525u + (wrap(cell.y) + base) * 1013904223u +
                    (wrap(cell.z) + base) * 374761393u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return h ^ (h >> 16);
}

/// Perlin's gradient noise with the twelve edges of a cube.
double gradient(glm::dvec3 place, int cells, std::uint32_t seed) {
  static constexpr int kAxes[3][2] = {{0, 1}, {1, 2}, {2, 0}};
  const glm::dvec3 p = place * static_cast<double>(cells);
  const glm::ivec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner % 2, corner / 2 % 2, corner / 4);
    const std::uint32_t h = cell_hash(cell + step, cells, seed) % 12;
    double weight = 1.0, d[3];
    for (int axis = 0; axis < 3; ++axis) {
      d[axis] = p[axis] - (cell[axis] + step[axis]);
      const double t = 1.0 - std::abs(d[axis]);
      weight *= t * t * t * (10.0 + t * (6.0 * t - 15.0));
    }
    const double a = d[kAxes[h / 4][0]], b = d[kAxes[h / 4][1]];
    sum += weight * ((h & 1 ? -a : a) + (h & 2 ? -b : b));
  }
  return sum;
}

/// 1 less the distance to Worley's nearest point.
double billow(glm::dvec3 place, int cells, std::uint32_t seed) {
  const glm::dvec3 p = place * static_cast<double>(cells);
  const glm::ivec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  double nearest = 1.0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const glm::ivec3 at = cell + glm::ivec3(x, y, z);
        const std::uint32_t h = cell_hash(at, cells, seed);
        const double dx = at.x + (h % 1024) / 1023.0 - p.x,
                     dy = at.y + (h / 1024 % 1024) / 1023.0 - p.y,
                     dz = at.z + (h / 1048576 % 1024) / 1023.0 - p.z;
        nearest = std::min(nearest, dx * dx + dy * dy + dz * dz);
      }
  return 1.0 - std::sqrt(nearest);
}

std::uint8_t eighths(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
}

}  // namespace

CloudNoise::CloudNoise() : texels_(std::size_t{kEdge} * kEdge * kEdge) {
  std::size_t i = 0;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const glm::dvec3 place = (glm::dvec3(x, y, z) + 0.5) / double{kEdge};
        const double field = 0.5 + 0.5 * gradient(place, 4, 1) + 0.25 * gradient(place, 8, 2);
        const double ragged = 0.5 + 0.6 * gradient(place, 4, 3) + 0.3 * gradient(place, 8, 4) +
                              0.15 * gradient(place, 16, 5);
        const double b4 = billow(place, 4, 6), b8 = billow(place, 8, 7), b16 = billow(place, 16, 8),
                     b32 = billow(place, 32, 9);
        const double lumps = 0.625 * b4 + 0.25 * b8 + 0.125 * b16;
        texels_[i++] = {eighths(0.5 * ragged + 0.5 * lumps), eighths(0.625 * b8 + 0.375 * b16),
                        eighths(0.625 * b16 + 0.375 * b32), eighths(field)};
      }
}

const CloudNoise& CloudNoise::shared() {
  static const CloudNoise noise;
  return noise;
}

double CloudNoise::at(glm::dvec3 place, int channel) const {
  const glm::dvec3 p = place * double{kEdge} - 0.5;
  const glm::dvec3 low(std::floor(p.x), std::floor(p.y), std::floor(p.z)), f = p - low;
  const auto wrap = [](double v) {
    return static_cast<std::size_t>(v - std::floor(v / kEdge) * kEdge) % kEdge;
  };
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner % 2, y = corner / 2 % 2, z = corner / 4;
    const double weight = (x ? f.x : 1.0 - f.x) * (y ? f.y : 1.0 - f.y) * (z ? f.z : 1.0 - f.z);
    sum += weight * texels_[(wrap(low.z + z) * kEdge + wrap(low.y + y)) * kEdge + wrap(low.x + x)]
                           [static_cast<std::size_t>(channel)];
  }
  return sum / 255.0;
}

}  // namespace skerry::reference
