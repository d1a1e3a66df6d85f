#include <algorithm>
#include <cmath>

#include "tools/reference/clouds.h"

namespace skerry::reference {
namespace {

constexpr int kEdge = 128;  // texels, a power of two
constexpr int kCellTexels = 4;
constexpr int kCells = kEdge / kCellTexels;

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

CloudNoise::CloudNoise()
    : texels_(std::size_t{kEdge} * kEdge * kEdge), most_(std::size_t{kCells} * kCells * kCells) {
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
  for (int c = 0; c < kCells * kCells * kCells; ++c) {
    const glm::ivec3 low =
        glm::ivec3(c % kCells, c / kCells % kCells, c / (kCells * kCells)) * kCellTexels;
    std::array<std::uint8_t, 4> most{};
    // Blends in a cell take the texels next to it along, too.
    for (int z = low.z - 1; z <= low.z + kCellTexels; ++z)
      for (int y = low.y - 1; y <= low.y + kCellTexels; ++y)
        for (int x = low.x - 1; x <= low.x + kCellTexels; ++x) {
          const auto at = [](int v) { return static_cast<std::size_t>(v & (kEdge - 1)); };
          const auto& texel = texels_[(at(z) * kEdge + at(y)) * kEdge + at(x)];
          for (std::size_t n = 0; n < 4; ++n) most[n] = std::max(most[n], texel[n]);
        }
    most_[static_cast<std::size_t>(c)] = most;
  }
}

double CloudNoise::most_about(glm::dvec3 place, int channel) const {
  const auto cell = [](double v) {
    return static_cast<std::size_t>(static_cast<std::int64_t>(std::floor(v * kCells)) &
                                    (kCells - 1));
  };
  return most_[(cell(place.z) * kCells + cell(place.y)) * kCells + cell(place.x)]
              [static_cast<std::size_t>(channel)] /
         255.0;
}

const CloudNoise& CloudNoise::shared() {
  static const CloudNoise noise;
  return noise;
}

double CloudNoise::at(glm::dvec3 place, int channel) const {
  const Corners corners = corners_of(place);
  double sum = 0.0;
  for (int i = 0; i < 8; ++i)
    sum += corners.weight[i] * texels_[corners.index[i]][static_cast<std::size_t>(channel)];
  return sum / 255.0;
}

glm::dvec2 CloudNoise::billows_at(glm::dvec3 place) const {
  const Corners corners = corners_of(place);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < 8; ++i) {
    const std::array<std::uint8_t, 4>& texel = texels_[corners.index[i]];
    sum += corners.weight[i] * glm::dvec2(texel[1], texel[2]);
  }
  return sum / 255.0;
}

CloudNoise::Corners CloudNoise::corners_of(glm::dvec3 place) {
  std::size_t index[3][2];
  double weight[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    const double p = place[axis] * kEdge - 0.5, low = std::floor(p);
    const auto texel = static_cast<std::int64_t>(low);
    for (int side = 0; side < 2; ++side)
      index[axis][side] = static_cast<std::size_t>((texel + side) & (kEdge - 1));
    weight[axis][1] = p - low;
    weight[axis][0] = 1.0 - weight[axis][1];
  }
  Corners out;
  for (int i = 0; i < 8; ++i) {
    const int x = i % 2, y = i / 2 % 2, z = i / 4;
    out.index[i] = (index[2][z] * kEdge + index[1][y]) * kEdge + index[0][x];
    out.weight[i] = weight[0][x] * weight[1][y] * weight[2][z];
  }
  return out;
}

}  // namespace skerry::reference
