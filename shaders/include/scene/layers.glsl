// Layers of water and glass as they are read. docs/conventions.md.
#ifndef SKERRY_LAYERS_GLSL
#define SKERRY_LAYERS_GLSL

// Depth of a layer's surface, 0 where it has none. @param area pixels of the picture, from xy to before zw: outside of them no layer is
// cleared or drawn.
float layer_depth_at(sampler2D layer, ivec2 pixel, uvec4 area) {
  return in_area(uvec2(pixel), area) ? texelFetch(layer, pixel, 0).r : 0.0;
}

// Whether surfaces of a pixel at two distances along its ray are one: quads of a face overlap by a hundredth of a pixel (draw_quads.vert).
// @param n their normal. @param beside the ray of the next pixel both ways. @param near, far along the view axis.
bool are_one_surface(uint a, uint b, vec3 n, vec3 ray, vec3 beside, float near, float far) {
  return a == b && abs(dot(n, ray)) * (far - near) < length(beside - ray) / 64.0 * far;
}
#endif
