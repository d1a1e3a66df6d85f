#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Fills the sky-view table, kSkyLutWidth x kSkyLutHeight, once whenever sun, moon or the eye's height
// have changed: the sky's own light and, by night, the Milky Way. The light is the twin of sky_radiance() of
// engine/render/sky/sky_model.h, which tests compare it with.
#include "include/frame/halves.glsl"
#include "include/sky/sky.glsl"
#include "shared/bindings.h"

layout(local_size_x = kSkyLutGroup, local_size_y = kSkyLutGroup) in;

layout(scalar, binding = kSkyBinding) uniform Sky { SkyConstants sky; };
layout(scalar, binding = kSkyScatteringBinding) readonly buffer Scattering { SkyScatter scattering[]; };
layout(binding = kSkyTableBinding, rgba16f) writeonly uniform image2D sky_lut;

const float kMilkyWay = 3.0e-4;  // radiance in its middle

// Smooth noise on a lattice, 0..1.
float noise(vec3 p) {
  vec3 cell = floor(p);
  vec3 f = p - cell;
  f = f * f * (3.0 - 2.0 * f);
  uvec3 c = uvec3(ivec3(cell));
  float sum = 0.0;
  for (uint i = 0u; i < 8u; ++i) {
    uvec3 corner = uvec3(i & 1u, (i >> 1) & 1u, i >> 2);
    vec3 w = mix(1.0 - f, f, vec3(corner));
    sum += w.x * w.y * w.z * float(sky_hash(c + corner) >> 8);
  }
  return sum / 16777215.0;
}

// A band of star clouds along a great circle of the sky's frame, with a rift of dust.
vec3 milky_way(vec3 d) {
  float lat = dot(d, vec3(0.200, 0.871, 0.449));
  float cloud = 0.6 * noise(d * 5.0 + 20.0) + 0.4 * noise(d * 13.0 + 40.0);
  float rift = 0.55 * exp(-lat * lat * 260.0) * noise(d * 9.0 + 60.0);
  float band = exp(-lat * lat * 28.0) * (0.35 + 1.1 * cloud) * (1.0 - rift);
  return vec3(0.92, 0.97, 1.15) * (kMilkyWay * band);
}

// What molecules and aerosol scatter once, by the cosine of the angle between view and body: Rayleigh; Cornette and Shanks 1992.
vec2 phases(float cosine) {
  float square = 1.0 + cosine * cosine;
  const float g = kAerosolAsymmetry;
  float base = 1.0 + g * g - 2.0 * g * cosine;
  float mie = 3.0 / (8.0 * kSkyPi) * (1.0 - g * g) / (2.0 + g * g);
  return square * vec2(3.0 / (16.0 * kSkyPi), mie / (base * sqrt(base)));
}

// @param index 0 the sun, 1 the moon. @param row of the table that dir lies on.
vec3 body_radiance(uint index, SkyBody body, vec3 dir, uint row) {
  float flats = length(dir.xz) * length(body.to_body.xz);
  float across = acos(clamp(dot(dir.xz, body.to_body.xz) / max(flats, 1e-9), -1.0, 1.0));
  float place = across * (float(kSkyAzimuths - 1u) / kSkyPi);
  uint column = min(uint(place), kSkyAzimuths - 2u);
  uint first = (index * kSkyLutHeight + row) * kSkyAzimuths + column;
  SkyScatter a = scattering[first], b = scattering[first + 1u];
  float share = place - float(column);
  vec2 phase = phases(clamp(dot(dir, body.to_body), -1.0, 1.0));
  return body.light * (mix(a.rayleigh, b.rayleigh, share) * phase.x + mix(a.mie, b.mie, share) * phase.y +
                       mix(a.multiple, b.multiple, share));
}

void main() {
  uvec2 texel = gl_GlobalInvocationID.xy;
  uvec2 size = uvec2(kSkyLutWidth, kSkyLutHeight);
  if (any(greaterThanEqual(texel, size))) return;
  float azimuth = (float(texel.x) / float(kSkyLutWidth - 1u) - 0.5) * (2.0 * kSkyPi);
  float root = float(texel.y) / float(kSkyLutHeight - 1u) * 2.0 - 1.0;
  float range = 0.5 * kSkyPi + (root < 0.0 ? sky.horizon : -sky.horizon);
  float elevation = sky.horizon + root * abs(root) * range;
  vec3 dir = vec3(sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation));
  vec3 d = vec3(dot(sky.sky_x, dir), dot(sky.sky_y, dir), dot(sky.sky_z, dir));
  vec3 radiance = milky_way(d) * (sky.stars * smoothstep(-0.05, 0.20, dir.y));
  radiance += body_radiance(0u, sky.sun, dir, texel.y) + body_radiance(1u, sky.moon, dir, texel.y);
  imageStore(sky_lut, ivec2(texel), vec4(as_halves(radiance), 1.0));
}
