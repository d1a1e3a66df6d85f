// Light of the sky and weak lamps on a surface, as far as the corners of its face see it. Layout: shared/indirect.h.
// Needs before the include: lighting.glsl, `island_at()`.
#ifndef SKERRY_INDIRECT_GLSL
#define SKERRY_INDIRECT_GLSL

// If the sky gives no light, a texel is bound that is never read.
layout(binding = kIndirectBinding) uniform usamplerBuffer indirect_texels;
layout(binding = kIslandSkiesBinding) uniform usamplerBuffer island_skies;

uvec4 indirect_texel(bool known, uint index) { return texelFetch(indirect_texels, int(known ? index : 0u)); }

const uint kRecordParts = kIndirectTinted | kIndirectKeyed;
// How many of them.
uint record_parts(uint record) { return (record >> 31) + ((record >> 30) & 1u); }

// Where a surface's record is, with kRecordParts; 0: it has none.
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
  uint parts = first & kRecordParts;
  uvec4 masks = indirect_texel(known, (first ^ parts) + face * 8u + uint(voxel.y & 7));
  bool far = (voxel.x & 4) != 0;
  uint mask = far ? masks.y : masks.x, record = far ? masks.w : masks.z;
  uint bit = uint((voxel.z & 7) + 8 * (voxel.x & 3));
  known = known && ((mask >> bit) & 1u) != 0u;
  uint unlisted = grid.w == kIndirectOpen ? kIndirectOpenRecord : 0u;
  uint texels = kIndirectRecordTexels + record_parts(parts);
  return known ? (record + texels * bitCount(mask & ((1u << bit) - 1u))) | parts : unlisted;
}

// Three numbers with a shared exponent.
vec3 shared_exponent(uint word) { return vec3(word & 511u, (word >> 9) & 511u, (word >> 18) & 511u) * exp2(float(word >> 27) - 24.0); }

// The first texel of what the sky sends to an island.
uint island_sky(uint island) { return texelFetch(island_skies, int(island >> 2))[island & 3u]; }

// Light of sky, sun and moon that other faces reflect. @param bounce a record's texel. @param at place between its corners.
vec3 bounced_light(uvec4 bounce, uint island, vec2 at) {
  vec4 h_a = unpackSnorm4x8(bounce.z) * kMostBounceShape, h_b = unpackSnorm4x8(bounce.w) * kMostBounceShape;
  uint first = island_sky(island) + kIndirectHarmonics;
  vec3 sum = uintBitsToFloat(texelFetch(island_skies, int(first + 3u)).xyz);
  for (uint channel = 0u; channel < 3u; ++channel) {
    uvec4 e = texelFetch(island_skies, int(first + channel));
    sum[channel] += dot(h_a, vec4(unpackHalf2x16(e.x), unpackHalf2x16(e.y))) + dot(h_b, vec4(unpackHalf2x16(e.z), unpackHalf2x16(e.w)));
  }
  vec4 shares = unpackUnorm4x8(bounce.y);
  return shared_exponent(bounce.x) * max(sum, 0.0) * mix(mix(shares.x, shares.y, at.x), mix(shares.z, shares.w, at.x), at.y);
}

// Light of sun and moon that other faces reflect, as followed from key directions. @param keyed a record's texel.
vec3 keyed_light(uvec4 keyed, uint island, vec2 at) {
  uint first = island_sky(island) + kIndirectKeys;
  vec3 bodies_0 = uintBitsToFloat(texelFetch(island_skies, int(first)).xyz), bodies_1 = uintBitsToFloat(texelFetch(island_skies, int(first + 1u)).xyz);
  vec4 shares_0 = unpackUnorm4x8(keyed.y), shares_1 = unpackUnorm4x8(keyed.w);
  return shared_exponent(keyed.x) * bodies_0 * mix(mix(shares_0.x, shares_0.y, at.x), mix(shares_0.z, shares_0.w, at.x), at.y) +
         shared_exponent(keyed.z) * bodies_1 * mix(mix(shares_1.x, shares_1.y, at.x), mix(shares_1.z, shares_1.w, at.x), at.y);
}

