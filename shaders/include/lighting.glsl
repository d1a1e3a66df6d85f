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

// Radiance a diffuse surface sends out under sun and moon. No ambient term: what no light reaches is exactly 0.
vec3 shade_diffuse(Surface s) {
  vec3 light = vec3(0.0);
  for (uint b = 0u; b < kBodyCount; ++b) {
    Body body = frame.bodies[b];
    float n_dot_l = dot(s.normal, body.to_light);
    bool reached = n_dot_l > 0.0 && body.irradiance != vec3(0.0);
    // A loop, not a branch: lavapipe skips an empty loop but runs both sides of a branch.
    for (int once = reached ? 1 : 0; once > 0; --once) {
      float visibility = light_visibility(body, s.position, s.normal, n_dot_l);
      light += body.irradiance * (visibility * (frame.shading_flat != 0u ? 1.0 : n_dot_l));
    }
  }
  return s.albedo * kInvPi * light + s.emitted;
}
#endif
