// Light of a surface, kept apart from its texture, at the pixels of levels that get finer: docs/decisions/0030-light-at-fewer-pixels.md.
// What a surface sends to the eye is affine in its albedo, whatever lights it; so it is known from two radiances, that of a black surface (column
// 0) and that of a white one (column 1), which are smooth where textures are not.
#ifndef SKERRY_LIGHT_SAMPLES_GLSL
#define SKERRY_LIGHT_SAMPLES_GLSL

vec3 radiance_at(mat2x3 sent, vec3 albedo) { return sent[0] + albedo * (sent[1] - sent[0]); }

const uint kNoSurface = 0u;  // key of a point that shows sky

uint mixed(uint hash, uint value) {
  hash = (hash ^ value) * 0x9e3779b1u;
  return hash ^ (hash >> 15);
}

// Says which plane a pixel shows: equal for the pixels of one block id, face, island and plane of its lattice. A plant's light changes from voxel
// to voxel. @param lattice the point [blocks].
uint plane_key(uint word, vec3 lattice) {
  uint face = surface_face(word);
  ivec3 voxel = ivec3(floor(lattice + vec3(0.0, 0.001, 0.0)));
  float along = face < 2u ? lattice.x : face < 4u ? lattice.y : lattice.z;
  ivec3 place = face >= 6u ? voxel : ivec3(int(round(along)), 0, 0);
  return mixed(mixed(mixed(word, uint(place.x)), uint(place.y)), uint(place.z)) | 1u;
}

uvec4 packed_sample(mat2x3 sent, uint key) {
  return uvec4(packHalf2x16(sent[0].xy), packHalf2x16(vec2(sent[0].z, sent[1].x)), packHalf2x16(sent[1].yz), key);
}
mat2x3 sample_of(uvec4 texel) {
  vec2 a = unpackHalf2x16(texel.x), b = unpackHalf2x16(texel.y), c = unpackHalf2x16(texel.z);
  return mat2x3(vec3(a, b.x), vec3(b.y, c));
}
#endif
