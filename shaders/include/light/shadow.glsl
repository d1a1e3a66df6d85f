// How much of a body's light reaches a point: cascaded shadow maps, filtered by taps on a disc.
// Needs before the include: `frame` (FrameConstants) and `shadow_maps` (sampler2DArray of reverse depth, nearest filter).
#ifndef SKERRY_SHADOW_GLSL
#define SKERRY_SHADOW_GLSL
#include "shared/constants.h"

layout(constant_id = kShadowTapsConstant) const uint kShadowTaps = 8u;             // 1, 4, 8, 16 or 32
layout(constant_id = kShadowBlurConstant) const bool kShadowBlur = true;  // the filter follows what casts the shadow
layout(constant_id = kSamplesPerEdgeConstant) const uint kSamplesPerEdge = 1u;       // of a pixel; each sample turns the taps its own way
layout(constant_id = kCascadesConstant) const uint kCascades = kCascadeCount;  // a body has, 1 to kCascadeCount

// What light falls on in one map: the receiver's plane, to be compared with the map's texels.
struct Receiver {
  vec3 map;     // texel coordinate and depth
  vec2 slope;   // change of depth along a texel of the plane
  float bias;   // what rounding needs [depth]
  float most;   // the plane is followed towards the light by no more than this [depth]
  uint layer;
};

// How far the nearest thing at a texel stands before the receiver's plane [depth]; below 0: the light reaches the plane.
float blocker_at(vec2 offset, const Receiver r) {
  vec2 texel = floor(r.map.xy + offset);
  float plane_depth = r.map.z + min(dot(r.slope, texel + 0.5 - r.map.xy) + r.bias, r.most);
  float nearest = texelFetch(shadow_maps, ivec3(ivec2(texel), int(r.layer)), 0).r;
  return plane_depth >= nearest ? -1.0 : nearest - plane_depth;
}
float shadow_tap(vec2 offset, const Receiver r) { return blocker_at(offset, r) < 0.0 ? 1.0 : 0.0; }

// Turns a tap so that the samples of a pixel look at different places between them, and all pixels alike.
// @pre work groups are 8x8 pixels.
vec2 turned(vec2 offset) {
  if (kSamplesPerEdge == 1u) return offset;
  uvec2 place = gl_LocalInvocationID.xy % kSamplesPerEdge;
  float angle = 1.57079633 * float(place.y * kSamplesPerEdge + place.x) / float(kSamplesPerEdge * kSamplesPerEdge);
  return vec2(offset.x * cos(angle) - offset.y * sin(angle), offset.x * sin(angle) + offset.y * cos(angle));
}

// Share of a disc that sees the light, 0..1, by kShadowTaps taps, and on a wide disc up to 32: where a tap stands for more than a texel or two, holes
// between leaves show as copies of themselves, one a tap. @param radius [texels].
float filtered(float radius, const Receiver r) {
  // Unrolled by hand: an array of offsets would live in memory. In opposite pairs, so that no set moves a shadow's
  // edge. Each set holds the smaller one before it; what it adds lies at the centroids of the disc's parts nearest to it (Lloyd).
#define PAIR(p) (shadow_tap(turned(p) * radius, r) + shadow_tap(turned(-(p)) * radius, r))
#define OF_ROUND(x0, y0, x1, y1, x2, y2, x3, y3) \
  (k == 0u ? vec2(x0, y0) : k == 1u ? vec2(x1, y1) : k == 2u ? vec2(x2, y2) : vec2(x3, y3))
  if (kShadowTaps == 1u) return shadow_tap(vec2(0.0), r);
  if (kShadowTaps == 4u) return (PAIR(vec2(0.539, 0.265)) + PAIR(vec2(-0.265, 0.539))) * 0.25;
  float texels = 3.14159265 * radius * radius;
  uint rounds = max(kShadowTaps / 8u, texels > 16.0 ? 4u : texels > 8.0 ? 2u : 1u);
  float lit = 0.0;
  // By rounds of eight: lavapipe runs all that an `if` holds, but no round that none of its pixels needs.
  for (uint k = 0u;;) {
    lit += PAIR(OF_ROUND(0.539, 0.265, -0.194, -0.038, 0.791, 0.378, 0.187, 0.418));
    lit += PAIR(OF_ROUND(-0.265, 0.539, 0.837, 0.128, -0.093, 0.264, 0.580, -0.531));
    lit += PAIR(OF_ROUND(0.238, 0.705, -0.621, -0.578, 0.878, -0.118, -0.061, 0.837));
    lit += PAIR(OF_ROUND(-0.705, 0.238, -0.439, 0.740, 0.793, -0.441, 0.441, -0.144));
    if (++k == rounds) break;
  }
#undef OF_ROUND
#undef PAIR
  return lit / float(8u * rounds);
}

