#pragma once
#include <glm/vec3.hpp>

#include "tools/reference/scene.h"

namespace skerry::reference {

/// Radiance of the sky in a direction, without discs and stars: the daylight model, and by night
/// the Milky Way. The model is render::sky_radiance, which has its sources. With a panorama its
/// texels, found by formulas of this file's own.
glm::dvec3 sky_behind(glm::dvec3 direction, const Sky& sky);

/// Radiance of the discs of sun and moon where a direction meets one, else 0. The sun darkens
/// towards its limb by a linear law; the moon is ground lit from the sun's side (Lommel and
/// Seeliger).
glm::dvec3 disc_radiance(glm::dvec3 direction, const Sky& sky);
/// Whether the moon, lit or not, stands in front of the stars.
bool moon_hides_stars(glm::dvec3 direction, const Sky& sky);

/// Radiance of the stars for a pixel. The model spreads each star over a footprint of some pixels,
/// so it is a function of the pixel's centre and size, and not averaged once more.
/// @param pixel_angle [rad]
glm::dvec3 star_radiance(glm::dvec3 direction, double pixel_angle, const Sky& sky);

}  // namespace skerry::reference
