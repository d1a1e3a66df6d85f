// Of the glass before a place that is translucent itself: by the surfaces that list_glass.frag has found. Needs before the include: what
// through_glass.glsl needs, media.glsl, `glass_lists`, `materials`. docs/decisions/0090.
#ifndef SKERRY_GLASS_LISTS_GLSL
#define SKERRY_GLASS_LISTS_GLSL
const float kGlassTexels = kListedTexels;
const float kSearchGrowth = 3.0;  // fewer rounds: each looks at kListedGlass surfaces in eight places
#include "include/light/through_glass.glsl"
#include "include/light/listed_glass.glsl"

// Each surface counts its way to the place, positive where glass begins and negative where it ends.
vec3 glass_before(ivec2 texel, GlassAt at) {
  float end = at.here + dot(at.slope, vec2(texel) + 0.5 - at.place);
  vec3 depth = vec3(0.0);
  for (uint i = 0u; i < kListedGlass; ++i) {
    uvec2 found = texelFetch(glass_lists, ivec3(texel, int(at.cascade.glass_layer * kListedGlass + i)), 0).rg;
    float z = uintBitsToFloat(found.x);
    if (z <= end) break;
    vec3 begun = glass_extinction(entered_glass(found.y)) - glass_extinction(left_glass(found.y));
    depth += begun * ((z - end) / at.cascade.depth_per_block);
  }
  return depth;
}
#endif
