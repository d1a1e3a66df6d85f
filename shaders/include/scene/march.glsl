// A march through an island's lattice: whether an opaque voxel stands between two points. Needs before the include: occupancy.glsl.
#ifndef SKERRY_MARCH_GLSL
#define SKERRY_MARCH_GLSL

const float kNever = 1e30;

// Size of the largest box about a voxel that is known to be empty: a chunk, a brick, an octant, a word or eight of its voxels; else that of the
// voxel, and whether it is opaque.
ivec3 empty_about(VoxelGrid grid, ivec3 voxel, out bool opaque) {
  AxisPart part = voxel_part(grid, voxel);
  uint entry = brick_entry(grid, part), word = brick_word(entry, part.word);
  bool octant = ((entry >> 24) & (1u << octant_of(voxel))) != 0u;
  opaque = octant && ((word >> part.bit) & 1u) != 0u;
  uint eight = 0x330033u << uint((voxel.z & 2) + ((voxel.x & 2) << 2));
  ivec3 in_octant = word == 0u ? ivec3(4, 2, 4) : ivec3((word & eight) == 0u ? 2 : 1);
  return octant ? in_octant : ivec3(entry == kChunkEmpty ? 64 : (entry >> 24) == 0u ? 8 : 4);
}

// What a march meets.
struct Marched {
  bool met;
  float share;  // of the way, up to there
  uint face;    // that it enters by; kFaceCount where it begins in it
};

// The first opaque voxel, other than the spared one, on the way from one point to another. Voxels are half open, as
// docs/conventions.md has them. The way goes from voxel to voxel through one face at a time, at an edge through the one whose
// axis comes first, whatever rounding does to where: nothing gets between two opaque voxels that share an edge, nor through a wall.
// (J. Amanatides and A. Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, Eurographics 1987; over empty boxes at one step.)
// @param from, to in voxels. @param voxel the one the way begins in, which may differ from floor(from) by rounding.
Marched march(VoxelGrid grid, vec3 from, ivec3 voxel, vec3 to, ivec3 spared) {
  vec3 way = to - from;
  bvec3 still = lessThan(abs(way), vec3(1e-20));
  bvec3 up = greaterThanEqual(way, vec3(0.0));
  vec3 per_way = mix(1.0 / way, vec3(0.0), still);  // times a distance: share of the way
  vec3 never = mix(vec3(0.0), vec3(kNever), still);
  uvec3 facing = uvec3(0u, 2u, 4u) + uvec3(up);  // faces that look against the way
  ivec3 low = grid.low * 64, end = low + grid.size * 64;
  Marched none = Marched(false, 1.0, kFaceCount), m = none;
  if (any(lessThan(voxel, low)) || any(greaterThanEqual(voxel, end))) {
    // From outside, where all is empty.
    vec3 to_low = (vec3(low) - from) * per_way, to_end = (vec3(end) - from) * per_way;
    bvec3 beside = bvec3(uvec3(still) & (uvec3(lessThan(from, vec3(low))) | uvec3(greaterThanEqual(from, vec3(end)))));
    vec3 enters = mix(min(to_low, to_end) - never, vec3(kNever), beside), leaves = max(to_low, to_end) + never;
    float t = max(max(enters.x, enters.y), max(enters.z, 0.0));
    if (!(t < min(min(leaves.x, leaves.y), min(leaves.z, 1.0)))) return none;
    voxel = clamp(ivec3(floor(from + way * t)), low, end - 1);
    m.face = t == enters.x ? facing.x : t == enters.y ? facing.y : facing.z;
    m.share = t;
  } else {
    m.share = 0.0;
  }
  // A way crosses each plane of the lattice once; rounding may add a few steps.
  ivec3 across = end - low;
  for (int left = across.x + across.y + across.z + 64; left > 0; --left) {
    bool opaque;
    ivec3 size = empty_about(grid, voxel, opaque);
    if (opaque && voxel != spared) return Marched(true, m.share, m.face);
    ivec3 box = voxel & ~(size - 1);
    vec3 plane = vec3(box + mix(ivec3(0), size, up));
    // Only planes before the end, which rounding does not decide.
    bvec3 before = mix(greaterThan(plane, to), lessThan(plane, to), up);
    vec3 next = mix(vec3(kNever), (plane - from) * per_way + never, before);
    float t = min(next.x, min(next.y, next.z));
    if (t >= kNever) return none;
    // Rounding must not take the point out of the box it leaves, nor into another one than that behind the face it crosses.
    ivec3 at = clamp(ivec3(floor(from + way * t)), box, box + size - 1);
    bvec3 through = bvec3(next.x == t, next.x != t && next.y == t, next.x != t && next.y != t);
    voxel = mix(at, box + mix(ivec3(-1), size, up), through);
    m.share = t;
    m.face = through.x ? facing.x : through.y ? facing.y : facing.z;
    if (any(lessThan(voxel, low)) || any(greaterThanEqual(voxel, end))) return none;
  }
  return Marched(true, 1.0, kFaceCount);
}

bool marched_into(VoxelGrid grid, vec3 from, ivec3 voxel, vec3 to, ivec3 spared) { return march(grid, from, voxel, to, spared).met; }
#endif
