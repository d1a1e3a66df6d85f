// The table of the sky's radiance by direction. Units and axes: docs/conventions.md.
#ifndef SKERRY_SKY_GLSL
#define SKERRY_SKY_GLSL
#include "shared/constants.h"
#include "shared/sky.h"

layout(constant_id = kPanoramaConstant) const bool kPanorama = false;  // in place of the table

const float kSkyPi = 3.14159265358979;

// Table coordinates of a direction: 0..1 from the centre of the first texel to that of the last.
// @param horizon elevation of the true horizon [rad], as in sky_row_place() of
// engine/render/air/sky_scattering.h.
vec2 sky_lut_from_dir(vec3 dir, float horizon) {
  float azimuth = dir.x == 0.0 && dir.z == 0.0 ? 0.0 : atan(dir.x, dir.z);
  float from = asin(clamp(dir.y, -1.0, 1.0)) - horizon;
  float share = min(1.0, abs(from) / (0.5 * kSkyPi + (from < 0.0 ? horizon : -horizon)));
  return vec2(0.5 + azimuth * (0.5 / kSkyPi), 0.5 + 0.5 * sign(from) * sqrt(share));
}

// The same in a panorama: rows of equal elevation from the zenith down, azimuths grow to the left. The sampler repeats: the sides of the
// picture meet, its upper and lower edges do not.
// @param yaw azimuth of its middle [rad].
vec2 panorama_from_dir(vec3 dir, float yaw, vec2 size) {
  float azimuth = dir.x == 0.0 && dir.z == 0.0 ? 0.0 : atan(dir.x, dir.z);
  float down = 0.5 - atan(dir.y, length(dir.xz)) / kSkyPi;
  return vec2(0.5 + (yaw - azimuth) * (0.5 / kSkyPi), clamp(down, 0.5 / size.y, 1.0 - 0.5 / size.y));
}

// The sky of dir (unit) from the table that bake_sky.comp filled, or from a panorama. A sampler that is linear, and for the table clamps to
// the edge.
vec3 sample_sky(sampler2D lut, vec3 dir, float horizon, float yaw) {
  if (kPanorama) return textureLod(lut, panorama_from_dir(dir, yaw, vec2(textureSize(lut, 0))), 0.0).rgb;
  const vec2 size = vec2(float(kSkyLutWidth), float(kSkyLutHeight));
  return textureLod(lut, (sky_lut_from_dir(dir, horizon) * (size - 1.0) + 0.5) / size, 0.0).rgb;
}

// A hash of integers, so that every device makes the same stars.
uint sky_hash(uvec3 v) {
  uint h = v.x * 1664525u + v.y * 1013904223u + v.z * 374761393u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return h ^ (h >> 16);
}

#endif
