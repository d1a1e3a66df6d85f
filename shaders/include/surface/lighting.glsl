// Light functions used by opaque and translucent shading alike.
// Needs before the include: what visibility.glsl needs.
#ifndef SKERRY_LIGHTING_GLSL
#define SKERRY_LIGHTING_GLSL

#include "include/sky/cloud_light.glsl"
#include "include/light/visibility.glsl"

// Radiance that a surface sends to the eye under one body. A face turned away is in its own block's shadow.
vec3 reflected(Surface s, Brdf b, vec3 to_eye, const uint index, const uint first_cascade) {
  Body body = frame.bodies[index];
  float n_dot_l = dot(s.normal, body.to_light);
  float visibility = surface_visibility(s, body.to_light, first_cascade, n_dot_l) * light_through_clouds(index, s.position);
  float cosine = frame.shading_flat != 0u ? 1.0 : n_dot_l;
  vec3 share = brdf(b, s.normal, to_eye, body.to_light, max(n_dot_l, 0.0)) * cosine;
  return n_dot_l > 0.0 ? body.irradiance * (share * visibility) : vec3(0.0);
}

layout(constant_id = kSunlessConstant) const bool kSunless = false;  // neither sun nor moon reaches any pixel

// Radiance a surface sends to the eye: of sun and moon, and its own. No ambient term: what no light reaches is exactly 0.
vec3 shade_surface(Surface s) {
  if (kSunless) return s.emitted;
  vec3 to_eye = -normalize(s.position);
  Brdf b = surface_brdf(s, to_eye);
  vec3 radiance = vec3(0.0);
  if ((kBodies & 1u) != 0u) radiance += reflected(s, b, to_eye, 0u, 0u);
  if ((kBodies & 2u) != 0u) radiance += reflected(s, b, to_eye, 1u, kMoonCascade);
  return radiance * s.ao + s.emitted;
}
#endif
