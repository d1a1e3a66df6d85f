#version 460
#extension GL_GOOGLE_include_directive : require
// Which lights of its lists an 8x8-pixel tile need not ask, and which nothing stands before. What a tile shows is cut into boxes: of one face's
// plane on one island, or of plants. All ways from a box to a light lie in their hull, a shaft (E. A. Haines and J. R. Wallace, Shaft Culling for
// Efficient Ray-Traced Radiosity, 1991): without an opaque voxel in it every way is open; where the voxels across it are all opaque no way is.
// Errs on the side of asking. docs/decisions/0058.
#define SKERRY_STORED
#define SKERRY_UNTEXTURED
#include "include/frame/common.glsl"
#include "include/frame/islands.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/shafts.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(scalar, binding = kTileShaftsBinding) writeonly buffer Shafts { TileShafts tile_shafts[]; };

#include "include/surface/surface.glsl"
#include "include/light/clustered.glsl"
#include "include/light/traced.glsl"

// Rounding of a way stays far below this [voxels].
const float kMargin = 1.0 / 256.0;
const int kMostCells = 16;  // across a slab; beyond, each pixel asks
const float kPieces = 8.0;  // of a slab; a power of two, so that they add up to 1

// Where ways begin, in voxels.
struct Box {
  vec3 low, high;
  ivec3 least, most;  // voxels that ways go through
};

const uint kNone = 0u;     // the light does not light the box, whatever stands between
const uint kBlocked = 1u;  // all ways are blocked
const uint kOpen = 2u;     // none is
const uint kUnknown = 4u;

// Goes through the shaft by slabs of voxels along its longest side, as a whole or, where that does not tell, in kPieces.
uint shaft_state(VoxelGrid grid, Box box, vec3 end, ivec3 spared) {
  vec3 side = abs(end - 0.5 * (box.low + box.high));
  uint d = side.x >= side.y && side.x >= side.z ? 0u : side.y >= side.z ? 1u : 2u;
  uint u = d == 2u ? 0u : d + 1u, v = d == 0u ? 2u : d - 1u;
  // Towards the light is up.
  float sign = along(end, d) < along(box.low, d) ? -1.0 : 1.0;
  float low = (sign > 0.0 ? along(box.low, d) : -along(box.high, d)) - kMargin;
  float high = (sign > 0.0 ? along(box.high, d) : -along(box.low, d)) + kMargin, to = sign * along(end, d);
  if (to <= high) return kUnknown;
  vec2 box_low = vec2(along(box.low, u), along(box.low, v)), box_high = vec2(along(box.high, u), along(box.high, v));
  ivec2 least = ivec2(along(box.least, u), along(box.least, v)), most = ivec2(along(box.most, u), along(box.most, v));
  vec2 at_end = vec2(along(end, u), along(end, v));
  int first_cell = clamp(int(floor(sign > 0.0 ? low : -low)), along(box.least, d), along(box.most, d));
  float slab = sign > 0.0 ? float(first_cell) : -float(first_cell) - 1.0;  // its lower side
  bool some = false;
  float piece = 0.0, thick = 1.0, per_low = 1.0 / (to - low), per_high = 1.0 / (to - high);
  // Beyond the island's voxels nothing is in the way.
  float voxels_end = float(64 * (sign > 0.0 ? along(grid.low + grid.size, d) : -along(grid.low, d)));
  float last = min(to + kMargin, voxels_end);
  while (slab <= last) {
    // Shares of the way: where the first way enters the piece, where the last one leaves it.
    float enters = clamp((slab + piece - high) * per_high, 0.0, 1.0);
    float leaves = clamp((slab + piece + thick - low) * per_low, 0.0, 1.0);
    vec2 from = min(mix(box_low, at_end, enters), mix(box_low, at_end, leaves)) - kMargin;
    vec2 until = max(mix(box_high, at_end, enters), mix(box_high, at_end, leaves)) + kMargin;
    ivec2 c0 = clamp(ivec2(floor(from)), least, most), size = clamp(ivec2(floor(until)), least, most) - c0 + 1;
    int cells = size.x * size.y;
    if (cells > kMostCells) return kUnknown;
    // Every way goes through pieces between where all have begun and where the first ends.
    bool any_opaque = false, all_opaque = slab + piece >= high && slab + piece + thick <= to - kMargin;
    int cell = int(sign > 0.0 ? slab : -slab - 1.0);
    ivec2 c = c0;
    for (int i = 0;;) {
      ivec3 voxel = d == 0u ? ivec3(cell, c.x, c.y) : d == 1u ? ivec3(c.y, cell, c.x) : ivec3(c.x, c.y, cell);
      bool opaque = voxel != spared && voxel_opaque(grid, voxel);
      any_opaque = any_opaque || opaque;
      all_opaque = all_opaque && opaque;
      // No division: lavapipe divides whole numbers lane by lane.
      bool end_of_row = ++c.x == c0.x + size.x;
      c = end_of_row ? ivec2(c0.x, c.y + 1) : c;
      if (++i >= cells) break;
    }
    if (all_opaque) return kBlocked;
    if (any_opaque && thick == 1.0) {
      thick = 1.0 / kPieces;
      continue;
    }
    some = some || any_opaque;
    piece += thick;
    if (piece == 1.0) {
      piece = 0.0;
      thick = 1.0;
      slab += 1.0;
    }
    if (slab > last) break;
  }
  return some ? kUnknown : kOpen;
}

