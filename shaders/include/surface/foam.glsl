// Foam where level water meets land. Needs before the include: ripples.glsl, occupancy.glsl. docs/conventions.md.
#ifndef SKERRY_FOAM_GLSL
#define SKERRY_FOAM_GLSL

layout(constant_id = kFoamConstant) const bool kFoam = false;  // voxels are known

const float kFoamAlbedo = 0.8, kMostFoam = 0.8;

// Blocks to the nearest opaque voxel beside the one that a point of level water lies in, as far as foam may reach: less than half a block.
float blocks_to_land(uint island, vec3 lattice) {
  VoxelGrid grid = voxel_grid(island);
  FacePlace at = face_place(2u, lattice * grid.per_block);
  ivec3 voxel = at.voxel - ivec3(0, 1, 0);
  ivec2 side = ivec2(at.in_face.x < 0.5 ? -1 : 1, at.in_face.y < 0.5 ? -1 : 1);
  vec2 to = min(at.in_face, 1.0 - at.in_face);
  float least = voxel_opaque(grid, voxel) ? 0.0 : 1.0;  // by rounding
  least = voxel_opaque(grid, voxel + ivec3(side.x, 0, 0)) ? min(least, to.x) : least;
  least = voxel_opaque(grid, voxel + ivec3(0, 0, side.y)) ? min(least, to.y) : least;
  least = voxel_opaque(grid, voxel + ivec3(side.x, 0, side.y)) ? min(least, length(to)) : least;
  return least / grid.per_block;
}

// How far foam reaches from land [blocks]: two waves along the shore, whose periods divide an hour, after which time_s repeats.
float foam_width(vec2 lattice) {
  vec2 phase = vec2(dot(vec2(2.7, 1.9), lattice), dot(vec2(-3.8, 4.6), lattice)) + frame.time_s * 6.28318530718 * vec2(0.25, 0.4);
  return 0.2 + dot(vec2(0.06, 0.05), sin(phase));
}

// Share of a surface that foam covers. @param t of the surface along `ray`.
float foam_cover(uint word, vec3 ray, float t) {
  if (!kFoam) return 0.0;
  bool level = has_ripples(word) && surface_face(word) == 2u;
  uint island = surface_island(word);
  vec3 lattice = lattice_from_world(island_at(island), ray * t);
  float width = foam_width(lattice.xz), land = blocks_to_land(island, lattice);
  return level ? kMostFoam * clamp((width - land) / (0.6 * width), 0.0, 1.0) * fading(t * length(ray)) : 0.0;
}
#endif
