#version 460
#extension GL_GOOGLE_include_directive : require
// Clouds along the rays of every second pixel each way. docs/clouds.md, docs/conventions.md.
#include "include/sky/cloud_view.glsl"
#include "shared/bindings.h"

layout(binding = kCoarseCloudsBinding, rgba16f) writeonly uniform image2D coarse;

void main() {
  uvec2 size = (frame.size + 1u) / 2u;
  uvec2 texel = gl_GlobalInvocationID.xy;
  bool here = all(lessThan(texel, size));
  uvec2 pixel = min(texel * 2u, frame.size - 1u);
  vec2 way = open_way(pixel);
  if (!here) way = vec2(0.0);
  Clouded seen = clouds_seen(pixel, way, gradient_jitter(texel));
  if (here) imageStore(coarse, ivec2(texel), vec4(min(seen.light, vec3(kMaxRadiance)), seen.clear));
}
