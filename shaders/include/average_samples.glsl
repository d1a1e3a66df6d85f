// Body of average_samples.comp and accumulate_part.comp: the radiance of a pixel from that of its samples, their mean, as a sensor's square
// pixel gathers it. docs/settings.md, aa.samples and shadow.samples.
#include "include/common.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(binding = 1, rgba16f) readonly uniform image2D samples;
layout(binding = 2, rgba16f) writeonly uniform image2D radiance;

layout(constant_id = 0) const uint kSamplesPerEdge = 2u;
#ifdef SKERRY_ACCUMULATE
layout(binding = 3, rgba32f) uniform image2D total;
layout(constant_id = 1) const bool kFirst = true;
layout(push_constant) uniform Push { float share; } push;
#endif

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.picture_size))) return;
  vec3 sum = vec3(0.0);
  for (uint y = 0u; y < kSamplesPerEdge; ++y)
    for (uint x = 0u; x < kSamplesPerEdge; ++x) sum += imageLoad(samples, ivec2(pixel * kSamplesPerEdge + uvec2(x, y))).rgb;
  sum /= float(kSamplesPerEdge * kSamplesPerEdge);
#ifdef SKERRY_ACCUMULATE
  sum *= push.share;
  if (!kFirst) sum += imageLoad(total, ivec2(pixel)).rgb;
  imageStore(total, ivec2(pixel), vec4(sum, 1.0));
#endif
  imageStore(radiance, ivec2(pixel), vec4(sum, 1.0));
}