// What a tile shows at one slice of depth on one plane, or of plants.
const uint kGroups = 4u;
struct Groups {
  uint keys[kGroups];  // island, face, slice; kNoGroup
  int planes[kGroups];  // voxel in front, along the normal
  vec3 lows[kGroups];
  vec3 highs[kGroups];
  uint count;
  uint lost;  // slices with more, a bit each
};
const uint kNoGroup = ~0u;
uint key_of(uint island, uint face, uint slice) { return island | (face << 16) | (slice << 20); }
uint island_of(uint key) { return key & 0xffffu; }
uint face_of(uint key) { return (key >> 16) & 7u; }
uint slice_of(uint key) { return key >> 20; }

Groups find_groups(ivec2 tile_low, ivec2 last) {
  Groups g;
  g.count = 0u;
  g.lost = 0u;
  for (uint k = 0u; k < kGroups; ++k) {
    g.keys[k] = kNoGroup;
    g.planes[k] = 0;
    g.lows[k] = vec3(1e30);
    g.highs[k] = vec3(-1e30);
  }
  for (int i = 0; i < 64; ++i) {
    ivec2 pixel = min(tile_low + ivec2(i & 7, i >> 3), last);
    float stored_depth = texelFetch(depths, pixel, 0).r;
    uint word = covered_word(imageLoad(surfaces, pixel).r, stored_depth);
    bool here = word != 0u;
    float depth = here ? surface_depth(stored_depth) : 1.0;
    Surface s = surface_without_texture(word, pixel, depth, pixel_ray(uvec2(pixel)));
    WayStart start = way_start(s, word);
    uint face = min(surface_face(word), 6u);
    uint slice = slice_at(view_distance(depth, frame.near_plane));
    uint key = key_of(surface_island(word), face, slice);
    int plane = face < 6u ? along(start.voxel, face >> 1) : 0;
    bool taken = !here;
    for (uint k = 0u; k < kGroups; ++k) {
      bool takes = !taken && (g.keys[k] == kNoGroup || (g.keys[k] == key && g.planes[k] == plane));
      g.keys[k] = takes ? key : g.keys[k];
      g.planes[k] = takes ? plane : g.planes[k];
      g.lows[k] = takes ? min(g.lows[k], start.from) : g.lows[k];
      g.highs[k] = takes ? max(g.highs[k], start.from) : g.highs[k];
      taken = taken || takes;
    }
    g.lost |= taken ? 0u : 1u << slice;
  }
  for (uint k = 0u; k < kGroups; ++k) g.count += g.keys[k] != kNoGroup ? 1u : 0u;
  return g;
}

