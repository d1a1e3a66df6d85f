#version 460
#extension GL_GOOGLE_include_directive : require
// Culling in three steps. Sections: which ranges of each section a view needs (frustum, then the directions its faces look in), and how many draws
// each work group of sections makes; one thread a section, one row of groups a view. Scan: where each group's draws end; one work group a list,
// inclusive scan of the group totals in place, the last becomes the list's draw count. Emit: writes the indirect commands of every view and list,
// in section order: each step is a scan, not an atomic counter, so that pictures do not depend on the timing of threads. docs/conventions.md.
// Where much is hidden the camera's view is drawn in two phases (kTwoPhases; docs/decisions/0050): first the sections that the last frame showed. A
// fourth step, Hidden, then holds all sections of the view against the depths of what has been drawn: it notes which are seen, and leaves the masks
// of those that the first phase has not drawn, and of the translucent quads of all that are seen.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 256) in;

layout(scalar, binding = kSectionsBinding) readonly buffer Sections { Section sections[]; };
layout(scalar, binding = kIslandsBinding) readonly buffer Islands { IslandTransform islands[]; };
layout(scalar, binding = kCullViewsBinding) readonly buffer Views { CullView views[]; };
layout(scalar, binding = kCullMasksBinding) buffer Masks { uint masks[]; };                      // [view][section]
layout(scalar, binding = kCullTotalsBinding) buffer Totals { uint totals[]; };                   // [view][list][group]; scanned: where draws end
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

// Of a mask of ranges: the program for cut-outs draws the opaque ones, too, because it leaves pixels out.
const uint kBlendedMask = 1u << 30;
const uint kUnseen = 1u << 31;  // of a mask: the first phase does not draw the section
const uint kTranslucentRanges = 63u << kRangeTranslucent;

shared uint draws_of_list[3];
shared CullStats group_stats;
shared uvec3 sums[256];  // of lists

uvec3 unpack_box(uint packed) { return uvec3(packed & 127u, (packed >> 7) & 127u, (packed >> 14) & 127u); }

// Of a section's faces, in blocks of its island's lattice.
void section_box(uint section, out vec3 low, out vec3 high) {
  float voxel = float(1u << sections[section].voxel_size_log2);
  vec3 origin = vec3(sections[section].origin);
  low = origin + vec3(unpack_box(sections[section].bounds_min)) * voxel;
  high = origin + vec3(unpack_box(sections[section].bounds_max)) * voxel;
}

uint visible_ranges(uint section, CullView view) {
  uint blend = sections[section].blend;
  bool goes = (blend & kBlendGoes) != 0u;
  if (goes && view.orthographic != 0u) return 0u;
  IslandTransform island = islands[sections[section].island];
  vec3 low, high;
  section_box(section, low, high);
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
  if (view.orthographic == 0u && blend != 0u) mask |= kBlendedMask;
  return view.glass != 0u ? kTranslucentRanges : mask;
}

bool draws_section(CullView view, uint section) {
  return section >= view.first_section && (view.section_limit == 0u || section < view.section_limit);
}

// Composed once a section, so that a vertex needs three dot products and one matrix.
SectionTransform section_transform(uint section, IslandTransform t) {
  vec3 origin = world_from_lattice(t, vec3(sections[section].origin));
  float voxel = float(1u << sections[section].voxel_size_log2);
  return SectionTransform(vec4(vec3(t.axis_x.x, t.axis_y.x, t.axis_z.x) * voxel, origin.x),
                          vec4(vec3(t.axis_x.y, t.axis_y.y, t.axis_z.y) * voxel, origin.y),
                          vec4(vec3(t.axis_x.z, t.axis_y.z, t.axis_z.z) * voxel, origin.z), sections[section].blend,
                          sections[section].first_quad + sections[section].range_end[kRangeCutout - 1u]);
}

