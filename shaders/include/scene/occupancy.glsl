// Which voxels are opaque: look-up, how open a corner is, and a march through an island's lattice. Layout: shared/occupancy.h.
// Coordinates here are in voxels of the island's level of detail: its lattice over the edge of a voxel.
// Needs before the include: common.glsl.
#ifndef SKERRY_OCCUPANCY_GLSL
#define SKERRY_OCCUPANCY_GLSL
#include "shared/occupancy.h"
#include "shared/bindings.h"

layout(scalar, binding = kOccupancyGridsBinding) readonly buffer OccupancyGrids { OccupancyGrid occupancy_grids[]; };
layout(scalar, binding = kOccupancyTablesBinding) readonly buffer OccupancyTables { uint occupancy_tables[]; };
layout(scalar, binding = kOccupancyBricksBinding) readonly buffer OccupancyBricks { uint occupancy_words[]; };

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

// Where a voxel is kept is a sum of what its three coordinates give.
struct AxisLayout {
  int low, size;             // chunks
  uint table, brick, word, bit;  // steps: entries a chunk and a brick, words, bits
  int word_shift, word_mask, bit_mask;
};
AxisLayout layout_x(VoxelGrid grid) {
  return AxisLayout(grid.low.x, grid.size.x, uint(grid.size.z) * kBricksPerChunk, 8u, 2u, 4u, 2, 1, 3);
}
AxisLayout layout_y(VoxelGrid grid) {
  return AxisLayout(grid.low.y, grid.size.y, uint(grid.size.x * grid.size.z) * kBricksPerChunk, 64u, 4u, 16u, 1, 3, 1);
}
AxisLayout layout_z(VoxelGrid grid) { return AxisLayout(grid.low.z, grid.size.z, kBricksPerChunk, 1u, 1u, 1u, 2, 1, 3); }

AxisLayout choose(bool first, AxisLayout a, AxisLayout b) {
  return AxisLayout(first ? a.low : b.low, first ? a.size : b.size, first ? a.table : b.table, first ? a.brick : b.brick,
                    first ? a.word : b.word, first ? a.bit : b.bit, first ? a.word_shift : b.word_shift,
                    first ? a.word_mask : b.word_mask, first ? a.bit_mask : b.bit_mask);
}

struct AxisPart {
  bool inside;  // the grid
  uint entry;   // of the tables
  uint word;    // of a brick
  uint bit;     // of a word
};
AxisPart part_at(AxisLayout a, int voxel) {
  int chunk = (voxel >> 6) - a.low;
  return AxisPart(uint(chunk) < uint(a.size), uint(chunk) * a.table + uint((voxel >> 3) & 7) * a.brick,
                  uint((voxel >> a.word_shift) & a.word_mask) * a.word, uint(voxel & a.bit_mask) * a.bit);
}
AxisPart sum_of(AxisPart a, AxisPart b) { return AxisPart(a.inside && b.inside, a.entry + b.entry, a.word + b.word, a.bit + b.bit); }

// Entry of the table for a voxel's brick; kChunkEmpty outside the grid.
uint brick_entry(VoxelGrid grid, AxisPart voxel) {
  uint entry = occupancy_tables[voxel.inside ? grid.first * kBricksPerChunk + voxel.entry : 0u];
  return voxel.inside ? entry : kChunkEmpty;
}

// The 32 voxels about one of a brick whose entry is known.
uint brick_word(uint entry, uint word) {
  bool stored = (entry >> 24) != 0u && entry != kBrickFull;
  uint bits = occupancy_words[stored ? (entry & kMaxBricks) * kBrickWords + word : 0u];
  return stored ? bits : entry == kBrickFull ? ~0u : 0u;
}

uint voxel_word(VoxelGrid grid, AxisPart voxel) { return brick_word(brick_entry(grid, voxel), voxel.word); }

uint octant_of(ivec3 voxel) { return uint((voxel.y & 4) | ((voxel.x >> 1) & 2) | ((voxel.z >> 2) & 1)); }

AxisPart voxel_part(VoxelGrid grid, ivec3 voxel) {
  return sum_of(sum_of(part_at(layout_x(grid), voxel.x), part_at(layout_y(grid), voxel.y)), part_at(layout_z(grid), voxel.z));
}
bool voxel_opaque(VoxelGrid grid, ivec3 voxel) {
  AxisPart part = voxel_part(grid, voxel);
  return ((voxel_word(grid, part) >> part.bit) & 1u) != 0u;
}

// A point of a face, and the voxel in front of it.
struct FacePlace {
  uint axis;     // of the face's normal
  ivec3 voxel;   // in front
  vec2 in_face;  // 0..1 along u and v
};

