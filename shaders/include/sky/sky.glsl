// The daylight model and its table. Units and axes: docs/conventions.md. sky_radiance() is the twin
// of engine/render/sky/sky_model.cpp, where the sources are named; a test compares them.
#ifndef SKERRY_SKY_GLSL
#define SKERRY_SKY_GLSL
#include "shared/sky.h"

const float kSkyPi = 3.14159265358979;

vec3 linear_from_yxy(vec3 yxy) {
  float s = yxy.x / max(yxy.z, 1e-3);
  vec3 xyz = vec3(yxy.y * s, yxy.x, (1.0 - yxy.y - yxy.z) * s);
  return vec3(dot(xyz, vec3(3.2404542, -1.5371385, -0.4985314)),
              dot(xyz, vec3(-0.9692660, 1.8760108, 0.0415560)),
              dot(xyz, vec3(0.0556434, -0.2040259, 1.0572252)));
}

// One body's radiance on the cone of sky at height `up` (sine of the elevation, >= 0). `dir` may
// dip below it.
vec3 body_radiance(vec3 dir, float up, SkyBody body) {
  float cos_gamma = clamp(dot(dir, body.to_body), -1.0, 1.0);
  float clear = 1.0 - up;
  float hue_up = up + 0.25 * clear * clear * clear;
  vec3 yxy = body.zenith *
             (1.0 + body.perez_a * exp(body.perez_b / vec3(max(up, 1e-3), hue_up, hue_up))) *
             (1.0 + body.perez_c * exp(body.perez_d * acos(cos_gamma)) +
              body.perez_e * (cos_gamma * cos_gamma));
  vec3 day = max(linear_from_yxy(yxy), 0.0) * body.day;
  float low = clear * clear * clear * clear * clear;
  float towards = dot(dir.xz, body.to_body.xz) / max(1e-3, length(body.to_body.xz));
  float side = 0.5 + 0.5 * towards;
  float rise = (dir.y - max(0.0, body.to_body.y)) / 0.11;
  float fire = exp(4.0 * (towards - 1.0)) / (1.0 + rise * rise);
  float band = exp(-5.0 * up) * (0.3 + 0.7 * side * side);
  float dome = 0.75 + 0.75 * side * clear;
  return mix(day, body.haze, 0.9 * low) + fire * body.dusk_fire + band * body.dusk_band +
         dome * body.dusk_dome;
}

// Radiance of the sky without discs and stars, evaluated directly. dir is unit.
vec3 sky_radiance(vec3 dir, SkyConstants sky) {
  float up = max(0.0, dir.y);
  vec3 radiance = body_radiance(dir, up, sky.sun) + body_radiance(dir, up, sky.moon);
  float open = min(1.0, 1.0 + dir.y);
  open *= open;
  return mix(sky.sun.abyss + sky.moon.abyss, radiance, open * open);
}

// Table coordinates of a direction and back: 0..1 from the centre of the first texel to that of the
// last.
vec2 sky_lut_from_dir(vec3 dir) {
  float azimuth = dir.x == 0.0 && dir.z == 0.0 ? 0.0 : atan(dir.x, dir.z);
  float height = asin(clamp(dir.y, -1.0, 1.0)) * (2.0 / kSkyPi);
  return vec2(0.5 + azimuth * (0.5 / kSkyPi), 0.5 + 0.5 * sign(height) * sqrt(abs(height)));
}

vec3 dir_from_sky_lut(vec2 place) {
  float azimuth = (place.x - 0.5) * (2.0 * kSkyPi);
  float root = place.y * 2.0 - 1.0;
  float elevation = sign(root) * root * root * (0.5 * kSkyPi);
  return vec3(sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation));
}

// The sky of dir (unit) from the table that bake_sky.comp filled. Any sampler that is linear and
// clamps to the edge.
vec3 sample_sky(sampler2D lut, vec3 dir) {
  const vec2 size = vec2(float(kSkyLutWidth), float(kSkyLutHeight));
  return textureLod(lut, (sky_lut_from_dir(dir) * (size - 1.0) + 0.5) / size, 0.0).rgb;
}

// A hash of integers, so that every device makes the same stars.
uint sky_hash(uvec3 v) {
  uint h = v.x * 1664525u + v.y * 1013904223u + v.z * 374761393u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return h ^ (h >> 16);
}

#endif
