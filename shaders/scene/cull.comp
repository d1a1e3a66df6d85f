#version 460
#extension GL_GOOGLE_include_directive : require
// Culling in three steps. Sections: which ranges of each section a view needs (frustum, then the directions its faces look in), and how many draws
// each work group of sections makes; one thread a section, one row of groups a view. Scan: where each group's draws begin; one work group a list,
// exclusive scan of the group totals in place, the sum becomes the list's draw count. Emit: writes the indirect commands of every view and list,
// in section order. docs/conventions.md.
// Where much is hidden the camera's view is drawn in two phases (kTwoPhases; docs/decisions/0050): first the sections that the last frame showed. A
// fourth step, Hidden, then holds all sections of the view against the depths of what has been drawn: it notes which are seen, and leaves the masks
// of those that the first phase has not drawn, and of the translucent quads of all that are seen.
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

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kSeenSectionsBinding) buffer Seen { uint seen[]; };
layout(scalar, binding = kFarDepthsBinding) readonly buffer FarDepths { float far_depths[]; };

layout(constant_id = kCullStepConstant) const uint kCullStep = kCullSections;
layout(constant_id = kTwoPhasesConstant) const bool kTwoPhases = false;

const uint kUnseen = 1u << 31;  // of a mask: the first phase does not draw the section
const uint kTranslucentRanges = 63u << kRangeTranslucent;

shared uint draws_of_list[3];
shared CullStats group_stats;
shared uint sums[256];
shared uint lists_with_draws;  // bits

uvec3 unpack_box(uint packed) { return uvec3(packed & 127u, (packed >> 7) & 127u, (packed >> 14) & 127u); }

// Of a section's faces, in blocks of its island's lattice.
void section_box(Section s, out vec3 low, out vec3 high) {
  float voxel = float(1u << s.voxel_size_log2);
  low = vec3(s.origin) + vec3(unpack_box(s.bounds_min)) * voxel;
  high = vec3(s.origin) + vec3(unpack_box(s.bounds_max)) * voxel;
}

uint visible_ranges(Section s, CullView view) {
  if (s.range_end[kRangeCount - 1u] == 0u) return 0u;
  bool goes = (s.blend & kBlendGoes) != 0u;
  if (goes && view.orthographic != 0u) return 0u;
  IslandTransform island = islands[s.island];
  vec3 low, high;
  section_box(s, low, high);
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
  // Drawn from both sides; casts no shadow.
  if (view.orthographic == 0u && !goes) mask |= kTranslucentRanges;
  if (view.orthographic == 0u && s.blend != 0u) mask |= kBlendedMask;
  return view.glass != 0u ? kTranslucentRanges : mask;
}

bool draws_section(CullView view, uint section) {
  return section >= view.first_section && (view.section_limit == 0u || section < view.section_limit);
}

// Composed once a section, so that a vertex needs three dot products and one matrix.
SectionTransform section_transform(Section s, IslandTransform t) {
  vec3 origin = world_from_lattice(t, vec3(s.origin));
  float voxel = float(1u << s.voxel_size_log2);
  return SectionTransform(vec4(vec3(t.axis_x.x, t.axis_y.x, t.axis_z.x) * voxel, origin.x),
                          vec4(vec3(t.axis_x.y, t.axis_y.y, t.axis_z.y) * voxel, origin.y),
                          vec4(vec3(t.axis_x.z, t.axis_y.z, t.axis_z.z) * voxel, origin.z), s.blend,
                          s.first_quad + s.range_end[kRangeCutout - 1u]);
}

// What the first phase draws of a mask; all of it where there is one phase alone.
uint first_phase(uint mask) {
  if (!kTwoPhases) return mask;
  return (mask & kUnseen) != 0u ? 0u : mask & ~kTranslucentRanges;
}

// Whether what has been drawn hides all of a section's box. Errs on the side of no.
bool is_hidden(Section s) {
  IslandTransform island = islands[s.island];
  vec3 low, high;
  section_box(s, low, high);
  float nearest = 3.402823e38;  // along the view axis
  vec2 first = vec2(3.402823e38), last = vec2(-3.402823e38);
  for (uint i = 0u; i < 8u; ++i) {
    vec3 corner = mix(low, high, bvec3((i & 1u) != 0u, (i & 2u) != 0u, (i & 4u) != 0u));
    vec4 clip = frame.clip_from_world * vec4(world_from_lattice(island, corner), 1.0);
    nearest = min(nearest, clip.w);
    vec2 pixel = (clip.xy / clip.w * 0.5 + 0.5) * vec2(frame.size);
    first = min(first, pixel);
    last = max(last, pixel);
  }
  // Quads grow in their planes by 1/128 pixel (draw_quads.vert), and rounding moves what is far from the lattice's origin.
  float growth = length(frame.ray_right) * frame.pixel_to_ndc.x;
  nearest *= 1.0 - 1e-4 - growth;
  if (nearest <= 2.0 * frame.near_plane) return false;
  vec2 most = vec2(frame.size) - 1.0;
  uvec2 a = uvec2(clamp(floor(first) - 1.0, vec2(0.0), most)), b = uvec2(clamp(floor(last) + 1.0, vec2(0.0), most));
  uvec2 fine_count = (frame.size + (kFineDepthEdge - 1u)) / kFineDepthEdge;
  uvec2 coarse_count = (frame.size + (kCoarseDepthEdge - 1u)) / kCoarseDepthEdge;
  bool fine = all(lessThanEqual(b / kFineDepthEdge - a / kFineDepthEdge, uvec2(7u)));
  uint edge = fine ? kFineDepthEdge : kCoarseDepthEdge;
  uint base = fine ? 0u : fine_count.x * fine_count.y;
  uint row = fine ? fine_count.x : coarse_count.x;
  uvec2 from = a / edge, to = b / edge;
  if ((to.x - from.x + 1u) * (to.y - from.y + 1u) > 64u) return false;
  float depth = frame.near_plane / nearest;
  for (uint y = from.y; y <= to.y; ++y)
    for (uint x = from.x; x <= to.x; ++x)
      if (depth >= far_depths[base + y * row + x]) return false;
  return true;
}

