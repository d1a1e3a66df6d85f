// How much of a light reaches a surface past the voxels of islands. Needs before the include: `island_at()`, shared/light.h.
#ifndef SKERRY_TRACED_GLSL
#define SKERRY_TRACED_GLSL
#include "include/scene/occupancy.glsl"
#include "include/scene/march.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(scalar, binding = kLightIslandsBinding) readonly buffer LightIslands { uint light_islands[]; };

// For how many lights of a pixel walls are looked for: none, all (kEveryLight), or those that send the most light to the eye, at most kMostLightsShadows.
layout(constant_id = kLightsShadowsConstant) const uint kLightsShadows = 0u;
const uint kEveryLight = 0xffffffffu;
const uint kMostLightsShadows = 8u;

layout(constant_id = kMirrorWorldConstant) const bool kMirrorWorld = false;  // water and glass mirror voxels

layout(constant_id = kLightsSoftnessConstant) const uint kLightsSoftness = 1u;  // ways to a light that has a size

float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

// The lights of a list before which walls are looked for, the strongest first; of equally strong ones, the first of the list.
struct Strongest {
  float strengths[kMostLightsShadows];  // 0: there is none
  uint lights[kMostLightsShadows];
};
Strongest no_lights() {
  Strongest s;
  for (uint k = 0u; k < kMostLightsShadows; ++k) {
    s.strengths[k] = 0.0;
    s.lights[k] = 0u;
  }
  return s;
}
void add_strength(inout Strongest s, float strength, uint light) {
  for (uint k = 0u; k < min(kLightsShadows, kMostLightsShadows); ++k) {
    bool stronger = strength > s.strengths[k];
    float weaker = stronger ? s.strengths[k] : strength;
    uint weaker_light = stronger ? s.lights[k] : light;
    s.strengths[k] = stronger ? strength : s.strengths[k];
    s.lights[k] = stronger ? light : s.lights[k];
    strength = weaker;
    light = weaker_light;
  }
}

// How many there are.
uint lights_found(Strongest s) {
  uint found = 0u;
  for (uint k = 0u; k < min(kLightsShadows, kMostLightsShadows); ++k) found += s.strengths[k] > 0.0 ? 1u : 0u;
  return found;
}

// Where ways to lights begin.
struct WayStart {
  vec3 position;  // world
  vec3 normal;
  uint island;    // whose surface it is
  ivec3 voxel;    // of its level, in front of the surface
  vec3 from;      // in that voxel [voxels]
};

bool is_face(VoxelGrid grid, FacePlace at, int behind) {
  return !voxel_opaque(grid, at.voxel) && voxel_opaque(grid, at.voxel + along_axis(at.axis, behind, 0, 0));
}

// The place, or the one next to it that rounding has taken it from. At a corner of four places only those will do that are a face; at the
// edge between two, the one where nothing stands.
FacePlace settled(VoxelGrid grid, FacePlace at, uint face) {
  const float kNearCorner = 1.0 / 256.0;
  int behind = (face & 1u) == 0u ? -1 : 1;
  bool corner = all(lessThan(min(at.in_face, 1.0 - at.in_face), vec2(kNearCorner)));
  FacePlace found = at;
  bool known = false;
  uint most = corner ? 4u : 0u;  // a number that the compiler does not know: lavapipe leaves no loop early that it has unrolled
  for (uint i = 0u; i < most && !known; ++i) {
    found = at;
    if ((i & 1u) != 0u) found = beside_u(found);
    if ((i & 2u) != 0u) found = beside_v(found);
    known = is_face(grid, found, behind);
  }
  if (known) return found;
  return voxel_opaque(grid, at.voxel) ? back_on_face(at) : at;
}

