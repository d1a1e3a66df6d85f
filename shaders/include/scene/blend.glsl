// Pixels in which a section is drawn whose level of detail changes (Section.blend).
#ifndef SKERRY_BLEND_GLSL
#define SKERRY_BLEND_GLSL
#include "shared/geometry.h"

// 0 .. kBlendSteps - 1, each in as many pixels of any area as the others, and neighbours far apart: the R2 sequence of M. Roberts (2018), in whole
// numbers, so that all devices and both levels have the same.
uint blend_step(uvec2 pixel) { return (pixel.x * 3242174889u + pixel.y * 2447445413u) >> 26; }

bool is_blended_out(uint blend, uvec2 pixel) {
  uint own = blend_step(pixel);
  return blend != 0u && (own < blend_first(blend) || own >= blend_end(blend));
}
#endif