// Pixels' middles lie past a face's edge where a rasteriser has rounded its corners, to 1/256 of a pixel.
const float kNearEdge = 1.0 / 64.0;  // of a voxel

// The record of the face at a place; of a face that has none, what a face beside it has of which the place is on the edge.
// @param voxel what the place is in; out: that of the record. @return 0: none.
uint record_at(uvec4 grid, uint face, vec3 place, inout ivec3 voxel) {
  ivec3 first = voxel;
  vec3 in_voxel = place - vec3(first);
  ivec3 beside = ivec3(lessThan(1.0 - in_voxel, vec3(kNearEdge))) - ivec3(lessThan(in_voxel, vec3(kNearEdge)));
  uint axis = face >> 1;
  beside[axis] = 0;
  uint most = beside != ivec3(0) ? 4u : 1u;  // a number that the compiler does not know: lavapipe leaves no loop early that it has unrolled
  uint record = 0u;
  for (uint i = 0u; i < most && record == 0u; ++i) {
    int u = int(i & 1u), v = int(i >> 1);
    voxel = first + beside * (axis == 0u ? ivec3(0, u, v) : axis == 1u ? ivec3(v, 0, u) : ivec3(u, v, 0));
    record = sky_record(grid, face, voxel);
  }
  return record;
}

struct SkyLight {
  vec3 irradiance;  // of the surface's face
  float seen;       // share of the face's sky, 0..1
};

// What a place of a face knows of its surroundings.
struct FaceSky {
  vec3 irradiance;  // of sky and weak lamps, and what other faces reflect
  vec3 lamps;       // of it, weak lamps and what is reflected of lamps
  vec3 bounced;     // of it, what other faces reflect of sky, sun and moon
  vec4 seen_a;      // share of each lobe of the sky that is seen, 0..1
  vec4 seen_b;
  vec3 tint;        // what glass makes of the sky's colour
  bool known;       // else all is 0
};

// As if the surface were matt. @param word of the G-buffer, or of a translucent face that is seen from in front.
FaceSky sky_of_face(vec3 position, uint word) {
  vec3 lattice = lattice_from_world(island_at(surface_island(word)), position);
  uint island = surface_island(word), face = surface_face(word);
  uvec4 grid = indirect_texel(true, island);
  bool plant = face >= 6u;
  face = plant ? 2u : face;
  vec3 place = lattice * exp2(-float(grid.y >> 24));
  // Of a face, the voxel behind it; of a plant, its own.
  ivec3 voxel = ivec3(floor(plant ? place + vec3(0.0, 0.001, 0.0) : place - 0.5 * face_normal(face)));
  uint record = record_at(grid, face, place, voxel), tinted = record >> 31, parts = record_parts(record);
  bool keyed = (record & kIndirectKeyed) != 0u;
  record &= ~kRecordParts;
  uvec4 near = indirect_texel(record != 0u, record), far = indirect_texel(record != 0u, record + 1u);
  vec3 in_voxel = clamp(place - vec3(voxel), 0.0, 1.0);
  vec2 at = face < 2u ? in_voxel.yz : face < 4u ? in_voxel.zx : in_voxel.xy;
  FaceSky sky;
  sky.known = record != 0u;
  sky.seen_a = mix(mix(unpackUnorm4x8(near.x), unpackUnorm4x8(near.z), at.x), mix(unpackUnorm4x8(far.x), unpackUnorm4x8(far.z), at.x), at.y);
  sky.seen_b = mix(mix(unpackUnorm4x8(near.y), unpackUnorm4x8(near.w), at.x), mix(unpackUnorm4x8(far.y), unpackUnorm4x8(far.w), at.x), at.y);
  uint first = island_sky(island) + face * kIndirectSkyTexels;
  for (uint channel = 0u; channel < 3u; ++channel) {
    uvec4 lobes = texelFetch(island_skies, int(first + channel));
    sky.irradiance[channel] = dot(sky.seen_a, vec4(unpackHalf2x16(lobes.x), unpackHalf2x16(lobes.y))) +
                              dot(sky.seen_b, vec4(unpackHalf2x16(lobes.z), unpackHalf2x16(lobes.w)));
  }
  // A loop that ends at once where nothing is tinted: lavapipe runs all that an `if` holds.
  sky.tint = vec3(1.0);
  for (; tinted != 0u; --tinted) {
    uvec4 tint = indirect_texel(true, record + kIndirectRecordTexels + parts - 1u);
    sky.tint = mix(mix(shared_exponent(tint.x), shared_exponent(tint.y), at.x), mix(shared_exponent(tint.z), shared_exponent(tint.w), at.x), at.y);
  }
  sky.irradiance *= sky.tint;
  sky.bounced = sky.lamps = vec3(0.0);
  if (kIndirect == kIndirectFull) {
    uvec4 lamps = indirect_texel(record != 0u, record + 2u);
    sky.lamps = mix(mix(shared_exponent(lamps.x), shared_exponent(lamps.y), at.x), mix(shared_exponent(lamps.z), shared_exponent(lamps.w), at.x), at.y);
    sky.bounced = bounced_light(indirect_texel(record != 0u, record + 3u), island, at);
    if (keyed) sky.bounced += keyed_light(indirect_texel(keyed, record + kIndirectRecordTexels), island, at);
    sky.irradiance += sky.lamps + sky.bounced;
  }
  if (!sky.known) {
    sky.irradiance = sky.bounced = sky.lamps = vec3(0.0);
    sky.seen_a = sky.seen_b = vec4(0.0);
  }
  return sky;
}