float along(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }
int along(ivec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }
ivec3 along_axis(uint axis, int n, int u, int v) {
  return axis == 0u ? ivec3(n, v, u) : axis == 1u ? ivec3(u, n, v) : ivec3(u, v, n);
}
// @param face 0..5. @param p on the face, voxels. Rounding is undone along the normal, where the face's plane is an integer.
FacePlace face_place(uint face, vec3 p) {
  FacePlace at;
  at.axis = face >> 1;
  vec2 uv = at.axis == 0u ? p.zy : at.axis == 1u ? p.xz : p.xy;
  vec2 low = floor(uv);
  at.in_face = uv - low;
  at.voxel = along_axis(at.axis, int(round(along(p, at.axis))) - int(face & 1u), int(low.x), int(low.y));
  return at;
}

// The place on the other side of the face's nearest edge across u, across v, and the point of that edge.
FacePlace beside_u(FacePlace at) {
  int by = at.in_face.x < 0.5 ? -1 : 1;
  at.voxel += along_axis(at.axis, 0, by, 0);
  at.in_face.x = by < 0 ? 1.0 : 0.0;
  return at;
}
FacePlace beside_v(FacePlace at) {
  int by = at.in_face.y < 0.5 ? -1 : 1;
  at.voxel += along_axis(at.axis, 0, 0, by);
  at.in_face.y = by < 0 ? 1.0 : 0.0;
  return at;
}

// A point next to the face's edge may have been rounded out of it, into what stands beside it: back over the nearest edge.
FacePlace back_on_face(FacePlace at) {
  vec2 to_edge = min(at.in_face, 1.0 - at.in_face);
  if (to_edge.x < to_edge.y) return beside_u(at);
  return beside_v(at);
}

// How much a corner of a face leaves open: nothing if both voxels beside it stand, else a third less for each of the two and the one across.
float corner_of(uint beside_u, uint beside_v, uint across) {
  return (beside_u & beside_v) != 0u ? 0.0 : 1.0 - float(beside_u + beside_v + across) * (1.0 / 3.0);
}

// Share of light that the eight voxels about the one in front of a face leave to a point of it, 0..1: bilinear between the face's corners,
// whatever quads it was merged into. @param face 0..5. @param lattice the point [blocks].
float corner_ao(uint island, uint face, vec3 lattice) {
  VoxelGrid grid = voxel_grid(island);
  FacePlace at = face_place(face, lattice * grid.per_block);
  float ao = 1.0;
  // The second round is only for points rounded off their face, which lie in some chunk: a number that the compiler does not know, since
  // lavapipe leaves no loop early that it has unrolled.
  uint rounds = grid.size.x > 0 ? 2u : 1u;
  for (uint round = 0u; round < rounds; ++round) {
    int n = along(at.voxel, at.axis);
    int u = at.axis == 0u ? at.voxel.z : at.voxel.x, v = at.axis == 1u ? at.voxel.z : at.voxel.y;
    AxisLayout along_x = layout_x(grid), along_y = layout_y(grid), along_z = layout_z(grid);
    AxisPart in_n = part_at(choose(at.axis == 0u, along_x, choose(at.axis == 1u, along_y, along_z)), n);
    AxisLayout along_u = choose(at.axis == 0u, along_z, along_x), along_v = choose(at.axis == 1u, along_z, along_y);
    AxisPart u0 = part_at(along_u, u - 1), u1 = part_at(along_u, u + 1), v0 = sum_of(in_n, part_at(along_v, v - 1)),
             v1 = sum_of(in_n, part_at(along_v, v + 1));
    uint bit_u = part_at(along_u, u).bit, bit_v = in_n.bit + part_at(along_v, v).bit;
    // The nine voxels lie in at most four words, and each corner of the nine in another of them.
    uint w00 = voxel_word(grid, sum_of(u0, v0)), w10 = voxel_word(grid, sum_of(u1, v0));
    uint w01 = voxel_word(grid, sum_of(u0, v1)), w11 = voxel_word(grid, sum_of(u1, v1));
    // Whether the middle is in the same word as its lower neighbour along u, along v.
    bool low_u = (u & along_u.bit_mask) != 0, low_v = (v & along_v.bit_mask) != 0;
    uint left = low_v ? w00 : w01, right = low_v ? w10 : w11, below = low_u ? w00 : w10, above = low_u ? w01 : w11;
    uint middle = low_u ? left : right;
    if (((middle >> (bit_u + bit_v)) & 1u) != 0u && round == 0u) {
      at = back_on_face(at);
      continue;
    }
    left = (left >> (u0.bit + bit_v)) & 1u;
    right = (right >> (u1.bit + bit_v)) & 1u;
    below = (below >> (bit_u + v0.bit)) & 1u;
    above = (above >> (bit_u + v1.bit)) & 1u;
    float c00 = corner_of(left, below, (w00 >> (u0.bit + v0.bit)) & 1u);
    float c10 = corner_of(right, below, (w10 >> (u1.bit + v0.bit)) & 1u);
    float c01 = corner_of(left, above, (w01 >> (u0.bit + v1.bit)) & 1u);
    float c11 = corner_of(right, above, (w11 >> (u1.bit + v1.bit)) & 1u);
    ao = mix(mix(c00, c10, at.in_face.x), mix(c01, c11, at.in_face.x), at.in_face.y);
    break;
  }
  return ao;
}
#endif
