#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

namespace skerry::game {

/// A light reaches as far as a surface facing it receives this irradiance [unit of sun radiance]:
/// two thirds of the full moon's, and some 1/400 of a torch's at one block.
inline constexpr float kLeastIrradiance = 0.005f;

/// What a glowing block sends out.
struct BlockEmission {
  /// Radiant intensity of the light of one drawn face, spread evenly over the sphere [unit of sun
  /// radiance * block^2]. A plant's is that of its two quads, both sides.
  glm::vec3 face_intensity{0.0f};
  /// From the middle of its voxel to the middle of its light [blocks]: plants glow where their
  /// texture does.
  glm::vec3 offset{0.0f};
};

/// Indexed by block id; zeros for blocks that do not glow. A block's radiance is the mean of what
/// its texels emit; an even Lambertian face of area A and radiance L sends out
/// pi L A, over the 4 pi of the sphere.
std::vector<BlockEmission> emission_table();

/// How far a light of this intensity reaches [blocks].
inline float light_range(glm::vec3 intensity) {
  return std::sqrt(std::max({intensity.x, intensity.y, intensity.z}) / kLeastIrradiance);
}

}  // namespace skerry::game
