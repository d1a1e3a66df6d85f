#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Fills the tiling noise of the cloud layer, once: red the shapes, green and blue small and smaller billows, alpha a smooth field.
// Cells that repeat make it tile. Twin, written on its own: tools/reference/cloud_noise.cpp.
// Then packs it as a march asks for it: a texel holds four slices of height, so that a blend of eight texels is one of four; and the weather, which
// is asked for at height 0 alone. What a ray asks for lies close together, for waiting for memory is most of what it costs on CPUs. docs/clouds.md.
#include "shared/clouds.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kCloudNoiseBinding, rgba8) uniform image3D noise;
layout(binding = kCloudWeatherBinding, rgba8) writeonly uniform image2D weather;
layout(binding = kCloudShapesBinding, rgba8) writeonly uniform image2D shapes;  // the layer that is filled
layout(binding = kCloudBillowsBinding, rgba8) writeonly uniform image2D packed_billows;
layout(push_constant) uniform Push { uint layer; } push;

layout(constant_id = kPackConstant) const bool kPack = false;  // else the noise is filled

uint hashed(uvec3 v) {
  uint h = v.x * 1664525u + v.y * 1013904223u + v.z * 374761393u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return h ^ (h >> 16);
}
uint hashed(ivec3 cell, int cells, uint seed) {
  ivec3 wrapped = cell - cells * ivec3(greaterThanEqual(cell, ivec3(cells))) + cells * ivec3(lessThan(cell, ivec3(0)));
  return hashed(uvec3(wrapped) + seed * 64u);
}

float share(uint h) { return float(h & 1023u) * (1.0 / 1023.0); }

// Gradient noise (Perlin, Improving Noise, 2002): the twelve edges of a cube as gradients. -1..1.
float corner(ivec3 cell, ivec3 step, vec3 f, int cells, uint seed) {
  uint h = hashed(cell + step, cells, seed) % 12u;
  vec3 d = f - vec3(step);
  vec2 pair = h < 4u ? d.xy : h < 8u ? d.yz : d.zx;
  return ((h & 1u) == 0u ? pair.x : -pair.x) + ((h & 2u) == 0u ? pair.y : -pair.y);
}
float gradient_noise(vec3 place, int cells, uint seed) {
  vec3 p = place * float(cells);
  ivec3 cell = ivec3(floor(p));
  vec3 f = p - floor(p);
  vec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  float sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    ivec3 step = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    vec3 side = mix(1.0 - w, w, vec3(step));
    sum += side.x * side.y * side.z * corner(cell, step, f, cells, seed);
  }
  return sum;
}

// 1 less the distance to the nearest of one point a cell (Worley, A Cellular Texture Basis Function, 1996). 0..1.
float billows(vec3 place, int cells, uint seed) {
  vec3 p = place * float(cells);
  ivec3 cell = ivec3(floor(p));
  float nearest = 1.0;
  for (int i = 0; i < 27; ++i) {
    ivec3 at = cell + ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    uint h = hashed(at, cells, seed);
    vec3 d = vec3(at) + vec3(share(h), share(h >> 10), share(h >> 20)) - p;
    nearest = min(nearest, dot(d, d));
  }
  return 1.0 - sqrt(nearest);
}

void fill() {
  uvec3 texel = gl_GlobalInvocationID;
  vec3 place = (vec3(texel) + 0.5) / float(kCloudNoiseEdge);
  float smooth_field = 0.5 + 0.5 * (gradient_noise(place, 4, 1u) + 0.5 * gradient_noise(place, 8, 2u));
  float ragged = 0.5 + 0.6 * (gradient_noise(place, 4, 3u) + 0.5 * gradient_noise(place, 8, 4u) + 0.25 * gradient_noise(place, 16, 5u));
  float large = billows(place, 4, 6u), middle = billows(place, 8, 7u), small = billows(place, 16, 8u), least = billows(place, 32, 9u);
  float lumps = 0.625 * large + 0.25 * middle + 0.125 * small;
  // Billows where gradient noise is high (Schneider, The Real-time Volumetric Cloudscapes of Horizon Zero Dawn, 2015).
  float shape = 0.5 * ragged + 0.5 * lumps;
  vec4 value = vec4(shape, 0.625 * middle + 0.375 * small, 0.625 * small + 0.375 * least, smooth_field);
  imageStore(noise, ivec3(texel), clamp(value, 0.0, 1.0));
}

const vec2 kBillowShares = vec2(0.6, 0.4);  // of the small, of the smaller

void pack() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);  // x, z
  vec4 shape, billow;
  for (int i = 0; i < 4; ++i) {
    int slice = int(push.layer * kSlicesPerLayer) + i;
    vec4 value = imageLoad(noise, ivec3(texel.x, slice & int(kCloudNoiseEdge - 1u), texel.y));
    shape[i] = value.r;
    billow[i] = dot(value.gb, kBillowShares);
  }
  imageStore(shapes, texel, shape);
  imageStore(packed_billows, texel, billow);
  if (push.layer != 0u) return;
  // Height 0 is between the last slice and the first.
  float below = imageLoad(noise, ivec3(texel.x, int(kCloudNoiseEdge - 1u), texel.y)).a;
  float above = imageLoad(noise, ivec3(texel.x, 0, texel.y)).a;
  imageStore(weather, texel, vec4(0.5 * (below + above), 0.0, 0.0, 0.0));
}

void main() {
  if (kPack)
    pack();
  else
    fill();
}
