// Layers of water and glass as they are read. docs/conventions.md.
#ifndef SKERRY_LAYERS_GLSL
#define SKERRY_LAYERS_GLSL

// Depth of a layer's surface, 0 where it has none. @param area pixels of the picture, from xy to before zw: outside of them no layer is
// cleared or drawn.
float layer_depth_at(sampler2D layer, ivec2 pixel, uvec4 area) {
  bool within = all(greaterThanEqual(uvec2(pixel), area.xy)) && all(lessThan(uvec2(pixel), area.zw));
  return within ? texelFetch(layer, pixel, 0).r : 0.0;
}
#endif
