// Light of a surface, kept apart from its texture, at the points of a grid: docs/decisions/0030-light-at-fewer-pixels.md.
// What a surface sends to the eye is affine in its albedo, whatever lights it; so it is known from two radiances, that of a black surface (column
// 0) and that of a white one (column 1), which are smooth where textures are not.
#ifndef SKERRY_LIGHT_SAMPLES_GLSL
#define SKERRY_LIGHT_SAMPLES_GLSL

vec3 radiance_at(mat2x3 sent, vec3 albedo) { return sent[0] + albedo * (sent[1] - sent[0]); }

// What a sample lies on, to be told from other surfaces by the pixels around: 15 bits of what is lit alike (island, direction of the face, the
// material but for its texture), whether it is a plant, and the distance along the view axis. 0: sky.

uint mixed(uint hash, uint value) {
  hash = (hash ^ value) * 0x9e3779b1u;
  return hash ^ (hash >> 15);
}

// Plants are lit as level ground is.
uint lit_face(uint word) { return surface_face(word) >= 6u ? 2u : surface_face(word); }

// Never 0.
uint alike_key(uint word) {
  uint key = mixed(mixed(surface_island(word), lit_face(word)), materials[surface_block(word)].light_class);
  return (key & 0x7fffu) | 1u;
}
bool is_plant(uint word) { return surface_face(word) >= 6u; }
uint place_code(uint word, float z) {
  return (alike_key(word) << 17) | (is_plant(word) ? 0x10000u : 0u) | packHalf2x16(vec2(min(z, 65504.0), 0.0));
}
uint place_key(uint code) { return code >> 17; }
bool place_on_plant(uint code) { return (code & 0x10000u) != 0u; }
float place_z(uint code) { return unpackHalf2x16(code).x; }

uvec4 packed_sample(mat2x3 sent, uint code) {
  return uvec4(packHalf2x16(sent[0].xy), packHalf2x16(vec2(sent[0].z, sent[1].x)), packHalf2x16(sent[1].yz), code);
}
mat2x3 sample_of(uvec4 texel) {
  vec2 a = unpackHalf2x16(texel.x), b = unpackHalf2x16(texel.y), c = unpackHalf2x16(texel.z);
  return mat2x3(vec3(a, b.x), vec3(b.y, c));
}
#endif
