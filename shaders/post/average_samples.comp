#version 460
#extension GL_GOOGLE_include_directive : require
// The radiance of a pixel from that of its samples, their mean, as a sensor's square
// pixel gathers it. docs/settings.md, aa.samples and shadow.samples; docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kSamplesBinding, rgba16f) readonly uniform image2D samples;
layout(binding = kRadianceBinding, rgba16f) writeonly uniform image2D radiance;

layout(constant_id = kSamplesPerEdgeConstant) const uint kSamplesPerEdge = 2u;
// A picture has several parts: each adds its share to the sum of those before. If not, one texel is bound in place of the sum.
layout(constant_id = kAccumulateConstant) const bool kAccumulate = false;
layout(binding = kTotalBinding, rgba32f) uniform image2D total;
layout(constant_id = kFirstConstant) const bool kFirst = true;
layout(push_constant) uniform Push { float share; } push;

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.picture_size))) return;
  vec3 sum = vec3(0.0);
  for (uint y = 0u; y < kSamplesPerEdge; ++y)
    for (uint x = 0u; x < kSamplesPerEdge; ++x) sum += imageLoad(samples, ivec2(pixel * kSamplesPerEdge + uvec2(x, y))).rgb;
  sum /= float(kSamplesPerEdge * kSamplesPerEdge);
  if (kAccumulate) {
    sum *= push.share;
    if (!kFirst) sum += imageLoad(total, ivec2(pixel)).rgb;
    imageStore(total, ivec2(pixel), vec4(sum, 1.0));
  }
  imageStore(radiance, ivec2(pixel), vec4(sum, 1.0));
}
