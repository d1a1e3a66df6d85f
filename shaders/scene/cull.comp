#version 460
#extension GL_GOOGLE_include_directive : require
// Culling in three steps. Sections: which ranges of each section a view needs (frustum, then the directions its faces look in), and how many draws
// each work group of sections makes; one thread a section, one row of groups a view. Scan: where each group's draws begin; one work group a list,
// exclusive scan of the group totals in place, the sum becomes the list's draw count. Emit: writes the indirect commands of every view and list,
// in section order. docs/conventions.md.
#include "include/scene/cull.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 256) in;

layout(scalar, binding = kSectionsBinding) readonly buffer Sections { Section sections[]; };
layout(scalar, binding = kIslandsBinding) readonly buffer Islands { IslandTransform islands[]; };
layout(scalar, binding = kCullViewsBinding) readonly buffer Views { CullView views[]; };
layout(scalar, binding = kCullMasksBinding) buffer Masks { uint masks[]; };                      // [view][section]
layout(scalar, binding = kCullTotalsBinding) buffer Totals { uint totals[]; };                   // [view][list][group]; scanned: where draws begin
layout(scalar, binding = kCullStatsBinding) buffer Stats { CullStats stats[]; };                 // [view]
layout(scalar, binding = kSectionTransformsBinding) writeonly buffer Transforms { SectionTransform transforms[]; };  // [view][section]
layout(scalar, binding = kDrawCommandsBinding) writeonly buffer Draws { DrawCommand draws[]; };  // [view][list][most]
layout(scalar, binding = kDrawCountsBinding) writeonly buffer Counts { uint draw_counts[]; };    // [view][list]
layout(scalar, push_constant) uniform Push {
  uint section_count;
  uint group_count;
  uint islands_per_view;
  uvec3 most;  // draws of each list
} push;

layout(constant_id = kCullStepConstant) const uint kCullStep = kCullSections;

shared uint draws_of_list[3];
shared CullStats group_stats;
shared uint sums[256];

uvec3 unpack_box(uint packed) { return uvec3(packed & 127u, (packed >> 7) & 127u, (packed >> 14) & 127u); }

uint visible_ranges(Section s, CullView view) {
  if (s.range_end[kRangeCount - 1u] == 0u) return 0u;
  IslandTransform island = islands[s.island];
  float voxel = float(1u << s.voxel_size_log2);
  vec3 low = vec3(s.origin) + vec3(unpack_box(s.bounds_min)) * voxel;
  vec3 high = vec3(s.origin) + vec3(unpack_box(s.bounds_max)) * voxel;
  vec3 half_size = 0.5 * (high - low);
  vec3 centre = world_from_lattice(island, 0.5 * (low + high));
  for (int i = 0; i < 6; ++i) {
    vec3 n = view.planes[i].xyz;
    float reach = dot(abs(lattice_from_world_vector(island, n)), half_size);
    // A little slack covers the rounding of the products above; culling must never lose what can be seen.
    if (dot(n, centre) + view.planes[i].w + reach < -1e-3 * (1.0 + reach)) return 0u;
  }
  bvec3 from_plus, from_minus;  // can the +x, +y, +z (-x, -y, -z) faces be seen?
  if (view.orthographic == 0u) {
    vec3 eye = lattice_from_world(island, view.eye);
    from_plus = greaterThan(eye, low - 1e-2);
    from_minus = lessThan(eye, high + 1e-2);
  } else {
    vec3 to_light = lattice_from_world_vector(island, view.eye);
    from_plus = greaterThan(to_light, vec3(-1e-5));
    from_minus = lessThan(to_light, vec3(1e-5));
  }
  uint faces = uint(from_plus.x) | (uint(from_minus.x) << 1) | (uint(from_plus.y) << 2) | (uint(from_minus.y) << 3) |
               (uint(from_plus.z) << 4) | (uint(from_minus.z) << 5);
  uint mask = (faces << kRangeOpaque) | (faces << kRangeCutout) | (1u << kRangePlant);
  if (view.orthographic == 0u) mask |= 63u << kRangeTranslucent;  // drawn from both sides; casts no shadow
  return mask;
}

// Composed once a section, so that a vertex needs three dot products and one matrix.
SectionTransform section_transform(Section s, IslandTransform t) {
  vec3 origin = world_from_lattice(t, vec3(s.origin));
  float voxel = float(1u << s.voxel_size_log2);
  return SectionTransform(vec4(vec3(t.axis_x.x, t.axis_y.x, t.axis_z.x) * voxel, origin.x),
                          vec4(vec3(t.axis_x.y, t.axis_y.y, t.axis_z.y) * voxel, origin.y),
                          vec4(vec3(t.axis_x.z, t.axis_y.z, t.axis_z.z) * voxel, origin.z));
}

