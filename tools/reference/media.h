// Water and glass as media, and what level water looks like: ripples and foam.
#pragma once
#include <glm/vec3.hpp>

#include "tools/reference/tracer.h"

namespace skerry::reference {

/// What water and glass do to light [1/block].
struct Medium {
  glm::dvec3 absorption{0.0};
  double scattering = 0.0;  ///< evenly to all sides, white

  glm::dvec3 extinction() const { return absorption + scattering; }
};
/// Of a translucent block of the table.
Medium medium_of(world::BlockId block);
/// Radiance that a stretch of medium scatters towards the eye under an irradiance: once.
glm::dvec3 scattered_in(const Medium& medium, glm::dvec3 irradiance, double length_blocks);
/// What is left of light after a stretch of medium.
glm::dvec3 transmitted_by(const Medium& medium, double length_blocks);

/// Whether a face is the surface of level water, which has ripples.
bool is_wavy(const Meeting& layer);
/// Normal of level water, upwards, in its island's lattice. Its waves fade with the distance, for
/// far ones are smaller than a pixel.
glm::dvec3 ripples_of(const Meeting& layer, double time_s);

/// How a surface of water or glass mirrors lights. @param alpha of its lobe. @param waves share of
/// it that is wave_lobe(), the rest is mirror_lobe().
struct Gloss {
  double alpha = 0.0, waves = 0.0;
};
/// Of the waves that are too small to draw. Those of ripples_of() that have faded are among them,
/// by the mean square of their slopes (Olano and Baker 2010, LEAN Mapping).
Gloss gloss_of(const Meeting& layer);

inline constexpr double kFoamAlbedo = 0.8;
/// Share of level water that foam covers there, seen from above: along opaque blocks that stand
/// beside the water's own, and about their corners.
double foam_cover(const Tracer& tracer, const Meeting& layer, double time_s);

}  // namespace skerry::reference
