// What media do to the light that comes to what a pixel shows. Needs before the include: under_water.glsl, `media_light`,
// `layer_depths`.
#ifndef SKERRY_DEPTH_OF_PIXEL_GLSL
#define SKERRY_DEPTH_OF_PIXEL_GLSL
#include "include/scene/layers.glsl"
#include "include/surface/packed_share.glsl"

// How deep lies what a pixel shows behind water and glass, if the nearest of them is level water, or that which the eye is in; and what glass on
// its way leaves of a body's light. @param word of the surface, which is taken to belong to the island whose water it is.
Depth depth_of_pixel(uvec2 pixel, uint word, vec3 p) {
  if (!kUnderWater && !kGlass) return no_depth();
  // Without glass only pixels of tiles with layers are written.
  bool known = kGlass || layer_depth_at(layer_depths, ivec2(pixel), frame.layers_area) > 0.0;
  uvec2 found = known ? texelFetch(media_light, ivec2(pixel), 0).rg : uvec2(0u);
  Depth depth = no_depth();
  if (kUnderWater) {
    depth = depth_below(unpackHalf2x16(found.x).y, surface_island(word), found.x & 0x3ffu);
    if (frame.camera_medium != 0u && found.x == 0u) depth = depth_in_medium(p);
  }
  if (kGlass) depth.through_glass = unpacked_share(found.y);
  return depth;
}
#endif