void cull_sections() {
  uint section = gl_GlobalInvocationID.x;
  uint view = gl_GlobalInvocationID.y;
  if (gl_LocalInvocationIndex == 0u) {
    draws_of_list[0] = draws_of_list[1] = draws_of_list[2] = 0u;
    group_stats = CullStats(0u, 0u, 0u, 0u);
  }
  barrier();
  if (section < push.section_count && views[view].enabled != 0u) {
    Section s = sections[section];
    uint mask = visible_ranges(s, views[view]);
    uint quads = 0u, draws = 0u;
    for (uint list = 0u; list < kListCount; ++list) {
      uint count = draw_count(s, mask, list);
      if (count != 0u) atomicAdd(draws_of_list[list], count);
      draws += count;
    }
    for (uint r = 0u; r < kRangeCount; ++r)
      if ((mask & (1u << r)) != 0u) quads += s.range_end[r] - range_begin(s, r);
    if (quads == 0u) mask = 0u;
    masks[view * push.section_count + section] = mask;
    if (s.range_end[kRangeCount - 1u] != 0u) atomicAdd(group_stats.sections_in, 1u);
    if (quads != 0u) {
      transforms[view * push.section_count + section] = section_transform(s, islands[view * push.islands_per_view + s.island]);
      atomicAdd(group_stats.sections_passed, 1u);
      atomicAdd(group_stats.draws, draws);
      atomicAdd(group_stats.quads, quads);
    }
  }
  barrier();
  if (gl_LocalInvocationIndex < kListCount)
    totals[(view * kListCount + gl_LocalInvocationIndex) * push.group_count + gl_WorkGroupID.x] =
        draws_of_list[gl_LocalInvocationIndex];
  if (gl_LocalInvocationIndex == 0u && group_stats.sections_in != 0u) {
    atomicAdd(stats[view].sections_in, group_stats.sections_in);
    atomicAdd(stats[view].sections_passed, group_stats.sections_passed);
    atomicAdd(stats[view].draws, group_stats.draws);
    atomicAdd(stats[view].quads, group_stats.quads);
  }
}

uint emit_run(uint section, uint first_quad, uint begin, uint end, uint list, uint slot) {
  uvec3 most = push.most;
  uint before = list == 0u ? 0u : list == 1u ? most.x : most.x + most.y;
  uint list_base = gl_GlobalInvocationID.y * (most.x + most.y + most.z) + before;
  for (; begin < end; begin += kMaxQuadsPerDraw, ++slot) {
    if (slot >= most[list]) return slot;
    uint quads = min(end - begin, kMaxQuadsPerDraw);
    draws[list_base + slot] = DrawCommand(6u * quads, 1u, 0u, 4u * (first_quad + begin), section);
  }
  return slot;
}

void emit() {
  uint section = gl_GlobalInvocationID.x;
  uint view = gl_GlobalInvocationID.y;
  uint lane = gl_LocalInvocationIndex;
  if (views[view].enabled == 0u) return;
  uint mask = 0u;
  Section s;
  if (section < push.section_count) {
    mask = masks[view * push.section_count + section];
    s = sections[section];
  }
  for (uint list = 0u; list < kListCount; ++list) {
    uint own = mask == 0u ? 0u : draw_count(s, mask, list);
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1) {
      uint other = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (own != 0u) {
      uint slot = totals[(view * kListCount + list) * push.group_count + gl_WorkGroupID.x] + sums[lane] - own;
      uint begin = 0u, end = 0u;
      for (uint r = list_first_range(list); r < list_end_range(list); ++r) {
        uint b = range_begin(s, r), e = s.range_end[r];
        if ((mask & (1u << r)) == 0u || b == e) continue;
        if (b != end || begin == end) {
          slot = emit_run(section, s.first_quad, begin, end, list, slot);
          begin = b;
        }
        end = e;
      }
      emit_run(section, s.first_quad, begin, end, list, slot);
    }
    barrier();
  }
}

void scan() {
  uint list = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationIndex;
  uint base = list * push.group_count;
  uint carried = 0u;
  for (uint start = 0u; start < push.group_count; start += 256u) {
    uint i = start + lane;
    uint own = i < push.group_count ? totals[base + i] : 0u;
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1) {
      uint other = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (i < push.group_count) totals[base + i] = carried + sums[lane] - own;
    carried += sums[255];
    barrier();
  }
  if (lane == 0u) draw_counts[list] = min(carried, push.most[list % kListCount]);
}

void main() {
  if (kCullStep == kCullSections)
    cull_sections();
  else if (kCullStep == kCullScan)
    scan();
  else
    emit();
}
