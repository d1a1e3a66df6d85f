// Light of the sky and weak lamps on a surface, as far as the corners of its face see it. Layout: shared/indirect.h.
// Needs before the include: lighting.glsl, `island_at()`.
#ifndef SKERRY_INDIRECT_GLSL
#define SKERRY_INDIRECT_GLSL

// If the sky gives no light, a texel is bound that is never read.
layout(binding = kIndirectBinding) uniform usamplerBuffer indirect_texels;
layout(binding = kIslandSkiesBinding) uniform usamplerBuffer island_skies;

uvec4 indirect_texel(bool known, uint index) { return texelFetch(indirect_texels, int(known ? index : 0u)); }

// Where a surface's record is; 0: it has none.
uint sky_record(uvec4 grid, uint face, ivec3 voxel) {
  ivec3 low = (ivec3(grid.x) << ivec3(22, 12, 2)) >> 22;
  ivec3 size = ivec3(grid.y & 255u, (grid.y >> 8) & 255u, (grid.y >> 16) & 255u);
  ivec3 chunk = (voxel >> 6) - low;
  bool known = grid.w == kIndirectFaces && all(lessThan(uvec3(chunk), uvec3(size)));
  uint table = grid.z + uint((chunk.y * size.x + chunk.x) * size.z + chunk.z) * kIndirectTableTexels;
  ivec3 brick = (voxel >> 3) & 7;
  uvec4 bricks = indirect_texel(known, table + uint(brick.y * 16 + brick.x * 2 + (brick.z >> 2)));
  uint first = (brick.z & 2) != 0 ? ((brick.z & 1) != 0 ? bricks.w : bricks.z) : ((brick.z & 1) != 0 ? bricks.y : bricks.x);
  known = known && first != 0u;
  uvec4 masks = indirect_texel(known, first + face * 8u + uint(voxel.y & 7));
  bool far = (voxel.x & 4) != 0;
  uint mask = far ? masks.y : masks.x, record = far ? masks.w : masks.z;
  uint bit = uint((voxel.z & 7) + 8 * (voxel.x & 3));
  known = known && ((mask >> bit) & 1u) != 0u;
  uint unlisted = grid.w == kIndirectOpen ? kIndirectOpenRecord : 0u;
  return known ? record + kIndirectRecordTexels * bitCount(mask & ((1u << bit) - 1u)) : unlisted;
}

// Three numbers with a shared exponent.
vec3 shared_exponent(uint word) { return vec3(word & 511u, (word >> 9) & 511u, (word >> 18) & 511u) * exp2(float(word >> 27) - 24.0); }

// Light of sky, sun and moon that other faces reflect. @param bounce a record's texel. @param at place between its corners.
vec3 bounced_light(uvec4 bounce, uint island, vec2 at) {
  vec4 h_a = unpackSnorm4x8(bounce.z) * kMostBounceShape, h_b = unpackSnorm4x8(bounce.w) * kMostBounceShape;
  uint first = island * kIndirectIslandTexels + kIndirectHarmonics;
  vec3 sum = uintBitsToFloat(texelFetch(island_skies, int(first + 3u)).xyz);
  for (uint channel = 0u; channel < 3u; ++channel) {
    uvec4 e = texelFetch(island_skies, int(first + channel));
    sum[channel] += dot(h_a, vec4(unpackHalf2x16(e.x), unpackHalf2x16(e.y))) + dot(h_b, vec4(unpackHalf2x16(e.z), unpackHalf2x16(e.w)));
  }
  vec4 shares = unpackUnorm4x8(bounce.y);
  return shared_exponent(bounce.x) * max(sum, 0.0) * mix(mix(shares.x, shares.y, at.x), mix(shares.z, shares.w, at.x), at.y);
}

struct SkyLight {
  vec3 irradiance;  // of the surface's face
  float seen;       // share of the face's sky, 0..1
};

// Light of the sky and of weak lamps on a surface, as if it were matt. @param word of the G-buffer.
SkyLight light_of_sky(Surface s, uint word) {
  if (kIndirect == kIndirectOff) return SkyLight(vec3(0.0), 0.0);
  vec3 lattice = lattice_from_world(island_at(surface_island(word)), s.position);
  uint island = surface_island(word), face = surface_face(word);
  uvec4 grid = indirect_texel(true, island);
  bool plant = face >= 6u;
  face = plant ? 2u : face;
  vec3 place = lattice * exp2(-float(grid.y >> 24));
  // Of a face, the voxel behind it; of a plant, its own.
  ivec3 voxel = ivec3(floor(plant ? place + vec3(0.0, 0.001, 0.0) : place - 0.5 * face_normal(face)));
  uint record = sky_record(grid, face, voxel);
  uvec4 near = indirect_texel(record != 0u, record), far = indirect_texel(record != 0u, record + 1u);
  vec3 in_voxel = clamp(place - vec3(voxel), 0.0, 1.0);
  vec2 at = face < 2u ? in_voxel.yz : face < 4u ? in_voxel.zx : in_voxel.xy;
  vec4 seen_a = mix(mix(unpackUnorm4x8(near.x), unpackUnorm4x8(near.z), at.x), mix(unpackUnorm4x8(far.x), unpackUnorm4x8(far.z), at.x), at.y);
  vec4 seen_b = mix(mix(unpackUnorm4x8(near.y), unpackUnorm4x8(near.w), at.x), mix(unpackUnorm4x8(far.y), unpackUnorm4x8(far.w), at.x), at.y);
  vec3 sum;
  for (uint channel = 0u; channel < 3u; ++channel) {
    uvec4 lobes = texelFetch(island_skies, int(island * kIndirectIslandTexels + face * kIndirectSkyTexels + channel));
    sum[channel] = dot(seen_a, vec4(unpackHalf2x16(lobes.x), unpackHalf2x16(lobes.y))) +
                   dot(seen_b, vec4(unpackHalf2x16(lobes.z), unpackHalf2x16(lobes.w)));
  }
  if (kIndirect == kIndirectFull) {
    uvec4 lamps = indirect_texel(record != 0u, record + 2u);
    sum += mix(mix(shared_exponent(lamps.x), shared_exponent(lamps.y), at.x), mix(shared_exponent(lamps.z), shared_exponent(lamps.w), at.x), at.y);
    sum += bounced_light(indirect_texel(record != 0u, record + 3u), island, at);
  }
  float open = dot(seen_a + seen_b, vec4(1.0 / float(kSkyLobes)));
  return record != 0u ? SkyLight(sum, open) : SkyLight(vec3(0.0), 0.0);
}
#endif
