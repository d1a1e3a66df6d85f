// How much of a body's light what stands before it leaves, by shadow maps if there are any.
// Needs before the include: `frame`, `shadow_maps` (sampler2DArray of reverse depth, nearest filter).
#ifndef SKERRY_VISIBILITY_GLSL
#define SKERRY_VISIBILITY_GLSL
#include "shared/constants.h"
#include "include/light/reflection.glsl"
#include "include/light/shadow.glsl"

layout(constant_id = kShadowsConstant) const bool kShadows = false;  // there are maps; if not, something is bound that is never read

// The moon's cascades come after the sun's, if there are any.
const uint kMoonCascade = (kBodies & 1u) != 0u ? kCascades : 0u;

float body_visibility(const uint first_cascade, vec3 p, vec3 normal, float n_dot_l) {
  return kShadows ? cascades_visibility(first_cascade, p, normal, n_dot_l) : 1.0;
}
float light_in_air(const uint first_cascade, vec3 p) { return kShadows ? air_visibility(first_cascade, p) : 1.0; }
float light_at_place(const uint first_cascade, vec3 p) { return kShadows ? place_visibility(first_cascade, p) : 1.0; }

// How far light on its way out of a plant's voxel goes [blocks].
float way_out(Surface s, vec3 to_light) {
  vec3 way = vec3(dot(s.axis_x, to_light), dot(s.axis_y, to_light), dot(s.axis_z, to_light));
  vec3 room = mix(s.in_voxel, 1.0 - s.in_voxel, greaterThan(way, vec3(0.0))) / max(abs(way), 1e-6);
  return min(min(room.x, room.y), room.z);
}

// How much of a body's light reaches a surface, 0..1. A plant does not shade itself: its two planes stand for loose leaves, so shadow is
// asked for where the light enters its voxel, on a plane that faces the light.
float surface_visibility(Surface s, vec3 to_light, const uint first_cascade, float n_dot_l) {
  vec3 place = s.plant ? s.position + to_light * way_out(s, to_light) : s.position;
  return body_visibility(first_cascade, place, (s.plant ? to_light : s.normal), (s.plant ? 1.0 : n_dot_l));
}
#endif
