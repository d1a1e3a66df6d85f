// The frame's lights and panes, as texels of 128 bits: lavapipe fetches one in the time of a word and a fifth of a storage buffer, and what is not used of a
// light is not fetched.
#ifndef SKERRY_LIGHT_TEXELS_GLSL
#define SKERRY_LIGHT_TEXELS_GLSL
#include "shared/light.h"
#include "shared/bindings.h"

layout(binding = kLightsBinding) uniform usamplerBuffer light_texels;

// @param index below the frame's number of lights.
Light frame_light(uint index) {
  int first = int(index * kLightTexels);
  uvec4 a = texelFetch(light_texels, first), b = texelFetch(light_texels, first + 1), c = texelFetch(light_texels, first + 2);
  uvec4 d = texelFetch(light_texels, first + 3), e = texelFetch(light_texels, first + 4);
  Light light;
  light.position = uintBitsToFloat(a.xyz);
  light.range = uintBitsToFloat(a.w);
  light.intensity = uintBitsToFloat(b.xyz);
  light.kind = b.w;
  light.axis = uintBitsToFloat(c.xyz);
  light.size = uintBitsToFloat(c.w);
  light.cos_inner = uintBitsToFloat(d.x);
  light.cos_outer = uintBitsToFloat(d.y);
  light.first_island = d.z;
  light.island_count = d.w;
  light.reach = e.x;
  light.first_pane = e.y;
  light.pane_count = e.z;
  light.unused = e.w;
  return light;
}
LightPane light_pane(uint light_count, uint index) {
  int first = int(light_count * kLightTexels + index * kPaneTexels);
  uvec4 a = texelFetch(light_texels, first), b = texelFetch(light_texels, first + 1);
  return LightPane(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w);
}
#endif
