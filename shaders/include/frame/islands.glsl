// Where islands are: their transforms as texels, since a uniform buffer holds no more than 1,365 of them.
// Needs before the include: common.glsl.
#ifndef SKERRY_ISLANDS_GLSL
#define SKERRY_ISLANDS_GLSL
#include "shared/bindings.h"

layout(binding = kIslandsBinding) uniform usamplerBuffer island_texels;

IslandTransform island_at(uint island) {
  int first = int(island * kIslandTexels);
  uvec4 a = texelFetch(island_texels, first), b = texelFetch(island_texels, first + 1), c = texelFetch(island_texels, first + 2);
  return IslandTransform(uintBitsToFloat(a.xyz), uintBitsToFloat(uvec3(a.w, b.xy)), uintBitsToFloat(uvec3(b.zw, c.x)), uintBitsToFloat(c.yzw));
}
#endif
