#ifndef SKERRY_HALVES_GLSL
#define SKERRY_HALVES_GLSL
// What an image of 16-bit floats keeps of a colour. Rounded before the store, since how a store rounds differs from driver to driver.
vec3 as_halves(vec3 c) { return vec3(unpackHalf2x16(packHalf2x16(c.rg)), unpackHalf2x16(packHalf2x16(vec2(c.b, 0.0))).x); }
#endif
