#include "world/light/base/opening_ray_sets.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "world/light/base/face_records.h"

namespace skerry::world {
namespace {

/// Point of a (0, 2)-sequence in base 2 (Kollig and Keller 2002, Efficient Multidimensional
/// Sampling): each 2^k in a row, the first of them a multiple of 2^k, are as even as so many can
/// be.
std::array<double, 2> point_of_sequence(std::uint32_t number) {
  std::uint32_t u = 0, v = 0;
  for (std::uint32_t left = number, bit = 1u << 31, sum = 1u << 31; left != 0;
       left >>= 1, bit >>= 1, sum ^= sum >> 1)
    if ((left & 1u) != 0) u ^= bit, v ^= sum;
  const double step = std::exp2(-32.0);
  return {u * step, v * step};
}

/// From the unit square to the unit disc, areas in proportion (Shirley and Chiu 1997, A Low
/// Distortion Map Between Disk and Square).
glm::dvec2 in_disc(glm::dvec2 square) {
  const glm::dvec2 p = 2.0 * square - 1.0;
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double part = std::numbers::pi / 4.0 * (wide ? p.y / p.x : p.x / p.y);
  return wide ? glm::dvec2(radius * std::cos(part), radius * std::sin(part))
              : glm::dvec2(radius * std::sin(part), radius * std::cos(part));
}

OpeningRay ray_along(const glm::dvec3& d, int own_axis) {
  OpeningRay ray;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    ray.step[axis] = d[a] > 0.0 ? 1 : -1;
    ray.every[axis] = static_cast<float>(1.0 / std::abs(d[a]));
    ray.first[axis] = a == own_axis ? ray.every[axis] : 0.5f * ray.every[axis];
  }
  RayCrossings crossings(ray);
  for (std::size_t at = 0; at < OpeningRay::kKeptPlanes; ++at, crossings.pass())
    ray.planes[at / OpeningRay::kPlanesAWord] |= std::uint64_t{crossings.axis()}
                                                 << 2 * (at % OpeningRay::kPlanesAWord);
  return ray;
}

void count_steps(OpeningRaySet& set) {
  std::array<std::array<std::vector<OpeningRaySet::Steps>, OpeningRaySet::kRays>, 8> by_parity;
  for (std::size_t i = 0; i < OpeningRaySet::kRays; ++i) {
    OpeningRaySet::Steps steps{};
    std::size_t planes = 0;
    for_each_plane(set.rays[i], 0, [&](std::size_t axis) {
      ++steps[axis];
      by_parity[(steps[0] & 1u) | (steps[1] & 1u) << 1 | (steps[2] & 1u) << 2][i].push_back(steps);
      return ++planes < OpeningRaySet::kCountedPlanes;
    });
    set.after_counted[i] = steps;
  }
  std::size_t at = 0;
  for (const auto& rays : by_parity)
    for (const std::vector<OpeningRaySet::Steps>& steps : rays) {
      set.counted.insert(set.counted.end(), steps.begin(), steps.end());
      set.first_counted[++at] = static_cast<std::uint32_t>(set.counted.size());
    }
}

// Sets follow each other in one sequence: they are even by themselves, and together those of four
// faces side by side. Density goes with the cosine.
OpeningRaySet make_set(int face, std::size_t parity) {
  constexpr std::size_t kRays = OpeningRaySet::kRays;
  const FaceAxes axes(face);
  const auto odd = [&](int axis) { return parity >> axis & 1u; };
  const std::size_t set = odd(axes.b) + 2 * odd(axes.c) + 4 * odd(axes.own);
  OpeningRaySet out;
  for (std::size_t i = 0; i < kRays; ++i) {
    // In the middle of the cells that points of all sets lie in, none of them on the face's axes.
    constexpr double kHalfCell = 0.5 / static_cast<double>(OpeningRaySet::kSets * kRays);
    const auto [u, v] = point_of_sequence(static_cast<std::uint32_t>(set * kRays + i));
    const glm::dvec2 level = in_disc({u + kHalfCell, v + kHalfCell});
    glm::dvec3 d(0.0);
    d[axes.own] = axes.sign * std::sqrt(1.0 - glm::dot(level, level));
    d[axes.b] = level.x;
    d[axes.c] = level.y;
    out.rays[i] = ray_along(d, axes.own);
    std::uint32_t octant = 0;
    for (int a = 0; a < 3; ++a)
      if (d[a] <= 0.0) octant |= 1u << a;
    out.down[i] = static_cast<std::uint8_t>(octant);
    const std::uint32_t lobe = shared::sky_lobe(static_cast<std::uint32_t>(axes.own), octant,
                                                static_cast<float>(std::abs(d.y)));
    out.lobes[i] = static_cast<std::uint8_t>(lobe);
    out.of_lobe[lobe] |= std::uint64_t{1} << i;
  }
  count_steps(out);
  return out;
}

}  // namespace

const OpeningRaySet& OpeningRaySet::of(std::size_t parity, int face) {
  static const std::vector<OpeningRaySet> kAll = [] {
    std::vector<OpeningRaySet> all;
    for (int direction = 0; direction < 6; ++direction)
      for (std::size_t its = 0; its < kSets; ++its) all.push_back(make_set(direction, its));
    return all;
  }();
  return kAll[static_cast<std::size_t>(face) * kSets + parity];
}

}  // namespace skerry::world