uint way_state(Light light, uint key, int plane, vec3 low, vec3 high) {
  uint kind = light.kind & kLightKindMask, island = island_of(key), face = face_of(key);
  bool point = kind == kLightPoint || kind == kLightSpot || (kind == kLightSphere && (kLightsSoftness == 1u || light.size == 0.0));
  if (!point) return kUnknown;
  VoxelGrid grid = voxel_grid(island);
  vec3 middle = lattice_from_world(island_at(island), light.position) * grid.per_block;
  vec3 apart = max(max(low - middle, middle - high), 0.0);
  float range = light.range * grid.per_block + kMargin;
  if (dot(apart, apart) >= range * range) return kNone;
  Box box = Box(low, high, ivec3(-0x40000000), ivec3(0x40000000));
  uint axis = face < 6u ? face >> 1 : 1u;
  bool positive = (face & 1u) == 0u;
  float above = positive ? along(middle, axis) - along(low, axis) : along(high, axis) - along(middle, axis);
  // A coarse normal may see what lies behind the face, past voxels that the box leaves out.
  if (above <= -kMargin) return kNormalCode == kNormalExact ? kNone : kUnknown;
  if (face < 6u) {
    ivec3 bound = along_axis(axis, plane, 0, 0);
    bvec3 normal = equal(uvec3(axis), uvec3(0u, 1u, 2u));
    if (positive) box.least = mix(box.least, bound, normal);
    else box.most = mix(box.most, bound, normal);
  }
  if (light.island_count != 1u || light_islands[light.first_island] != island) return kUnknown;
  return shaft_state(grid, box, middle, ivec3(clamp(floor(middle), -1e9, 1e9)));
}

void main() {
  uvec2 count = (frame.size + 7u) / 8u;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  ivec2 tile_low = ivec2(tile % count.x, tile / count.x) * 8;
  Groups g = find_groups(tile_low, ivec2(frame.size) - 1);
  uint slices[kShaftLists];
  for (uint list = 0u; list < kShaftLists; ++list) slices[list] = kNoSlice;
  for (uint k = 0u; k < kGroups; ++k) {
    uint slice = slice_of(g.keys[k]);
    if (g.keys[k] == kNoGroup || ((g.lost >> slice) & 1u) != 0u || slice == slices[0]) continue;
    if (slices[0] == kNoSlice) slices[0] = slice;
    else if (slices[1] == kNoSlice) slices[1] = slice;
  }
  tile_shafts[tile].slices = slices[0] | (slices[1] << 8);
  for (uint list = 0u; list < kShaftLists; ++list) {
    Cluster lights_here = Cluster(0u, 0u);
    if (slices[list] != kNoSlice) lights_here = clusters[cluster_of(tile_at(uvec2(tile_low)), slices[list])];
    for (uint word = 0u; lights_here.count > 0u;) {
      uint asked = 0u, open = 0u;
      uint end = min(lights_here.count, word * 32u + 32u);
      for (uint i = word * 32u;;) {
        Light light = frame_light(light_index(lights_here, i));
        uint states = 0u;
        for (uint k = 0u; g.count > 0u;) {
          if (slice_of(g.keys[k]) == slices[list])
            states |= way_state(light, g.keys[k], g.planes[k], g.lows[k], g.highs[k]);
          if (++k == g.count) break;
        }
        if (states > kBlocked) asked |= 1u << (i & 31u);
        if (states == kOpen) open |= 1u << (i & 31u);
        if (++i == end) break;
      }
      tile_shafts[tile].asked[list * kShaftWords + word] = asked;
      tile_shafts[tile].open[list * kShaftWords + word] = open;
      if (++word == kShaftWords || word * 32u >= lights_here.count) break;
    }
  }
}
