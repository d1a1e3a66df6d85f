// Small scenes whose light is known in closed form.
#pragma once
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "tools/reference/reference.h"
#include "tools/reference/tracer.h"

namespace skerry::reference {

/// Stone below y = 0, `half_width` blocks to all sides.
inline Island stone_floor(int half_width = 40) {
  return {world::Volume::from_voxels(
      {-half_width, -2, -half_width}, {half_width, 0, half_width},
      [](world::IVec3) { return world::BlockId{world::block::kStone}; })};
}

/// One block at the lattice's origin, its middle at `middle`.
inline Island single_block(world::BlockId id, glm::dvec3 middle) {
  return {world::Volume::from_voxels({0, 0, 0}, {1, 1, 1}, [id](world::IVec3) { return id; }),
          glm::dmat3(1.0), middle - 0.5};
}

/// A camera that looks along `forward`, with the scene moved so that it stands at `eye`.
inline Scene seen_from(glm::dvec3 eye, glm::dvec3 forward, std::vector<Island> islands,
                       std::uint32_t edge = 8, double tan_half = 0.3) {
  Scene scene;
  scene.view.forward = glm::normalize(forward);
  const glm::dvec3 other =
      std::abs(scene.view.forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  scene.view.right = glm::normalize(glm::cross(scene.view.forward, other));
  scene.view.up = glm::cross(scene.view.right, scene.view.forward);
  scene.view.tan_half_y = tan_half;
  scene.view.width = scene.view.height = edge;
  for (Island& island : islands) island.origin -= eye;
  scene.islands = std::move(islands);
  scene.albedo = glm::dvec3(1.0);
  scene.matt = true;  // as closed forms are
  return scene;
}

inline ReferenceSettings samples(std::uint32_t count, int threads = 1) {
  ReferenceSettings settings;
  settings.samples = count;
  settings.threads = threads;
  return settings;
}

inline glm::dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

}  // namespace skerry::reference
