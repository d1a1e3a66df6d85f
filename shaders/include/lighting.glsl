// Light functions used by opaque and translucent shading alike.
// Needs before the include: `frame`; with kShadows also what shadow.glsl needs.
#ifndef SKERRY_LIGHTING_GLSL
#define SKERRY_LIGHTING_GLSL

const float kInvPi = 0.31830988618;

layout(constant_id = 11) const bool kHaze = true;
// Which bodies give light: bit 0 the sun, bit 1 the moon. A constant, so that the other body costs nothing.
layout(constant_id = 8) const uint kBodies = 3u;

#ifdef SKERRY_SHADOWS
// The moon's cascades come after the sun's, if there are any.
const uint kMoonCascade = (kBodies & 1u) != 0u ? kCascades : 0u;
#define light_visibility(first_cascade, p, normal, n_dot_l) cascades_visibility(first_cascade, p, normal, n_dot_l)
#define light_in_air(first_cascade, p) air_visibility(first_cascade, p)
#else
const uint kMoonCascade = 0u;
#define light_visibility(first_cascade, p, normal, n_dot_l) 1.0
#define light_in_air(first_cascade, p) 1.0
#endif

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
  return light_visibility(first_cascade, place, (s.plant ? to_light : s.normal), (s.plant ? 1.0 : n_dot_l));
}

// Light of one body that a surface receives. A face turned away is in its own block's shadow.
vec3 received(Surface s, Body body, const uint first_cascade) {
  float n_dot_l = dot(s.normal, body.to_light);
  float visibility = surface_visibility(s, body.to_light, first_cascade, n_dot_l);
  return n_dot_l > 0.0 ? body.irradiance * (visibility * (frame.shading_flat != 0u ? 1.0 : n_dot_l)) : vec3(0.0);
}

// What the air between eye and surface does to a surface's radiance: it takes a part away and sends light of its own, the colour of the sky behind,
// as far as sun or moon reach it at three places along the way. No haze where they do not: a cave stays black.
vec3 seen_through_air(vec3 radiance, vec3 p) {
  if (kBodies == 0u || !kHaze) return radiance;
  // The sun's cascades, or the moon's when it is alone: the first either way.
  float lit = light_in_air(0u, p);
  float distance = length(p);
  float clear = exp(-frame.haze_per_block * distance);
  return radiance * clear + sample_sky(sky_lut, p / distance) * (lit * (1.0 - clear));
}

// Radiance a diffuse surface sends out under sun and moon. No ambient term: what no light reaches is exactly 0.
vec3 shade_diffuse(Surface s) {
  vec3 light = vec3(0.0);
  if ((kBodies & 1u) != 0u) light += received(s, frame.bodies[0], 0u);
  if ((kBodies & 2u) != 0u) light += received(s, frame.bodies[1], kMoonCascade);
  return s.albedo * (kInvPi * s.openness) * light + s.emitted;
}
#endif
