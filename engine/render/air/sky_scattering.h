#pragma once
#include <vector>

#include "engine/render/air/atmosphere.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// A direction's row of the sky's tables, 0 straight down, 1 straight up, 0.5 the horizon, with a
/// square root about it; and back. @param elevation, horizon [rad], the horizon's not positive.
double sky_row_place(double elevation, double horizon);
double sky_row_elevation(double place, double horizon);

/// What the air about one place scatters towards it, without the phase functions of single
/// scattering, which are the only part that changes fast with direction: shared::kSkyLutHeight rows
/// of shared::kSkyAzimuths. Some 2 ms. Deterministic.
using SkyScattering = std::vector<shared::SkyScatter>;

/// @param body_sine of the elevation of a body of irradiance 1 at the top of the air.
SkyScattering sky_scattering(const Atmosphere& atmosphere, double height_km, double body_sine);

/// The same in one direction. @param cos_azimuth of the angle between view and body about the
/// vertical.
shared::SkyScatter sky_scattering_at(const Atmosphere& atmosphere, double height_km,
                                     double body_sine, double sine, double cos_azimuth);

}  // namespace skerry::render
