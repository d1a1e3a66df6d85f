// What the meter's passes share. docs/exposure.md.
#ifndef SKERRY_METER_GLSL
#define SKERRY_METER_GLSL
#include "shared/exposure.h"

// Rec. 709. Summed in this order and never fused, as the CPU does it.
float luminance(vec3 colour) {
  precise float sum = 0.2126 * colour.r + 0.7152 * colour.g;
  precise float all_three = sum + 0.0722 * colour.b;
  return all_three;
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