// Share of the face's sky that is seen, 0..1.
float open_share(FaceSky sky, uint face) {
  vec4 parts = face >> 1 == 1u || face >= 6u ? vec4(0.125) : vec4(vec3(1.0 / 12.0), 0.25);
  return dot(sky.seen_a + sky.seen_b, parts);
}

// Share of the sky about one direction that is seen: between the lobes about it. @param lattice unit, before the face.
float seen_towards(FaceSky sky, uint face, vec3 lattice) {
  uint axis = face >> 1;
  vec2 along = axis == 0u ? lattice.yz : axis == 1u ? lattice.zx : lattice.yx;
  vec2 positive = 0.5 + 0.5 * along * inversesqrt(max(dot(along, along), 1e-12));
  float steep = smoothstep(kSteepSine - 0.2, kSteepSine + 0.2, abs(lattice.y));
  if (axis != 1u) {
    float below = smoothstep(-0.1, 0.1, -lattice.y), low = (1.0 - smoothstep(kLowSine - 0.1, kLowSine + 0.1, lattice.y)) * (1.0 - below);
    vec4 parts = vec4(steep * (1.0 - below), 0.0, low, below);
    parts.y = 1.0 - parts.x - low - below;
    return dot(mix(sky.seen_b, sky.seen_a, positive.y), parts);
  }
  vec2 quarters_a = mix(sky.seen_a.yw, sky.seen_a.xz, steep), quarters_b = mix(sky.seen_b.yw, sky.seen_b.xz, steep);
  return mix(mix(quarters_b.y, quarters_b.x, positive.x), mix(quarters_a.y, quarters_a.x, positive.x), positive.y);
}

// Light of the sky and of weak lamps on a surface, as if it were matt. @param word of the G-buffer.
// @param share of what does not come from lamps, that is left on its way.
SkyLight light_of_sky(Surface s, uint word, vec3 share) {
  if (kIndirect == kIndirectOff) return SkyLight(vec3(0.0), 0.0);
  FaceSky sky = sky_of_face(s.position, word);
  return SkyLight((sky.irradiance - sky.lamps) * share + sky.lamps, open_share(sky, surface_face(word)));
}
#endif
