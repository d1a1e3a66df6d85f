// Light functions used by opaque and translucent shading alike.
// Needs before the include: `frame`; with kShadows also what shadow.glsl needs.
#ifndef SKERRY_LIGHTING_GLSL
#define SKERRY_LIGHTING_GLSL

#include "include/reflection.glsl"

#ifdef SKERRY_SHADOWS
// The moon's cascades come after the sun's, if there are any.
const uint kMoonCascade = (kBodies & 1u) != 0u ? kCascades : 0u;
#define body_visibility(first_cascade, p, normal, n_dot_l) cascades_visibility(first_cascade, p, normal, n_dot_l)
#define light_in_air(first_cascade, p) air_visibility(first_cascade, p)
#else
const uint kMoonCascade = 0u;
#define body_visibility(first_cascade, p, normal, n_dot_l) 1.0
#define light_in_air(first_cascade, p) 1.0
#endif

// Share of a body's light that clouds let through to a place in the open.
#ifdef SKERRY_CLOUDS
#define past_clouds(body, p) light_through_clouds(body, p)
#else
#define past_clouds(body, p) 1.0
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
  return body_visibility(first_cascade, place, (s.plant ? to_light : s.normal), (s.plant ? 1.0 : n_dot_l));
}

// Radiance that a surface sends to the eye under one body. A face turned away is in its own block's shadow.
vec3 reflected(Surface s, Brdf b, vec3 to_eye, const uint index, const uint first_cascade) {
  Body body = frame.bodies[index];
  float n_dot_l = dot(s.normal, body.to_light);
  float visibility = surface_visibility(s, body.to_light, first_cascade, n_dot_l) * past_clouds(index, s.position);
  float cosine = frame.shading_flat != 0u ? 1.0 : n_dot_l;
  vec3 share = brdf(b, s.normal, to_eye, body.to_light, max(n_dot_l, 0.0)) * cosine;
  return n_dot_l > 0.0 ? body.irradiance * (share * visibility) : vec3(0.0);
}

// What the air between eye and surface does to a surface's radiance: it takes a part away and sends light of its own, the colour of the sky behind,
// as far as sun or moon reach it at three places along the way, and past clouds at one. No haze where they do not: a cave stays black.
vec3 seen_through_air(vec3 radiance, vec3 p) {
  if (kBodies == 0u || !kHaze) return radiance;
  // The sun's cascades, or the moon's when it is alone: the first either way.
  float lit = light_in_air(0u, p) * past_clouds((kBodies & 1u) != 0u ? 0u : 1u, p * 0.5);
  float clear = clear_air(p);
  return radiance * clear + sample_sky(sky_lut, p / length(p)) * (lit * (1.0 - clear));
}

// Radiance a surface sends to the eye: of sun and moon, and its own. No ambient term: what no light reaches is exactly 0.
vec3 shade_surface(Surface s) {
  vec3 to_eye = -normalize(s.position);
  Brdf b = surface_brdf(s, to_eye);
  vec3 radiance = vec3(0.0);
  if ((kBodies & 1u) != 0u) radiance += reflected(s, b, to_eye, 0u, 0u);
  if ((kBodies & 2u) != 0u) radiance += reflected(s, b, to_eye, 1u, kMoonCascade);
  return radiance * s.openness + s.emitted;
}
#endif
