// Normals kept in the G-buffer, for measuring (docs/decisions/0002): how a unit vector becomes an image's texel, and back.
#ifndef SKERRY_STORED_GLSL
#define SKERRY_STORED_GLSL

// Codes of render::NormalStore.
const uint kNormalExact = 0u;       // not stored
const uint kNormalOctahedral = 1u;  // two channels, -1..1
const uint kNormalSigned = 2u;      // x, y, z, -1..1
const uint kNormalUnsigned = 3u;    // x, y, z, 0..1

vec2 signs(vec2 v) { return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }

// Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 2014: the octahedron, its lower half folded outwards.
vec2 octahedral_from_unit(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signs(p);
}
vec3 unit_from_octahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * signs(n.xy);
  return normalize(n);
}

vec4 texel_from_normal(vec3 n, const uint code) {
  if (code == kNormalOctahedral) return vec4(octahedral_from_unit(n), 0.0, 0.0);
  if (code == kNormalUnsigned) return vec4(n * 0.5 + 0.5, 0.0);
  return vec4(n, 0.0);
}
vec3 normal_from_texel(vec4 texel, const uint code) {
  if (code == kNormalOctahedral) return unit_from_octahedral(texel.xy);
  if (code == kNormalUnsigned) return normalize(texel.xyz * 2.0 - 1.0);
  return normalize(texel.xyz);
}
#endif