// Of the taps of a search: x how many are in shadow, y the sum of the distances of what shades them [depth].
vec2 found_at(vec2 offset, const Receiver r) {
  float depth = blocker_at(offset, r);
  return depth < 0.0 ? vec2(0.0) : vec2(1.0, depth);
}
vec2 found_around(vec2 offset, const Receiver r) {
  offset = turned(offset);
  vec2 across = vec2(-offset.y, offset.x);
  return found_at(offset, r) + found_at(-offset, r) + found_at(across, r) + found_at(-across, r);
}

// Share of the light that reaches a point, by one map. The filter is as wide as the disc's shadow edge is where what casts it stands
// (percentage-closer soft shadows, R. Fernando 2005): that is looked for on three rings. Where all of them agree there is no edge.
// Each tap compares at a texel's centre with the depth that the receiver's own plane has there (receiver plane depth bias, Isidoro,
// GDC 2006), so a lit plane never shadows itself and the remaining bias only covers rounding: rasterised depths are exact to 1/256
// texel of the slope.
float cascade_visibility(Cascade cascade, vec3 p, vec3 normal, float n_dot_l) {
  float texel = cascade.texel_blocks;
  // Half a texel off the surface: where two planes meet, the taps that fall behind the other plane would darken the corner.
  vec3 q = p + normal * (0.5 * texel);
  Receiver r;
  r.map = vec3(dot(cascade.map_from_world_x, vec4(q, 1.0)), dot(cascade.map_from_world_y, vec4(q, 1.0)),
               dot(cascade.map_from_world_z, vec4(q, 1.0)));
  float per_texel = -cascade.depth_per_block * texel * texel / max(n_dot_l, 0.02);
  r.slope = per_texel * vec2(dot(cascade.map_from_world_x.xyz, normal), dot(cascade.map_from_world_y.xyz, normal));
  r.bias = cascade.depth_per_block * (0.004 + 0.02 * texel) + 0.016 * (abs(r.slope.x) + abs(r.slope.y));
  // The receiver's plane is followed towards the light by less than the thinnest wall (one block) where texels are small enough for that, so that
  // what stands behind a wall stays dark; where they are not, by the six texels that the plane needs.
  r.most = cascade.depth_per_block * max(0.9, 6.0 * texel);
  r.layer = cascade.layer;
  float allowed = (r.most - r.bias - 0.5 * (abs(r.slope.x) + abs(r.slope.y))) / max(length(r.slope), 1e-12);
  float least = clamp(allowed, 0.0, 1.0);  // texels
  if (!kShadowBlur) return filtered(least, r);
  float widest = clamp(allowed, least, max(frame.shadow_blur / texel, 1.0));
  const vec2 kNear = vec2(0.924, 0.383), kMid = vec2(0.240, 0.320), kFar = vec2(0.0, 0.8);
  vec2 found = found_around(kNear * least, r) + found_around(kMid * widest, r) + found_around(kFar * widest, r);
  if (found.x == 0.0) return 1.0;
  float distance_blocks = found.y / (found.x * cascade.depth_per_block);
  return filtered(clamp(kBodyRadius * distance_blocks / texel, least, widest), r);
}

// Field by field: an `if` would hold loads, which lavapipe then does lane by lane.
Cascade selected(bool second, Cascade a, Cascade b) {
  bvec4 by = bvec4(second);
  return Cascade(mix(a.map_from_world_x, b.map_from_world_x, by), mix(a.map_from_world_y, b.map_from_world_y, by),
                 mix(a.map_from_world_z, b.map_from_world_z, by), mix(a.radius, b.radius, second), mix(a.texel_blocks, b.texel_blocks, second),
                 mix(a.depth_per_block, b.depth_per_block, second), mix(a.layer, b.layer, second), mix(a.glass_layer, b.glass_layer, second),
                 mix(a.glass_area, b.glass_area, by));
}

