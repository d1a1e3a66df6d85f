#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// Fills the sky-view table, kSkyLutWidth x kSkyLutHeight, once whenever sun or moon have moved.
#include "include/sky.glsl"

layout(local_size_x = kSkyLutGroup, local_size_y = kSkyLutGroup) in;

layout(scalar, binding = 0) uniform Sky { SkyConstants sky; };
layout(binding = 1, rgba16f) writeonly uniform image2D sky_lut;

void main() {
  uvec2 texel = gl_GlobalInvocationID.xy;
  uvec2 size = uvec2(kSkyLutWidth, kSkyLutHeight);
  if (any(greaterThanEqual(texel, size))) return;
  vec3 dir = dir_from_sky_lut(vec2(texel) / vec2(size - 1u));
  imageStore(sky_lut, ivec2(texel), vec4(sky_radiance(dir, sky), 1.0));
}
