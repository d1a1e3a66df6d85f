#version 460
#extension GL_GOOGLE_include_directive : require
// Histogram of the luminance of scene radiance, black left out: one pixel of each cell of stride x stride, at a place in it that looks
// random and is always the same. Integer counts: no order of work groups shows. docs/exposure.md.
#include "include/common.glsl"
#include "include/meter.glsl"
#include "shared/bindings.h"

layout(local_size_x = kMeterGroup, local_size_y = kMeterGroup) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kRadianceBinding, rgba16f) readonly uniform image2D radiance;
layout(scalar, binding = kHistogramBinding) buffer Histogram { uint counts[kHistogramBins]; };
layout(push_constant) uniform Push { Metering metering; } push;

shared uint here[kHistogramBins];

// Integer hash of two coordinates (M. Jarzynski, M. Olano: Hash Functions for GPU Rendering, 2020: pcg).
uint hashed(uvec2 cell) {
  uint state = (cell.y * 65537u + cell.x) * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

void main() {
  uint stride = push.metering.stride, thread = gl_LocalInvocationIndex;
  here[thread] = 0u;
  barrier();
  uvec2 cell = gl_GlobalInvocationID.xy, first = cell * stride;
  if (all(lessThan(first, frame.picture_size))) {
    uint h = hashed(cell);
    uvec2 pixel = min(first + uvec2(h, h >> 16) % stride, frame.picture_size - 1u);
    float y = luminance(imageLoad(radiance, ivec2(pixel)).rgb);
    if (counts_as_light(y)) atomicAdd(here[bin_of(y)], 1u);
  }
  barrier();
  if (here[thread] != 0u) atomicAdd(counts[thread], here[thread]);
}