// What the first phase draws of a mask; all of it where there is one phase alone.
uint first_phase(uint mask) {
  if (!kTwoPhases) return mask;
  return (mask & kUnseen) != 0u ? 0u : mask & ~kTranslucentRanges;
}

// Whether what has been drawn hides all of a section's box. Errs on the side of no.
bool is_hidden(uint section) {
  IslandTransform island = islands[sections[section].island];
  vec3 low, high;
  section_box(section, low, high);
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

// What a section's mask has.
struct Drawn {
  uvec3 draws;  // by list
  uint quads;
};

uvec3 of_list(uint list, uint count) { return mix(uvec3(0u), uvec3(count), equal(uvec3(0u, 1u, 2u), uvec3(list))); }

uint list_of(uint mask, uint range) {
  return range >= kRangeTranslucent ? 2u : range >= kRangeCutout || (mask & kBlendedMask) != 0u ? 1u : 0u;
}

// Neighbouring ranges of a list that are drawn at once.
struct Run {
  uint begin, end;  // quads, relative to the section's first; equal: there is none
  uint list;
};

// The first run of a section's ranges from `range` on, which becomes the one behind it. `from`: where that range's quads begin.
Run next_run(uint section, uint mask, inout uint range, inout uint from) {
  Run run = Run(from, from, 0u);
  for (; range < kRangeCount; ++range) {
    uint to = sections[section].range_end[range];
    bool has = (mask & (1u << range)) != 0u && to != from;
    uint list = list_of(mask, range);
    bool is_first = run.begin == run.end;
    if (has && !is_first && (from != run.end || list != run.list)) break;
    if (has) run = Run(is_first ? from : run.begin, to, list);
    from = to;
  }
  return run;
}

// Writes the draws of a run, from a slot of its list on; a run is split at kMaxQuadsPerDraw.
void emit_run(uint section, Run run, uint slot) {
  uint first_quad = sections[section].first_quad;
  uint before = run.list == 0u ? 0u : run.list == 1u ? push.most.x : push.most.x + push.most.y;
  uint most = run.list == 0u ? push.most.x : run.list == 1u ? push.most.y : push.most.z;
  uint list_base = gl_WorkGroupID.y * (push.most.x + push.most.y + push.most.z) + before;
  for (uint begin = run.begin; begin < run.end && slot < most; begin += kMaxQuadsPerDraw, ++slot)
    draws[list_base + slot] = DrawCommand(6u * min(run.end - begin, kMaxQuadsPerDraw), 1u, 0u, 4u * (first_quad + begin), section);
}

// Where a section's draws are counted or, with `emits`, written from these slots of their lists on. Stores are between runs, not within the loop over
// ranges: on lavapipe each round of a loop takes the time of all that is in it, and so does a copy of a section whose ranges are looked up.
Drawn walk_runs(uint section, uint mask, const bool emits, uvec3 slots) {
  Drawn drawn = Drawn(uvec3(0u), 0u);
  uint from = 0u;
  for (uint range = mask == 0u ? kRangeCount : 0u; range < kRangeCount;) {
    Run run = next_run(section, mask, range, from);
    uvec3 next = slots + drawn.draws;
    if (emits) emit_run(section, run, run.list == 0u ? next.x : run.list == 1u ? next.y : next.z);
    drawn.draws += of_list(run.list, (run.end - run.begin + kMaxQuadsPerDraw - 1u) / kMaxQuadsPerDraw);
    drawn.quads += run.end - run.begin;
  }
  return drawn;
}

void add_to_group(uvec3 draws) {
  if (draws.x != 0u) atomicAdd(draws_of_list[0], draws.x);
  if (draws.y != 0u) atomicAdd(draws_of_list[1], draws.y);
  if (draws.z != 0u) atomicAdd(draws_of_list[2], draws.z);
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
      bool is_seen = !is_hidden(section);
      seen[section] = is_seen ? 1u : 0u;
      mask = !is_seen ? 0u : (mask & kUnseen) != 0u ? mask & ~kUnseen : mask & kTranslucentRanges;
      Drawn drawn = walk_runs(section, mask, false, uvec3(0u));
      add_to_group(drawn.draws);
      atomicAdd(group_stats.draws, drawn.draws.x + drawn.draws.y + drawn.draws.z);
      atomicAdd(group_stats.quads, drawn.quads);
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
  uint view = gl_WorkGroupID.y;
  clear_group();
  if (section < push.section_count && views[view].enabled != 0u) {
    bool filled = sections[section].range_end[kRangeCount - 1u] != 0u;
    uint mask = filled && draws_section(views[view], section) ? visible_ranges(section, views[view]) : 0u;
    Drawn drawn = walk_runs(section, mask, false, uvec3(0u));
    uint quads = drawn.quads;
    if (quads == 0u) mask = 0u;
    if (kTwoPhases) {
      if (view == 0u && seen[section] == 0u && mask != 0u) mask |= kUnseen;
      drawn = walk_runs(section, first_phase(mask), false, uvec3(0u));
    }
    add_to_group(drawn.draws);
    masks[view * push.section_count + section] = mask;
    if (filled) atomicAdd(group_stats.sections_in, 1u);
    if (quads != 0u) {
      transforms[view * push.section_count + section] =
          section_transform(section, islands[view * push.islands_per_view + sections[section].island]);
      atomicAdd(group_stats.sections_passed, 1u);
      atomicAdd(group_stats.draws, drawn.draws.x + drawn.draws.y + drawn.draws.z);
      atomicAdd(group_stats.quads, drawn.quads);
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

// Draws of a view's lists in the groups up to this one, this one's included.
uvec3 draws_up_to(uint view, uint group) {
  uint first = view * kListCount * push.group_count + group;
  return uvec3(totals[first], totals[first + push.group_count], totals[first + 2u * push.group_count]);
}

void emit() {
  uint section = gl_GlobalInvocationID.x;
  uint view = gl_WorkGroupID.y;
  uint lane = gl_LocalInvocationIndex;
  if (views[view].enabled == 0u) return;
  uvec3 before = gl_WorkGroupID.x == 0u ? uvec3(0u) : draws_up_to(view, gl_WorkGroupID.x - 1u);
  if (before == draws_up_to(view, gl_WorkGroupID.x)) return;
  uint mask = section < push.section_count ? first_phase(masks[view * push.section_count + section]) : 0u;
  uvec3 own = walk_runs(section, mask, false, uvec3(0u)).draws;
  sums[lane] = own;
  barrier();
  for (uint step = 1u; step < 256u; step <<= 1) {
    uvec3 other = lane >= step ? sums[lane - step] : uvec3(0u);
    barrier();
    sums[lane] += other;
    barrier();
  }
  walk_runs(section, own == uvec3(0u) ? 0u : mask, true, before + sums[lane] - own);
}

// Each invocation adds up a stretch of groups, so that the barriers are the same few for any number of them.
void scan() {
  uint base = gl_WorkGroupID.x * push.group_count;
  uint lane = gl_LocalInvocationIndex;
  uint stretch = (push.group_count + 255u) / 256u;
  uint from = min(lane * stretch, push.group_count), to = min(from + stretch, push.group_count);
  uint own = 0u;
  for (uint i = from; i < to; ++i) own += totals[base + i];
  sums[lane].x = own;
  barrier();
  for (uint step = 1u; step < 256u; step <<= 1) {
    uint other = lane >= step ? sums[lane - step].x : 0u;
    barrier();
    sums[lane].x += other;
    barrier();
  }
  uint sum = sums[lane].x - own;
  for (uint i = from; i < to; ++i) {
    sum += totals[base + i];
    totals[base + i] = sum;
  }
  if (lane == 255u) draw_counts[gl_WorkGroupID.x] = min(sums[255].x, push.most[gl_WorkGroupID.x % kListCount]);
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
