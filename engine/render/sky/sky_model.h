#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "engine/render/air/sky_scattering.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/sky/panorama_sky.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// What an eye's air scatters of one body, and what that depends on.
struct BodyScattering {
  double height_km = 0.0, sine = 0.0;
  SkyScattering table;
};

/// Everything of a moment's sky that does not depend on the direction looked at.
struct SkyModel {
  shared::SkyConstants constants{};  ///< decide all of it: equal ones have equal tables
  /// In place of all that the air scatters, and of stars; none: the sky is the air's.
  std::shared_ptr<const PanoramaSky> panorama;
  /// Of sun and moon; none: it gives no light, or the air that is seen is in the dark.
  std::array<std::shared_ptr<const BodyScattering>, shared::kBodyCount> scattering;
  /// What that is interpolated between: the places of the lattice below and above the body.
  std::array<std::array<std::shared_ptr<const BodyScattering>, 2>, shared::kBodyCount> nodes;
};

/// The sky over an eye, by world_atmosphere(), lit by sun and moon alike. Scattering is made for
/// places of a lattice of elevations (1/16 degree), between which it is interpolated, and of
/// heights (1/128 of the height above the mist, 2 m at the least), next to which the eye's change
/// no pixel by more than 1/255.
/// @param height_km of the eye, see eye_height_km(). @param before scattering that it has is not
/// made again. @param panorama see SkyModel: then nothing is scattered, and sun and moon are discs.
SkyModel sky_model(const Celestial& sky, double height_km = kWorldAboveMistKm,
                   const SkyModel* before = nullptr,
                   std::shared_ptr<const PanoramaSky> panorama = nullptr);

/// The scattering of both bodies in the layout of shared::SkyScatter[body][row][azimuth]; zeros
/// without one.
SkyScattering scattering_of_bodies(const SkyModel& sky);

/// Height above the mist of an eye so many blocks above the world's origin [km], on the lattice of
/// heights: 1 m below the mist, at most 1,000 km.
double eye_height_km(double blocks_above_origin);
double eye_height_km(const FrameInput& input);

/// Radiance of the sky without discs and stars, linear RGB, >= 0 and finite. The double-precision
/// twin of shaders/sky/bake_sky.comp, or of sample_sky() with a panorama. @param dir unit, any.
glm::dvec3 sky_radiance(glm::dvec3 dir, const SkyModel& sky);
/// The same towards many directions of one height (dir.y). @param radiance as many, set to it.
void sky_radiance(std::span<const glm::dvec3> dirs, const SkyModel& sky,
                  std::span<glm::dvec3> radiance);

/// Extinction of clear air [1/block].
inline constexpr float kClearAir = 0.0005f;

/// How much of the light that air and clouds take from the sky there is, 0..1: taken back as the
/// brighter body sets, so that nothing ends in a step when it is gone.
float air_light(const Celestial& sky);

}  // namespace skerry::render
