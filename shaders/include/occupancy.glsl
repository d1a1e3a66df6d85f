// Which voxels are opaque: look-up, how open a corner is, and a march through an island's lattice. Layout: shared/occupancy.h.
// Coordinates here are in voxels of the island's level of detail: its lattice over the edge of a voxel.
// Needs before the include: common.glsl.
#ifndef SKERRY_OCCUPANCY_GLSL
#define SKERRY_OCCUPANCY_GLSL
#include "shared/occupancy.h"

layout(scalar, binding = 22) readonly buffer OccupancyGrids { OccupancyGrid occupancy_grids[]; };
layout(scalar, binding = 23) readonly buffer OccupancyTables { uint occupancy_tables[]; };
layout(scalar, binding = 24) readonly buffer OccupancyBricks { uint occupancy_words[]; };

// A grid, unpacked.
struct VoxelGrid {
  ivec3 low;        // lowest chunk
  ivec3 size;       // chunks
  uint first;       // table
  float per_block;  // voxels along a block
};

VoxelGrid voxel_grid(uint island) {
  OccupancyGrid packed = occupancy_grids[island];
  VoxelGrid grid;
  grid.low = (ivec3(packed.low) << ivec3(22, 12, 2)) >> 22;
  grid.size = ivec3(packed.size & 255u, (packed.size >> 8) & 255u, (packed.size >> 16) & 255u);
  grid.first = packed.first;
  grid.per_block = exp2(-float(packed.size >> 24));
  return grid;
}

// Entry of the table for the brick a voxel is in; kChunkEmpty outside the grid.
uint brick_entry(VoxelGrid grid, ivec3 voxel) {
  ivec3 chunk = (voxel >> 6) - grid.low;
  bool inside = all(lessThan(uvec3(chunk), uvec3(grid.size)));
  uint table = grid.first + uint((chunk.y * grid.size.x + chunk.x) * grid.size.z + chunk.z);
  uint brick = uint(((voxel.y & 56) << 3) | (voxel.x & 56) | ((voxel.z >> 3) & 7));
  uint entry = occupancy_tables[inside ? table * kBricksPerChunk + brick : 0u];
  return inside ? entry : kChunkEmpty;
}

uint octant_of(ivec3 voxel) { return uint((voxel.y & 4) | ((voxel.x >> 1) & 2) | ((voxel.z >> 2) & 1)); }
uint word_bit(ivec3 voxel) { return uint(((voxel.y & 1) << 4) | ((voxel.x & 3) << 2) | (voxel.z & 3)); }

// The 32 voxels about one of a brick whose entry is known.
uint brick_word(uint entry, ivec3 voxel) {
  uint word = uint(((voxel.y & 6) << 1) | ((voxel.x >> 1) & 2) | ((voxel.z >> 2) & 1));
  bool stored = (entry >> 24) != 0u && entry != kBrickFull;
  uint bits = occupancy_words[stored ? (entry & kMaxBricks) * kBrickWords + word : 0u];
  return stored ? bits : entry == kBrickFull ? ~0u : 0u;
}

uint voxel_word(VoxelGrid grid, ivec3 voxel) { return brick_word(brick_entry(grid, voxel), voxel); }
bool voxel_opaque(VoxelGrid grid, ivec3 voxel) { return ((voxel_word(grid, voxel) >> word_bit(voxel)) & 1u) != 0u; }

// A point of a face, and the voxel in front of it.
struct FacePlace {
  uint axis;     // of the face's normal
  ivec3 voxel;   // in front
  vec2 in_face;  // 0..1 along u and v
};

ivec3 along_axis(uint axis, int n, int u, int v) {
  return axis == 0u ? ivec3(n, v, u) : axis == 1u ? ivec3(u, n, v) : ivec3(u, v, n);
}
ivec3 along_u(uint axis, int by) { return along_axis(axis, 0, by, 0); }
ivec3 along_v(uint axis, int by) { return along_axis(axis, 0, 0, by); }

