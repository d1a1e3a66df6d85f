#include "tools/reference/media.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tools/reference/textures.h"

namespace skerry::reference {
namespace {

glm::dvec3 exponentials(glm::dvec3 v) {
  return {std::exp(v.x), std::exp(v.y), std::exp(v.z)};
}

/// Of a wave along the lattice's x and z [radians/block].
double phase_of(double x, double z, double turns_per_s, const Meeting& at, double time_s) {
  return x * at.lattice.x + z * at.lattice.z +
         2.0 * std::numbers::pi * std::fmod(time_s * turns_per_s, 1.0);
}

/// What is left of the small things of a surface as far away as it is.
double fading(const Meeting& layer) {
  return std::exp(-0.02 * layer.t);
}

/// A sine of the lattice, whose period divides an hour. @param slope its largest.
struct Wave {
  double x, z, slope;
};
constexpr Wave kWaves[] = {
    {0.83, 0.31, 0.022}, {-0.47, 1.13, 0.018}, {1.91, -1.27, 0.011}, {-2.3, -2.9, 0.007}};

}  // namespace

Medium medium_of(world::BlockId block) {
  const world::BlockType& type = world::block_types()[block];
  return {{type.absorption[0], type.absorption[1], type.absorption[2]}, type.scattering};
}

glm::dvec3 scattered_in(const Medium& medium, glm::dvec3 irradiance, double length_blocks) {
  const glm::dvec3 extinction = medium.extinction();
  if (extinction.x <= 0.0 || extinction.y <= 0.0 || extinction.z <= 0.0) return glm::dvec3(0.0);
  return medium.scattering / extinction * irradiance *
         (1.0 - exponentials(extinction * -length_blocks)) / (4.0 * std::numbers::pi);
}

glm::dvec3 transmitted_by(const Medium& medium, double length_blocks) {
  return exponentials(medium.extinction() * -length_blocks);
}

bool is_wavy(const Meeting& layer) {
  return world::block_types()[layer.block].liquid && axis_of_face(layer.face) == 1;
}

/// The gradient of the waves.
glm::dvec3 ripples_of(const Meeting& layer, double time_s) {
  double slope_x = 0.0, slope_z = 0.0;
  for (const Wave& wave : kWaves) {
    const double length = std::hypot(wave.x, wave.z);
    const double turns_per_s = std::floor(30.0 * length) / 100.0;
    const double slope =
        wave.slope * std::cos(phase_of(wave.x, wave.z, turns_per_s, layer, time_s)) * fading(layer);
    slope_x += wave.x / length * slope;
    slope_z += wave.z / length * slope;
  }
  return glm::normalize(glm::dvec3(-slope_x, 1.0, -slope_z));
}

Gloss gloss_of(const Meeting& layer) {
  constexpr double kLeastRoughness = 0.06;  // of the waves too small to draw
  const double roughness =
      std::max<double>(world::block_types()[layer.block].roughness, kLeastRoughness);
  const double drawn = std::pow(roughness, 4.0);
  double faded = 0.0;
  if (is_wavy(layer))
    for (const Wave& wave : kWaves)
      faded += std::sqrt(std::numbers::pi) * 0.5 * wave.slope * wave.slope *
               (1.0 - fading(layer) * fading(layer));
  return {std::sqrt(drawn + faded), faded / (drawn + faded)};
}

double foam_cover(const Tracer& tracer, const Meeting& layer, double time_s) {
  if (layer.face != 2) return 0.0;
  double land = 1.0;  // blocks to the nearest that stands there
  for (int x = -1; x <= 1; ++x)
    for (int z = -1; z <= 1; ++z) {
      const world::IVec3 voxel{layer.voxel.x + x, layer.voxel.y, layer.voxel.z + z};
      if (world::block_kind(tracer.block_at(layer.island, voxel)) != world::BlockKind::kOpaque)
        continue;
      const double beside_x =
          std::max({voxel.x - layer.lattice.x, layer.lattice.x - voxel.x - 1, 0.0});
      const double beside_z =
          std::max({voxel.z - layer.lattice.z, layer.lattice.z - voxel.z - 1, 0.0});
      land = std::min(land, std::hypot(beside_x, beside_z));
    }
  const double width = 0.2 + 0.06 * std::sin(phase_of(2.7, 1.9, 0.25, layer, time_s)) +
                       0.05 * std::sin(phase_of(-3.8, 4.6, 0.4, layer, time_s));
  return 0.8 * std::clamp((width - land) / (0.6 * width), 0.0, 1.0) * fading(layer);
}

}  // namespace skerry::reference