// On the surface itself, in the voxel in front of its face: that is known from the face and not from rounding, so that no step off the
// surface is needed and none can land in a wall.
WayStart way_start(Surface s, uint word) {
  WayStart start;
  start.position = s.position;
  start.normal = s.normal;
  start.island = surface_island(word);
  start.voxel = ivec3(0);
  start.from = vec3(0.0);
  if (kLightsShadows == 0u && !kMirrorWorld) return start;
  VoxelGrid grid = voxel_grid(start.island);
  vec3 p = lattice_from_world(island_at(start.island), s.position) * grid.per_block;
  uint face = min(surface_face(word), 5u);
  start.voxel = s.plant ? ivec3(floor(p + vec3(0.0, 0.001, 0.0))) : settled(grid, face_place(face, p), face).voxel;
  start.from = clamp(p, vec3(start.voxel), vec3(start.voxel) + 1.0);
  return start;
}

// In the open, on no island.
WayStart way_from(vec3 p) { return WayStart(p, vec3(0.0), ~0u, ivec3(0), vec3(0.0)); }

// Whether nothing opaque stands between a surface and a point of a light. Here and below loops are left at their end: docs/lavapipe.md.
bool way_is_open(WayStart start, Light light, vec3 to, vec3 light_middle) {
  bool open = true;
  for (uint i = 0u; light.island_count > 0u;) {
    uint island = light_islands[light.first_island + i];
    IslandTransform t = island_at(island);
    VoxelGrid grid = voxel_grid(island);
    bool own = island == start.island;
    vec3 from = own ? start.from : lattice_from_world(t, start.position) * grid.per_block;
    ivec3 voxel = own ? start.voxel : ivec3(floor(from));
    // The voxel that a light stands in does not block it.
    ivec3 spared = ivec3(clamp(floor(lattice_from_world(t, light_middle) * grid.per_block), -1e9, 1e9));
    open = !marched_into(grid, from, voxel, lattice_from_world(t, to) * grid.per_block, spared);
    if (!open || ++i == light.island_count) break;
  }
  return open;
}

// One of the points that stand for a light with a size: of a sphere, of the half that faces the surface, evenly spread as seen from it; of a
// tube, of the part before the surface.
vec3 light_point(WayStart start, Light light, uint sample_index) {
  uint kind = light.kind & kLightKindMask;
  float share = (float(sample_index) + 0.5) / float(kLightsSoftness);
  if (kind == kLightTube) {
    float at_middle = dot(start.normal, light.position - start.position), along = dot(start.normal, light.axis) * light.size;
    // Where the line goes behind the surface, of -1..1.
    float cut = abs(along) > 1e-6 ? clamp(-at_middle / along, -1.0, 1.0) : -1.0;
    float low = along > 0.0 ? cut : -1.0, high = along < 0.0 && abs(along) > 1e-6 ? cut : 1.0;
    return light.position + light.axis * (light.size * mix(low, high, share));
  }
  if (kind != kLightSphere || kLightsSoftness == 1u) return light.position;
  vec3 to_surface = normalize(start.position - light.position + vec3(0.0, 1e-6, 0.0));
  vec3 side = normalize(abs(to_surface.y) < 0.9 ? vec3(to_surface.z, 0.0, -to_surface.x) : vec3(0.0, -to_surface.z, to_surface.y));
  const float kGoldenAngle = 2.39996323;  // Vogel, A better way to construct the sunflower head, 1979
  float turn = float(sample_index) * kGoldenAngle, r = sqrt(share);
  vec3 across = side * cos(turn) + cross(to_surface, side) * sin(turn);
  return light.position + light.size * (across * r + to_surface * sqrt(1.0 - share));
}

// Share of a light that reaches a surface, 0..1.
float traced_visibility(WayStart start, Light light) {
  if ((light.kind & kLightKindMask) == kLightDirectional) {
    vec3 to = start.position - light.axis * light.range;
    return way_is_open(start, light, to, to) ? 1.0 : 0.0;
  }
  uint samples = light.size > 0.0 ? kLightsSoftness : 1u;
  uint open = 0u;
  for (uint i = 0u;;) {
    open += way_is_open(start, light, light_point(start, light, i), light.position) ? 1u : 0u;
    if (++i == samples) break;
  }
  return float(open) / float(samples);
}
#endif