// @param face 0..5. @param p on the face, voxels. Rounding is undone along the normal, where the face's plane is an integer.
FacePlace face_place(uint face, vec3 p) {
  FacePlace at;
  at.axis = face >> 1;
  float normal = at.axis == 0u ? p.x : at.axis == 1u ? p.y : p.z;
  vec2 uv = at.axis == 0u ? p.zy : at.axis == 1u ? p.xz : p.xy;
  vec2 low = floor(uv);
  at.in_face = uv - low;
  at.voxel = along_axis(at.axis, int(round(normal)) - int(face & 1u), int(low.x), int(low.y));
  return at;
}

// A point next to the face's edge may have been rounded out of it, into what stands beside it: back over the nearest edge.
FacePlace back_on_face(FacePlace at) {
  vec2 to_edge = min(at.in_face, 1.0 - at.in_face);
  bool along = to_edge.x < to_edge.y;
  float in_u = at.in_face.x, in_v = at.in_face.y;
  int by_u = along ? (in_u < 0.5 ? -1 : 1) : 0, by_v = along ? 0 : (in_v < 0.5 ? -1 : 1);
  at.voxel += along_axis(at.axis, 0, by_u, by_v);
  at.in_face = clamp(at.in_face - vec2(by_u, by_v), 0.0, 1.0);
  return at;
}

// How much a corner of a face leaves open: nothing if both voxels beside it stand, else a third less for each of the two and the one across.
float corner_of(uint beside_u, uint beside_v, uint across) {
  return (beside_u & beside_v) != 0u ? 0.0 : 1.0 - float(beside_u + beside_v + across) * (1.0 / 3.0);
}

// Share of light that the eight voxels about the one in front of a face leave to a point of it, 0..1: bilinear between the face's corners,
// whatever quads it was merged into. @param face 0..5. @param lattice the point [blocks].
float corner_openness(uint island, uint face, vec3 lattice) {
  VoxelGrid grid = voxel_grid(island);
  FacePlace at = face_place(face, lattice * grid.per_block);
  float openness = 1.0;
  // The second round is only for points rounded off their face.
  for (uint round = 0u; round < 2u; ++round) {
    // The nine voxels lie in at most four words, and each corner of the nine in another of them.
    ivec3 u = along_u(at.axis, 1), v = along_v(at.axis, 1);
    uint w00 = voxel_word(grid, at.voxel - u - v), w10 = voxel_word(grid, at.voxel + u - v);
    uint w01 = voxel_word(grid, at.voxel - u + v), w11 = voxel_word(grid, at.voxel + u + v);
    // Whether the middle is in the same word as its lower neighbour along u, along v.
    ivec3 in_word = at.voxel & ivec3(3, 1, 3);
    bool low_u = (at.axis == 0u ? in_word.z : in_word.x) != 0, low_v = (at.axis == 1u ? in_word.z : in_word.y) != 0;
    uint left = low_v ? w00 : w01, right = low_v ? w10 : w11, below = low_u ? w00 : w10, above = low_u ? w01 : w11;
    uint middle = low_u ? left : right;
    if (((middle >> word_bit(at.voxel)) & 1u) != 0u && round == 0u) {
      at = back_on_face(at);
      continue;
    }
    left = (left >> word_bit(at.voxel - u)) & 1u;
    right = (right >> word_bit(at.voxel + u)) & 1u;
    below = (below >> word_bit(at.voxel - v)) & 1u;
    above = (above >> word_bit(at.voxel + v)) & 1u;
    float c00 = corner_of(left, below, (w00 >> word_bit(at.voxel - u - v)) & 1u);
    float c10 = corner_of(right, below, (w10 >> word_bit(at.voxel + u - v)) & 1u);
    float c01 = corner_of(left, above, (w01 >> word_bit(at.voxel - u + v)) & 1u);
    float c11 = corner_of(right, above, (w11 >> word_bit(at.voxel + u + v)) & 1u);
    openness = mix(mix(c00, c10, at.in_face.x), mix(c01, c11, at.in_face.x), at.in_face.y);
    break;
  }
  return openness;
}
#endif
