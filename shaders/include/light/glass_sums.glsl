// Of all glass before what is opaque, which a body lights: what sum_glass.frag has added up. Needs before the include: what through_glass.glsl needs,
// `glass_maps`.
#ifndef SKERRY_GLASS_SUMS_GLSL
#define SKERRY_GLASS_SUMS_GLSL
const float kGlassTexels = 1.0;
const float kSearchGrowth = 1.5;
#include "include/light/through_glass.glsl"

vec3 glass_before(ivec2 texel, GlassAt at) { return texelFetch(glass_maps, ivec3(texel, int(at.cascade.glass_layer)), 0).rgb; }
#endif
