// What the meter's passes share. docs/exposure.md.
#ifndef SKERRY_METER_GLSL
#define SKERRY_METER_GLSL
#include "shared/exposure.h"

// Rec. 709. Summed in this order and never fused, as the CPU does it.
float exact_luminance(vec3 colour) {
  precise float sum = 0.2126 * colour.r + 0.7152 * colour.g;
  precise float all_three = sum + 0.0722 * colour.b;
  return all_three;
}

// Integer hash of two coordinates (M. Jarzynski, M. Olano: Hash Functions for GPU Rendering, 2020: pcg).
uint hashed(uvec2 cell) {
  uint state = (cell.y * 65537u + cell.x) * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

// The pixel of a cell of stride x stride that the meter looks at.
uvec2 metered_pixel(uvec2 cell, uint stride, uvec2 size) {
  uint h = hashed(cell);
  return min(cell * stride + uvec2(h, h >> 16) % stride, size - 1u);
}

// Whether a pixel counts: lit, and not so dimly that no exposure would show it.
bool counts_as_light(float luminance) { return luminance >= exp2(float(kFirstOctave)); }

// @pre counts_as_light(luminance).
uint bin_of(float luminance) { return min((floatBitsToUint(luminance) >> kBinShift) - kFirstBin, kHistogramBins - 1u); }

// log2 of the luminance in the middle of a bin.
float log2_of_bin(uint bin) {
  float place = (float(bin % kBinsPerOctave) + 0.5) / float(kBinsPerOctave);
  return float(kFirstOctave + int(bin / kBinsPerOctave)) + log2(1.0 + place);
}
#endif