// One of a body's cascades. Selected among values that every pixel loads alike, because on lavapipe a load with its own address for each pixel
// costs as much as a dozen selections.
Cascade pick_cascade(const uint base, uint index) {
  Cascade c = frame.cascades[base];
  if (kCascades > 1u) c = selected(index == 1u, c, frame.cascades[base + 1u]);
  if (kCascades > 2u) c = selected(index == 2u, c, frame.cascades[base + 2u]);
  if (kCascades > 3u) c = selected(index == 3u, c, frame.cascades[base + 3u]);
  return c;
}

// How many of a body's first `of` cascades end nearer than a distance.
uint cascades_within(const uint base, const uint of, float distance) {
  uint count = 0u;
  if (of > 0u) count += uint(distance > frame.cascades[base].radius);
  if (of > 1u) count += uint(distance > frame.cascades[base + 1u].radius);
  if (of > 2u) count += uint(distance > frame.cascades[base + 2u].radius);
  if (of > 3u) count += uint(distance > frame.cascades[base + 3u].radius);
  return count;
}

// 0 in shadow, 1 in full light. Cascades are spheres around the camera; over the last fifth of its radius each fades into the next.
// Past the last cascade nothing is known, so nothing is lit.
// `base` is the body's first cascade and a constant, so that cascades are loaded alike by all pixels.
float cascades_visibility(const uint base, vec3 p, vec3 normal, float n_dot_l) {
  float distance = length(p);
  uint index = cascades_within(base, kCascades, distance);
  float known = index < kCascades ? 1.0 : 0.0;
  Cascade cascade = pick_cascade(base, index);
  // The last cascade has no successor to fade into.
  float to_next = index < kCascades - 1u ? clamp((distance / cascade.radius - 0.8) / 0.2, 0.0, 1.0) : 0.0;
  float visibility = 0.0;
  float weight = 1.0 - to_next;
  Cascade next = pick_cascade(base, index + 1u);  // ahead of the loop, within which loads are done lane by lane
  // A second round only where some pixel fades.
  for (uint round = 0u;; ++round) {
    visibility += weight * cascade_visibility(cascade, p, normal, n_dot_l);
    if (round == 1u || to_next == 0.0) break;
    weight = to_next;
    cascade = next;
  }
  return known * visibility;
}

float air_tap(Cascade c, vec3 p) {
  vec3 map = vec3(dot(c.map_from_world_x, vec4(p, 1.0)), dot(c.map_from_world_y, vec4(p, 1.0)), dot(c.map_from_world_z, vec4(p, 1.0)));
  return map.z >= texelFetch(shadow_maps, ivec3(ivec2(floor(map.xy)), int(c.layer)), 0).r ? 1.0 : 0.0;
}

// Whether a body's light reaches a place, by one texel of the finest map there. Inside closed walls it is as dark as air_visibility() has it.
float place_visibility(const uint base, vec3 p) {
  float distance = length(p);
  bool known = distance <= frame.cascades[base + kCascades - 1u].radius;
  Cascade c = pick_cascade(base, cascades_within(base, kCascades - 1u, distance));
  return known ? air_tap(c, known ? p : vec3(0.0)) : 0.0;
}

// Share of three places on the way to p, in the air, that a body's light reaches; one texel each. Taken from the coarsest map that cannot leak:
// inside closed walls of one block every texel centre nearer than a block sees the walls, and the nearest centre is within 0.71 texels. Ways that
// leave that map take the next coarser one: only a closed room as large as that could leak. Past the last map nothing is known.
float air_visibility(const uint base, vec3 p) {
  const float kTightTexel = 1.3;
  float distance = length(p);
  uint tight = 0u;
  if (kCascades > 1u && frame.cascades[base + 1u].texel_blocks <= kTightTexel) tight = 1u;
  if (kCascades > 2u && frame.cascades[base + 2u].texel_blocks <= kTightTexel) tight = 2u;
  if (kCascades > 3u && frame.cascades[base + 3u].texel_blocks <= kTightTexel) tight = 3u;
  uint first = cascades_within(base, kCascades - 1u, distance);
  bool known = distance <= frame.cascades[base + kCascades - 1u].radius;
  Cascade c = pick_cascade(base, max(tight, first));
  vec3 inside = known ? p : vec3(0.0);
  float lit = air_tap(c, inside * 0.2) + air_tap(c, inside * 0.5) + air_tap(c, inside * 0.8);
  return known ? lit * (1.0 / 3.0) : 0.0;
}
#endif
