#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Fills the sky-view table, kSkyLutWidth x kSkyLutHeight, once whenever sun or moon have moved: the
// sky's own light and, by night, the Milky Way.
#include "include/frame/halves.glsl"
#include "include/sky/sky.glsl"
#include "shared/bindings.h"

layout(local_size_x = kSkyLutGroup, local_size_y = kSkyLutGroup) in;

layout(scalar, binding = kSkyBinding) uniform Sky { SkyConstants sky; };
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

void main() {
  uvec2 texel = gl_GlobalInvocationID.xy;
  uvec2 size = uvec2(kSkyLutWidth, kSkyLutHeight);
  if (any(greaterThanEqual(texel, size))) return;
  vec3 dir = dir_from_sky_lut(vec2(texel) / vec2(size - 1u));
  vec3 d = vec3(dot(sky.sky_x, dir), dot(sky.sky_y, dir), dot(sky.sky_z, dir));
  vec3 night = milky_way(d) * (sky.stars * smoothstep(-0.05, 0.20, dir.y));
  imageStore(sky_lut, ivec2(texel), vec4(as_halves(sky_radiance(dir, sky) + night), 1.0));
}
