// Light functions used by opaque and translucent shading alike.
// Needs before the include: `frame`; with kShadows also what shadow.glsl needs.
#ifndef SKERRY_LIGHTING_GLSL
#define SKERRY_LIGHTING_GLSL

const float kInvPi = 0.31830988618;

// Share of a body's light that reaches a point on a surface. A face turned away is in its own block's shadow.
float light_visibility(Body body, vec3 p, vec3 normal, float n_dot_l) {
#ifdef SKERRY_SHADOWS
  return body_visibility(body, p, normal, n_dot_l);
#else
  return 1.0;
#endif
}

// Which bodies give light: bit 0 the sun, bit 1 the moon. A constant, so that the other body costs nothing.
layout(constant_id = 8) const uint kBodies = 3u;

// Light of one body that a surface receives.
vec3 received(Body body, vec3 p, vec3 normal) {
  float n_dot_l = dot(normal, body.to_light);
  float visibility = light_visibility(body, p, normal, n_dot_l);
  return n_dot_l > 0.0 ? body.irradiance * (visibility * (frame.shading_flat != 0u ? 1.0 : n_dot_l)) : vec3(0.0);
}

float light_in_air(Body body, vec3 p) {
#ifdef SKERRY_SHADOWS
  return air_visibility(body, p);
#else
  return 1.0;
#endif
}

// What the air between eye and surface does to a surface's radiance: it takes a part away and sends light of its own, the colour of the sky behind,
// as far as sun or moon reach it at three places along the way. No haze where they do not: a cave stays black.
vec3 seen_through_air(vec3 radiance, vec3 p) {
  if (kBodies == 0u) return radiance;
  Body body = frame.bodies[(kBodies & 1u) != 0u ? 0 : 1];
  float lit = (light_in_air(body, p * 0.2) + light_in_air(body, p * 0.5) + light_in_air(body, p * 0.8)) * (1.0 / 3.0);
  float distance = length(p);
  float clear = exp(-frame.haze_per_block * distance);
  return radiance * clear + sample_sky(sky_lut, p / distance) * (lit * (1.0 - clear));
}

// Radiance a diffuse surface sends out under sun and moon. No ambient term: what no light reaches is exactly 0.
vec3 shade_diffuse(Surface s) {
  vec3 light = vec3(0.0);
  if ((kBodies & 1u) != 0u) light += received(frame.bodies[0], s.position, s.normal);
  if ((kBodies & 2u) != 0u) light += received(frame.bodies[1], s.position, s.normal);
  return s.albedo * kInvPi * light + s.emitted;
}
#endif
