// Which cluster a place is in, and which lights reach one. Needs before the include: `grid` (ClusterGrid).
#ifndef SKERRY_CLUSTERS_GLSL
#define SKERRY_CLUSTERS_GLSL
#extension GL_EXT_scalar_block_layout : require
#include "shared/clusters.h"
#include "shared/light.h"
#include "include/light/light_kinds.glsl"

// Slices are cut at the half and whole steps of a float's exponent (1, 1.5, 2, 3, 4, 6 ... blocks), by its bits: every shader and every device
// finds the same slice, and its ends are exact.
const uint kHalfOctave = 22u;
const uint kFirstSlice = 0x3f800000u >> kHalfOctave;  // from one block on

// @param z distance along the view axis [blocks], not negative.
uint slice_at(float z) {
  return z < 1.0 ? 0u : min((floatBitsToUint(z) >> kHalfOctave) - kFirstSlice + 1u, kClusterSlices - 1u);
}
float slice_begin(uint slice) { return slice == 0u ? 0.0 : uintBitsToFloat((kFirstSlice + slice - 1u) << kHalfOctave); }

uint tile_at(uvec2 pixel) { return (pixel.y >> grid.edge_log2) * grid.tiles_x + (pixel.x >> grid.edge_log2); }
uint cluster_of(uint tile, uint slice) { return tile * kClusterSlices + slice; }

// A part of the view's pyramid, in view axes (right, up, forward): the box around it and the slopes of its sides.
struct Cell {
  vec3 low;
  vec3 high;
  vec2 low_slope;   // x / z of the left side, y / z of the lower side
  vec2 high_slope;
};

// @param first, end pixels; @param near, far along the view axis.
Cell cell_of(uvec2 first, uvec2 end, float near, float far) {
  vec2 a = (vec2(first) / vec2(grid.size) * 2.0 - 1.0) * grid.tan_half, b = (vec2(end) / vec2(grid.size) * 2.0 - 1.0) * grid.tan_half;
  Cell c;
  c.low_slope = vec2(a.x, -b.y);
  c.high_slope = vec2(b.x, -a.y);
  c.low = vec3(min(c.low_slope * near, c.low_slope * far), near);
  c.high = vec3(max(c.high_slope * near, c.high_slope * far), far);
  return c;
}

// Bounds of a cell in world axes.
void world_bounds(Cell c, out vec3 low, out vec3 high) {
  low = vec3(1e30);
  high = vec3(-1e30);
  for (uint i = 0u; i < 8u; ++i) {
    float z = (i & 4u) != 0u ? c.high.z : c.low.z;
    vec2 slope = vec2((i & 1u) != 0u ? c.high_slope.x : c.low_slope.x, (i & 2u) != 0u ? c.high_slope.y : c.low_slope.y);
    vec3 corner = (grid.right * slope.x + grid.up * slope.y + grid.forward) * z;
    low = min(low, corner);
    high = max(high, corner);
  }
}

vec3 view_from_world(vec3 v) { return vec3(dot(v, grid.right), dot(v, grid.up), dot(v, grid.forward)); }

// Whether a ball touches a cell's box and lies within its sides. Errs on the side of yes, by `margin` of its distance and radius at least.
bool ball_reaches(vec3 middle, float radius, Cell c, float margin) {
  radius += margin * (radius + abs(middle.x) + abs(middle.y) + abs(middle.z));
  vec3 off = max(max(c.low - middle, middle - c.high), 0.0);
  vec2 outside = max(max(c.low_slope * middle.z - middle.xy, 0.0) * inversesqrt(1.0 + c.low_slope * c.low_slope),
                     max(middle.xy - c.high_slope * middle.z, 0.0) * inversesqrt(1.0 + c.high_slope * c.high_slope));
  return dot(off, off) <= radius * radius && max(outside.x, outside.y) <= radius;
}

// Whether a spot's outer cone touches the ball around a cell's box (Wronski, Cull That Cone, 2017).
bool cone_reaches(Light light, vec3 apex, Cell c) {
  vec3 middle = 0.5 * (c.low + c.high) - apex;
  float radius = 0.5001 * length(c.high - c.low) + 1e-4 * length(middle);
  float along = dot(middle, view_from_world(light.axis));
  if ((light.kind & kLightDualBit) != 0u) along = abs(along);
  float aside = sqrt(max(dot(middle, middle) - along * along, 0.0));
  float sine = sqrt(max(1.0 - light.cos_outer * light.cos_outer, 0.0));
  return light.cos_outer <= 0.0 || light.cos_outer * aside - sine * along <= radius;
}

bool light_reaches(Light light, Cell c, float margin) {
  uint kind = light.kind & kLightKindMask;
  vec3 middle = view_from_world(light.position);
  bool reaches = ball_reaches(middle, light.range, c, margin);
  if ((kLightKinds & (1u << kLightSpot)) != 0u && reaches && kind == kLightSpot) reaches = cone_reaches(light, middle, c);
  return reaches || ((kLightKinds & (1u << kLightDirectional)) != 0u && kind == kLightDirectional);
}
#endif
