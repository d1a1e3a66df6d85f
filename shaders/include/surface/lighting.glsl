// Light functions used by opaque and translucent shading alike.
// Needs before the include: what visibility.glsl needs.
#ifndef SKERRY_LIGHTING_GLSL
#define SKERRY_LIGHTING_GLSL

#include "include/sky/cloud_light.glsl"
#include "include/light/visibility.glsl"
#include "include/surface/under_water.glsl"

// What sun and moon bring to a surface.
struct BodyLight {
  vec3 to_light;
  vec3 irradiance;  // of a surface that faces it
  float n_dot_l;
};
BodyLight light_of_body(Surface s, Depth depth, const uint index, const uint first_cascade) {
  Body body = frame.bodies[index];
  BodyWay way = body_way(depth, body.to_light);
  float n_dot_l = dot(s.normal, way.to_light), faces = n_dot_l;
  Surface asked = s;
  bool shaded = false;
  if (kUnderWater) {
    bool under = depth.blocks > 0.0;
    if (under) {
      asked.position = near_surface(depth, s.position, way.to_light);
      asked.normal = depth.up;
      asked.plant = false;
      faces = dot(depth.up, body.to_light);
    }
    shaded = shaded_in_water(depth, s.position, s.normal, body.to_light, first_cascade) && under;
  }
  float visibility = surface_visibility(asked, body.to_light, first_cascade, faces) * light_through_clouds(index, s.position);
  bool reached = n_dot_l > 0.0 && !shaded;
  vec3 share = way.share * visibility;
  if (kUnderWater) share *= lit_again(depth);
  if (kGlass && index == frame.glass_body) share *= depth.through_glass;
  return BodyLight(way.to_light, reached ? body.irradiance * share : vec3(0.0), n_dot_l);
}

// Radiance that a surface sends to the eye under one body. A face turned away is in its own block's shadow.
vec3 reflected(Surface s, Depth depth, Brdf b, vec3 to_eye, const uint index, const uint first_cascade) {
  BodyLight light = light_of_body(s, depth, index, first_cascade);
  float cosine = frame.shading_flat != 0u ? 1.0 : light.n_dot_l;
  return light.irradiance * (brdf(b, s.normal, to_eye, light.to_light, max(light.n_dot_l, 0.0)) * cosine);
}

layout(constant_id = kSunlessConstant) const bool kSunless = false;  // neither sun nor moon reaches any pixel

// Radiance a surface sends to the eye: of sun and moon, and its own. No ambient term: what no light reaches is exactly 0.
vec3 shade_surface(Surface s, Depth depth) {
  if (kSunless) return s.emitted;
  vec3 to_eye = -normalize(s.position);
  Brdf b = surface_brdf(s, to_eye);
  vec3 radiance = vec3(0.0);
  if ((kBodies & 1u) != 0u) radiance += reflected(s, depth, b, to_eye, 0u, 0u);
  if ((kBodies & 2u) != 0u) radiance += reflected(s, depth, b, to_eye, 1u, kMoonCascade);
  return radiance * s.ao + s.emitted;
}
#endif
