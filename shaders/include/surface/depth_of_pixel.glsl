// How deep under water lies what a pixel shows. Needs before the include: under_water.glsl, `under_water`.
#ifndef SKERRY_DEPTH_OF_PIXEL_GLSL
#define SKERRY_DEPTH_OF_PIXEL_GLSL

// Of what a pixel shows behind water and glass, if the nearest of them is level water, or that which the eye is in. @param word of the surface,
// which is taken to belong to the island whose water it is.
Depth depth_of_pixel(uvec2 pixel, uint word, vec3 p) {
  if (!kUnderWater) return no_depth();
  uint above = in_area(pixel, frame.layers_area) ? texelFetch(under_water, ivec2(pixel), 0).r : 0u;
  Depth depth = depth_below(unpackHalf2x16(above).y, surface_island(word), above & 0x3ffu);
  if (frame.camera_medium != 0u && above == 0u) depth = depth_in_medium(p);
  return depth;
}
#endif
