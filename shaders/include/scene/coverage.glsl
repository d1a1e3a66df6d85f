// Where a pixel shows a surface.
#ifndef SKERRY_COVERAGE_GLSL
#define SKERRY_COVERAGE_GLSL
#include "shared/constants.h"

layout(constant_id = kDepth16Constant) const bool kDepth16 = false;  // depth was kept in 16 bits

// Whether there is a surface. Depth decides, and words have any value where there is none; but with 16 bits what lies farthest has depth 0
// like the sky, and words are cleared.
bool is_covered(uint word, float depth) { return kDepth16 ? word != 0u : depth > 0.0; }
uint covered_word(uint word, float depth) { return is_covered(word, depth) ? word : 0u; }

// Depth of a surface. What 16 bits round to 0 lies half a step before infinity.
float surface_depth(float depth) { return kDepth16 ? max(depth, 0.5 / 65535.0) : depth; }
#endif
