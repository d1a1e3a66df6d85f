#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <span>
#include <vector>

#include "engine/render/light/cascades.h"
#include "engine/render/renderer/renderer.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

inline constexpr std::int64_t kUnits = 65536;  // of a FixedPos, in a block

/// Places, directions and turns, the same in every run.
class RandomPlaces {
 public:
  explicit RandomPlaces(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    // Not std::uniform_real_distribution: its results differ between standard libraries.
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
  }
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  glm::dvec3 in_box(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 v = in_box(1.0);
      const double squared = glm::dot(v, v);
      if (squared > 1e-3 && squared < 1.0) return v / std::sqrt(squared);
    }
  }
  glm::dquat turn() { return glm::angleAxis(uniform(0.0, 6.28), direction()); }

 private:
  std::mt19937_64 engine_;
};

inline FixedPos fixed_at(glm::dvec3 blocks) {
  const double units = static_cast<double>(kUnits);
  return {std::llround(blocks.x * units), std::llround(blocks.y * units),
          std::llround(blocks.z * units)};
}

inline glm::dvec3 blocks_at(const FixedPos& p) {
  const double units = static_cast<double>(kUnits);
  return glm::dvec3(static_cast<double>(p[0]), static_cast<double>(p[1]),
                    static_cast<double>(p[2])) /
         units;
}

inline FixedPos sum(const FixedPos& a, const FixedPos& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

using Box = std::array<glm::dvec3, 8>;  // corner i is low or high in x, y, z by bits 0, 1, 2 of i

/// Corners of a section's tight box, relative to the camera, in double precision.
inline Box box_of(const shared::Section& s, const IslandPlacement& island, const FixedPos& camera) {
  const auto corner = [&](std::uint32_t packed) {
    const double voxel = static_cast<double>(1u << s.voxel_size_log2);
    return glm::dvec3(s.origin) +
           voxel * glm::dvec3(packed & 127u, (packed >> 7) & 127u, (packed >> 14) & 127u);
  };
  const glm::dvec3 low = corner(s.bounds_min), high = corner(s.bounds_max);
  const glm::dvec3 offset = blocks_at(
      {island.origin[0] - camera[0], island.origin[1] - camera[1], island.origin[2] - camera[2]});
  Box box;
  for (std::size_t i = 0; i < box.size(); ++i) {
    const glm::dvec3 lattice{i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                             i & 4 ? high.z : low.z};
    box[i] = island.rotation * lattice + offset;
  }
  return box;
}

/// Whether anything of a box lies inside all planes, exactly: its faces are cut by every plane
/// (Sutherland and Hodgman 1974). That is enough, since an endless frustum that meets a box meets
/// its surface.
inline bool box_meets(const Box& box, std::span<const glm::dvec4> planes) {
  constexpr std::array<std::array<std::size_t, 4>, 6> kFaces{
      {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
  for (const auto& face : kFaces) {
    std::vector<glm::dvec3> polygon;
    for (const std::size_t corner : face) polygon.push_back(box[corner]);
    for (const glm::dvec4& plane : planes) {
      std::vector<glm::dvec3> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(glm::dvec3(plane), a) + plane.w;
        const double db = glm::dot(glm::dvec3(plane), b) + plane.w;
        if (da >= 0.0) kept.push_back(a);
        if ((da >= 0.0) != (db >= 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
      }
      polygon = std::move(kept);
    }
    if (!polygon.empty()) return true;
  }
  return false;
}

inline Camera camera_at(glm::dvec3 blocks, double yaw_deg, double pitch_deg,
                        double fov_deg = 70.0) {
  return {fixed_at(blocks), yaw_deg, pitch_deg, fov_deg};
}

/// Axes of a camera, from docs/conventions.md alone; not for one that looks straight up or down.
struct Axes {
  glm::dvec3 right, up, forward;
};
inline Axes axes_of(const Camera& camera) {
  const double yaw = camera.yaw_deg * M_PI / 180.0, pitch = camera.pitch_deg * M_PI / 180.0;
  const glm::dvec3 forward{std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                           std::cos(yaw) * std::cos(pitch)};
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
  return {right, glm::cross(right, forward), forward};
}

/// Ray through a pixel's centre, one block long along the view axis.
inline glm::dvec3 ray_of(const Camera& camera, double x, double y, double width, double height) {
  const Axes axes = axes_of(camera);
  const double tan_y = std::tan(camera.fov_deg * M_PI / 360.0), tan_x = tan_y * width / height;
  return axes.forward + axes.right * (((x + 0.5) / width * 2.0 - 1.0) * tan_x) +
         axes.up * ((1.0 - (y + 0.5) / height * 2.0) * tan_y);
}

/// Planes of a camera's picture: four sides and the near plane, in double precision.
inline std::array<glm::dvec4, 5> frustum_of(const Camera& camera, double width, double height) {
  const Axes axes = axes_of(camera);
  const double tan_y = std::tan(camera.fov_deg * M_PI / 360.0), tan_x = tan_y * width / height;
  const auto side = [](glm::dvec3 n) { return glm::dvec4(glm::normalize(n), 0.0); };
  return {side(axes.forward * tan_x + axes.right), side(axes.forward * tan_x - axes.right),
          side(axes.forward * tan_y + axes.up), side(axes.forward * tan_y - axes.up),
          glm::dvec4(axes.forward, -static_cast<double>(kNearPlane))};
}

}  // namespace skerry::render
