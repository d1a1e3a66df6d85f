#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance to the picture, with bloom if there is any. docs/exposure.md, docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/bloom.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kRadianceBinding, rgba16f) readonly uniform image2D radiance;
layout(constant_id = kBloomConstant) const bool kBloom = false;  // if not, something is bound in place of its image
layout(binding = kCoarseBloomBinding, rgba16f) readonly uniform image2D coarse;
layout(push_constant) uniform Push { BloomStep step; } push;
uvec2 coarse_size() { return push.step.coarse_size; }
const int kTileTexels = 128;
#include "include/post/bloom.glsl"
layout(constant_id = kColumnsConstant) const bool kColumns = false;  // by columns of pixels, without shared memory

#include "include/frame/pixel_stats.glsl"
#include "include/post/picture.glsl"

// @param glow as its coarser level is.
void put_spread(uvec2 pixel, vec3 glow) {
  bool here = all(lessThan(pixel, frame.size));
  vec3 colour = imageLoad(radiance, ivec2(min(pixel, frame.size - 1u))).rgb;
  count_non_finite(here && !finite3(colour));
  colour = sanitised(colour);
  count_black(here && colour == vec3(0.0), false);
  if (here) put_developed(pixel, developed(colour, push.step.intensity * glow));
}
#include "include/post/bloom_columns.glsl"

void main() {
  if (kColumns)
    spread_columns();
  else
    put_spread(gl_GlobalInvocationID.xy, kBloom ? spread_from_coarser() : vec3(0.0));
}