// Adds a section's draws to those of its group. @return how many.
uint add_draws(Section s, uint mask) {
  uint draws = 0u;
  for (uint list = 0u; list < kListCount; ++list) {
    uint count = draw_count(s, mask, list);
    if (count != 0u) atomicAdd(draws_of_list[list], count);
    draws += count;
  }
  return draws;
}

uint quads_of(Section s, uint mask) {
  uint quads = 0u;
  for (uint r = 0u; r < kRangeCount; ++r)
    if ((mask & (1u << r)) != 0u) quads += s.range_end[r] - range_begin(s, r);
  return quads;
}

void store_totals(uint view) {
  barrier();
  if (gl_LocalInvocationIndex < kListCount)
    totals[(view * kListCount + gl_LocalInvocationIndex) * push.group_count + gl_WorkGroupID.x] =
        draws_of_list[gl_LocalInvocationIndex];
}

void clear_group() {
  if (gl_LocalInvocationIndex == 0u) {
    draws_of_list[0] = draws_of_list[1] = draws_of_list[2] = 0u;
    group_stats = CullStats(0u, 0u, 0u, 0u, 0u);
  }
  barrier();
}

// Of the camera's view, which is the first.
void find_hidden() {
  uint section = gl_GlobalInvocationID.x;
  clear_group();
  if (section < push.section_count) {
    uint mask = masks[section];
    if (mask != 0u) {
      Section s = sections[section];
      bool is_seen = !is_hidden(s);
      seen[section] = is_seen ? 1u : 0u;
      mask = !is_seen ? 0u : (mask & kUnseen) != 0u ? mask & ~kUnseen : mask & kTranslucentRanges;
      atomicAdd(group_stats.draws, add_draws(s, mask));
      atomicAdd(group_stats.quads, quads_of(s, mask));
      masks[section] = mask;
    }
  }
  store_totals(0u);
  if (gl_LocalInvocationIndex == 0u && group_stats.quads != 0u) {
    atomicAdd(stats[0].draws, group_stats.draws);
    atomicAdd(stats[0].quads, group_stats.quads);
  }
}

void cull_sections() {
  uint section = gl_GlobalInvocationID.x;
  uint view = gl_GlobalInvocationID.y;
  clear_group();
  if (section < push.section_count && views[view].enabled != 0u) {
    Section s = sections[section];
    uint mask = draws_section(views[view], section) ? visible_ranges(s, views[view]) : 0u;
    if (kTwoPhases && view == 0u && seen[section] == 0u && mask != 0u) mask |= kUnseen;
    uint drawn = first_phase(mask);
    uint draws = add_draws(s, drawn), quads = quads_of(s, mask);
    if (quads == 0u) mask = 0u;
    masks[view * push.section_count + section] = mask;
    if (s.range_end[kRangeCount - 1u] != 0u) atomicAdd(group_stats.sections_in, 1u);
    if (quads != 0u) {
      transforms[view * push.section_count + section] = section_transform(s, islands[view * push.islands_per_view + s.island]);
      atomicAdd(group_stats.sections_passed, 1u);
      atomicAdd(group_stats.draws, draws);
      atomicAdd(group_stats.quads, quads_of(s, drawn));
      atomicAdd(group_stats.quads_in_view, quads);
    }
  }
  store_totals(view);
  if (gl_LocalInvocationIndex == 0u && group_stats.sections_in != 0u) {
    atomicAdd(stats[view].sections_in, group_stats.sections_in);
    atomicAdd(stats[view].sections_passed, group_stats.sections_passed);
    atomicAdd(stats[view].draws, group_stats.draws);
    atomicAdd(stats[view].quads, group_stats.quads);
    atomicAdd(stats[view].quads_in_view, group_stats.quads_in_view);
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
    mask = first_phase(masks[view * push.section_count + section]);
    s = sections[section];
  }
  if (lane == 0u) lists_with_draws = 0u;
  barrier();
  uint own_lists = 0u;
  for (uint list = 0u; list < kListCount; ++list)
    if (mask != 0u && draw_count(s, mask, list) != 0u) own_lists |= 1u << list;
  if (own_lists != 0u) atomicOr(lists_with_draws, own_lists);
  barrier();
  for (uint list = 0u; list < kListCount; ++list) {
    uint own = mask == 0u ? 0u : draw_count(s, mask, list);
    sums[lane] = own;
    barrier();
    // Most groups have no draw of most lists. Loops end early on every device, branches do not.
    uint end_step = (lists_with_draws & (1u << list)) != 0u ? 256u : 0u;
    for (uint step = 1u; step < end_step; step <<= 1) {
      uint other = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (own != 0u) {
      uint slot = totals[(view * kListCount + list) * push.group_count + gl_WorkGroupID.x] + sums[lane] - own;
      uint begin = 0u, end = 0u;
      for (uint r = list_first_range(mask, list); r < list_end_range(mask, list); ++r) {
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
  else if (kCullStep == kCullEmit)
    emit();
  else
    find_hidden();
}
