#version 460
#extension GL_GOOGLE_include_directive : require
// Mixes the coarser levels of bloom's pyramid into a finer one, in place. docs/exposure.md, docs/conventions.md.
#extension GL_EXT_scalar_block_layout : require
#include "shared/bloom.h"
#include "shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kFineBloomBinding, rgba16f) uniform image2D fine;
layout(binding = kCoarseBloomBinding, rgba16f) readonly uniform image2D coarse;
layout(push_constant) uniform Push { BloomStep step; } push;

uvec2 coarse_size() { return push.step.coarse_size; }
#include "include/bloom.glsl"

void main() {
  vec3 spread = spread_from_coarser();
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(push.step.fine_size)))) return;
  imageStore(fine, at, vec4(mix(imageLoad(fine, at).rgb, spread, kBloomShare), 1.0));
}
