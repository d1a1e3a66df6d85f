// Light of the frame's lights (shared/light.h) at a surface: what arrives, and what of it goes to the eye. Kinds: docs/lights.md.
#ifndef SKERRY_LIGHTS_GLSL
#define SKERRY_LIGHTS_GLSL
#include "shared/light.h"
#include "include/light/brdf.glsl"
#include "include/light/light_kinds.glsl"

// Nearer than this, light grows no more [blocks].
const float kNearestLight = 0.01;

// What ends a light at its range, smoothly (Karis, Real Shading in Unreal Engine 4, 2013). @param distance2 squared, to the light's position.
float light_window(Light light, float distance2) {
  float q = distance2 / (light.range * light.range);
  float w = max(1.0 - q * q, 0.0);
  return w * w;
}

// Asked first: a list holds what reaches its cluster, of which a group of neighbouring pixels may well be out of range as one.
bool out_of_range(Light light, vec3 point) {
  vec3 way = light.position - point;
  bool everywhere = (kLightKinds & (1u << kLightDirectional)) != 0u && (light.kind & kLightKindMask) == kLightDirectional;
  return !everywhere && dot(way, way) >= light.range * light.range;
}

// 1 within the inner cone, 0 beyond the outer one. @param to_light unit.
float light_cone(Light light, vec3 to_light) {
  float cosine = -dot(light.axis, to_light);
  if ((light.kind & kLightDualBit) != 0u) cosine = abs(cosine);
  return smoothstep(light.cos_outer, light.cos_inner, cosine);
}

// A light as it arrives at a point.
struct Arrival {
  vec3 to_light;    // unit, towards the point of the light that stands for its diffuse light
  float facing;     // irradiance that an intensity of 1 gives a surface with this normal
  vec3 to_mirrored; // unit, towards the point that stands for its image in the surface
  float mirrored;   // irradiance that an intensity of 1 gives a surface facing that point, thinned out over the image's size
};

// The part of the line from a to b (relative to a point) that is before a surface. @return its share; 0: it is behind.
float clip_to_front(inout vec3 a, inout vec3 b, vec3 normal) {
  float at_a = dot(normal, a), at_b = dot(normal, b);
  if (at_a <= 0.0 && at_b <= 0.0) return 0.0;
  vec3 cut = a + (b - a) * clamp(at_a / (at_a - at_b), 0.0, 1.0);
  float share = at_a < 0.0 ? at_b / (at_b - at_a) : at_b < 0.0 ? at_a / (at_a - at_b) : 1.0;
  if (at_a < 0.0) a = cut;
  if (at_b < 0.0) b = cut;
  return share;
}

// A line of `size` to either side of the position. Its diffuse light is exact: the integral of the points' over the part before the surface.
Arrival from_tube(Light light, vec3 to_middle, vec3 normal, vec3 mirrored, float alpha, float window) {
  vec3 a = to_middle - light.axis * light.size, b = to_middle + light.axis * light.size;
  vec3 along = b - a;
  float share = clip_to_front(a, b, normal);
  float length_a = max(length(a), kNearestLight), length_b = max(length(b), kNearestLight);
  float spread = max(length_a * length_b + dot(a, b), kNearestLight * kNearestLight);
  vec3 mean = a / length_a + b / length_b;
  Arrival r;
  r.to_light = mean * inversesqrt(max(dot(mean, mean), 1e-12));
  r.facing = window * share * max(dot(normal, mean), 0.0) / spread;
  // The point of the line nearest to the mirrored ray (Karis 2013).
  float across = dot(mirrored, along);
  float t = (dot(mirrored, to_middle) * across - dot(to_middle, along)) / max(dot(along, along) - across * across, 1e-6);
  vec3 nearest = to_middle + along * clamp(t, -0.5, 0.5);
  float distance = max(length(nearest), kNearestLight);
  r.to_mirrored = nearest / distance;
  r.mirrored = window * 2.0 * share / spread * (alpha / min(alpha + light.size / (2.0 * distance), 1.0));
  return r;
}

// @param point, normal (unit) of the surface; @param mirrored the direction the eye sees in it; @param alpha of its lobe.
Arrival arrive(Light light, vec3 point, vec3 normal, vec3 mirrored, float alpha) {
  uint kind = light.kind & kLightKindMask;
  vec3 to_middle = light.position - point;
  float distance2 = dot(to_middle, to_middle);
  float distance = sqrt(distance2);
  float window = light_window(light, distance2);
  if ((kLightKinds & (1u << kLightTube)) != 0u && kind == kLightTube) return from_tube(light, to_middle, normal, mirrored, alpha, window);
  Arrival r;
  r.to_light = to_middle / max(distance, 1e-12);
  float reach = max(distance, kNearestLight);
  if ((kLightKinds & (1u << kLightSphere)) != 0u) reach = max(reach, light.size);  // 0 of other kinds
  float irradiance = window / (reach * reach);
  if ((kLightKinds & (1u << kLightSpot)) != 0u && kind == kLightSpot) irradiance *= light_cone(light, r.to_light);
  if ((kLightKinds & (1u << kLightDirectional)) != 0u && kind == kLightDirectional) {
    r.to_light = -light.axis;
    irradiance = 1.0;
  }
  r.facing = irradiance * max(dot(normal, r.to_light), 0.0);
  r.to_mirrored = r.to_light;
  r.mirrored = irradiance;
  if ((kLightKinds & (1u << kLightSphere)) != 0u && kind == kLightSphere) {
    // The point of the sphere nearest to the mirrored ray; its image is as bright as the light however large it is (Karis 2013).
    vec3 aside = mirrored * dot(to_middle, mirrored) - to_middle;
    vec3 nearest = to_middle + aside * min(light.size * inversesqrt(max(dot(aside, aside), 1e-12)), 1.0);
    r.to_mirrored = nearest * inversesqrt(max(dot(nearest, nearest), 1e-12));
    float wider = alpha / min(alpha + light.size / (2.0 * reach), 1.0);
    r.mirrored = irradiance * wider * wider;
  }
  return r;
}

// Radiance of one light, with nothing in its way, that a surface sends to the eye; exactly 0 out of its range, out of its cone and behind the surface.
vec3 light_reflected(Light light, Brdf b, vec3 point, vec3 normal, vec3 to_eye) {
  Arrival r = arrive(light, point, normal, reflect(-to_eye, normal), b.alpha);
  float n_dot_l = max(dot(normal, r.to_mirrored), 0.0);
  vec3 share = brdf_diffuse(b, clamp(dot(normal, r.to_light), 0.0, 1.0)) * r.facing +
               brdf_mirror(b, normal, to_eye, r.to_mirrored, n_dot_l) * (r.mirrored * n_dot_l);
  if (r.facing <= 0.0) return vec3(0.0);
  return light.intensity * share;
}

// Irradiance of one light with nothing in its way.
vec3 light_received(Light light, vec3 point, vec3 normal) {
  Arrival r = arrive(light, point, normal, normal, 1.0);
  return light.intensity * r.facing;
}
#endif
