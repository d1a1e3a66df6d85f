// Layers of water and glass as they are read. docs/conventions.md.
#ifndef SKERRY_LAYERS_GLSL
#define SKERRY_LAYERS_GLSL

// Depth of a layer's surface, 0 where it has none. @param area pixels of the picture, from xy to before zw: outside of them no layer is
// cleared or drawn.
float layer_depth_at(sampler2D layer, ivec2 pixel, uvec4 area) {
  return in_area(uvec2(pixel), area) ? texelFetch(layer, pixel, 0).r : 0.0;
}
#endif
