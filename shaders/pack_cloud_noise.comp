#version 460
#extension GL_GOOGLE_include_directive : require
// Lays the cloud layer's noise out as a march asks for it: a texel holds four slices of height, so that a blend of eight texels is one of four; and the
// weather, which is asked for at height 0 alone. What a ray asks for lies close together, for waiting for memory is most of what it costs on CPUs.
// docs/clouds.md.
#include "shared/clouds.h"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kCloudNoiseBinding) uniform sampler3D noise;
layout(binding = kCloudWeatherBinding, rgba8) writeonly uniform image2D weather;
layout(binding = kCloudShapesBinding, rgba8) writeonly uniform image2D shapes;  // the layer that is filled
layout(binding = kCloudBillowsBinding, rgba8) writeonly uniform image2D billows;
layout(push_constant) uniform Push { uint layer; } push;

const vec2 kBillowShares = vec2(0.6, 0.4);  // of the small, of the smaller

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);  // x, z
  vec4 shape, billow;
  for (int i = 0; i < 4; ++i) {
    int slice = int(push.layer * kSlicesPerLayer) + i;
    vec4 value = texelFetch(noise, ivec3(texel.x, slice & int(kCloudNoiseEdge - 1u), texel.y), 0);
    shape[i] = value.r;
    billow[i] = dot(value.gb, kBillowShares);
  }
  imageStore(shapes, texel, shape);
  imageStore(billows, texel, billow);
  if (push.layer != 0u) return;
  // Height 0 is between the last slice and the first.
  float below = texelFetch(noise, ivec3(texel.x, int(kCloudNoiseEdge - 1u), texel.y), 0).a;
  float above = texelFetch(noise, ivec3(texel.x, 0, texel.y), 0).a;
  imageStore(weather, texel, vec4(0.5 * (below + above), 0.0, 0.0, 0.0));
}
