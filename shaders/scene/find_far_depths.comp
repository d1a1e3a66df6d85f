#version 460
#extension GL_GOOGLE_include_directive : require
// The farthest depth of each square of pixels, fine and coarse (kFineDepthEdge): what lies behind it is hidden. One work group a coarse square.
// docs/decisions/0050.
#include "include/frame/common.glsl"
#include "shared/bindings.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(scalar, binding = kFarDepthsBinding) writeonly buffer FarDepths { float far_depths[]; };

shared float of_square[64];

void main() {
  uvec2 fine_count = (frame.size + (kFineDepthEdge - 1u)) / kFineDepthEdge;
  uvec2 coarse_count = (frame.size + (kCoarseDepthEdge - 1u)) / kCoarseDepthEdge;
  uint lane = gl_LocalInvocationIndex;
  uvec2 fine = gl_WorkGroupID.xy * 8u + uvec2(lane & 7u, lane >> 3);
  float farthest = 1.0;  // reverse depth: 0 is the sky
  if (all(lessThan(fine, fine_count))) {
    uvec2 low = fine * kFineDepthEdge, high = min(low + kFineDepthEdge, frame.size);
    for (uint y = low.y; y < high.y; ++y)
      for (uint x = low.x; x < high.x; ++x) farthest = min(farthest, texelFetch(depths, ivec2(x, y), 0).r);
    far_depths[fine.y * fine_count.x + fine.x] = farthest;
  }
  of_square[lane] = farthest;
  barrier();
  if (lane != 0u) return;
  for (uint i = 1u; i < 64u; ++i) farthest = min(farthest, of_square[i]);
  far_depths[fine_count.x * fine_count.y + gl_WorkGroupID.y * coarse_count.x + gl_WorkGroupID.x] = farthest;
}
