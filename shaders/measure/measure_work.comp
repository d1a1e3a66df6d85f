#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
// What one kind of work costs on a device: `skerry bench device`, docs/lavapipe.md, docs/conventions.md.
#include "shared/measure.h"

layout(local_size_x_id = kGroupXConstant, local_size_y_id = kGroupYConstant, local_size_z_id = kGroupZConstant) in;
layout(constant_id = kWorkConstant) const uint kWork = 0u;

layout(binding = kWordsBinding, scalar) readonly buffer Words { uint words[]; };
layout(binding = kUniformWordsBinding, scalar) uniform UniformWords { uint uniform_words[kMeasuredWords]; };
layout(binding = kTexelWordsBinding) uniform usamplerBuffer texel_words;
layout(binding = kImageWordsBinding) uniform usampler2D image_words;
layout(binding = kFilteredBinding) uniform sampler2D filtered;
layout(binding = kSumsBinding, scalar) writeonly buffer Sums { uint sums[]; };
layout(push_constant, scalar) uniform Constants { uint invocations; uint zero; };  // the compiler must not know that zero is 0

// Steps that cannot be folded into one, four chains of them: work that waits for itself would hide what is beside it.
uint arithmetic(uint x) {
  uvec4 chains = uvec4(x, x + 1u, x + 2u, x + 3u);
  for (uint i = 0u; i < 8u; ++i) chains = chains * 1664525u ^ 1013904223u;
  return chains.x ^ chains.y ^ chains.z ^ chains.w;
}

uint other_arithmetic(uint x) {
  uvec4 chains = uvec4(x, x + 5u, x + 6u, x + 7u);
  for (uint i = 0u; i < 8u; ++i) chains = (chains ^ 12345u) * 22695477u;
  return chains.x ^ chains.y ^ chains.z ^ chains.w;
}

uint rounds_of(uint self) {
  if (kWork == kWorkExitOwn) return (self * 7u & 15u) + 1u;
  return kWork == kWorkExitNever ? 16u + zero : 1u + zero;
}

uint step_of(uint self, uint x) {
  // Neighbours load from places of their own, all within the same 16 KiB.
  uint place = (x * 2654435761u >> 16) & (kMeasuredWords - 1u);
  uint one = (x * zero + self * zero) & (kMeasuredWords - 1u);
  if (kWork == kWorkStorage) return words[place];
  if (kWork == kWorkUniform) return uniform_words[place];
  if (kWork == kWorkTexels) return texelFetch(texel_words, int(place >> 2)).x;
  if (kWork == kWorkImage)
    return texelFetch(image_words, ivec2(place % kMeasuredImageEdge, place / kMeasuredImageEdge), 0).x;
  if (kWork == kWorkStorageOne) return words[one];
  if (kWork == kWorkUniformOne) return uniform_words[one];
  if (kWork == kWorkFilter) {
    vec2 at = vec2(place % kMeasuredImageEdge, place / kMeasuredImageEdge) / float(kMeasuredImageEdge);
    return uint(dot(textureLod(filtered, at, 0.0), vec4(255.0)));
  }
  if (kWork == kWorkIndex) return place;
  if (kWork == kWorkBranchNone) {
    if (zero != 0u) return arithmetic(x) ^ other_arithmetic(x);
    return place;
  }
  if (kWork == kWorkBranchBoth || kWork == kWorkBranchOne) {
    uint side = kWork == kWorkBranchBoth ? self & 1u : zero;
    if (side != 0u) return other_arithmetic(x);
    return arithmetic(x);
  }
  if (kWork >= kWorkExitOwn && kWork <= kWorkExitUnrolled) {
    // A compiler unrolls a loop whose most rounds it knows.
    uint rounds = rounds_of(self), most = kWork == kWorkExitUnrolled ? 16u : 16u + zero, y = x;
    for (uint i = 0u; i < most; ++i) {
      if (i >= rounds) break;
      y = y * 1664525u ^ 1013904223u;
    }
    return y;
  }
  return arithmetic(x);
}

void main() {
  uvec3 width = gl_NumWorkGroups * gl_WorkGroupSize;
  uint self = gl_GlobalInvocationID.x + width.x * (gl_GlobalInvocationID.y + width.y * gl_GlobalInvocationID.z);
  if (self >= invocations) return;
  uint sum = self;
  for (uint i = 0u; i < kMeasuredSteps; ++i) sum += step_of(self, sum + i);
  sums[self] = sum;
}
