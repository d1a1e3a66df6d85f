// Water and glass as media, and their surfaces' share of mirrored light. Needs before the include: common.glsl, `frame`.
#ifndef SKERRY_MEDIA_GLSL
#define SKERRY_MEDIA_GLSL
#include "include/light/brdf.glsl"
#include "include/surface/bent.glsl"

// Schlick's approximation of the Fresnel reflectance, for light that enters or leaves a medium of index n.
float fresnel(float cosine, bool leaving, float n) {
  float r0 = (n - 1.0) / (n + 1.0);
  r0 *= r0;
  cosine = clamp(cosine, 0.0, 1.0);
  if (leaving) {  // past the critical angle everything is reflected
    float sine2 = n * n * (1.0 - cosine * cosine);
    if (sine2 >= 1.0) return 1.0;
    cosine = sqrt(1.0 - sine2);
  }
  return r0 + (1.0 - r0) * pow(1.0 - cosine, 5.0);
}

vec3 extinction(Material medium) { return medium.absorption + medium.scattering; }

// 1 - exp(-x), to the last digits for small x.
vec3 opacities(vec3 x) { return mix(1.0 - exp(-x), x * (1.0 - x * (0.5 - x * (1.0 / 6.0))), lessThan(x, vec3(0.02))); }

// Radiance a stretch of medium sends towards the eye when `light` falls on it: single scattering, isotropic phase 1 / (4 pi).
vec3 scattered(Material medium, vec3 light, float path) {
  vec3 total = max(extinction(medium), vec3(1e-6));
  return medium.scattering / total * light * (0.25 * kInvPi) * opacities(total * path);
}

// Of light that comes evenly from all of a way of optical depth x: (1 - exp(-x)) / x.
vec3 mean_transmittance(vec3 x) { return mix(opacities(x) / max(x, 1e-6), 1.0 - 0.5 * x, lessThan(x, vec3(1e-4))); }

// Where a ray that meets no opaque surface ends, from where it is last known [blocks]: far enough for media to take all light.
const float kOpenMedium = 1e4;

// Blocks along the ray. @param opaque depth of the opaque surface; 0: there is none. @param at blocks along the ray.
float end_of_media(float opaque, float at, float ray_length) {
  return opaque > 0.0 ? view_distance(opaque, frame.near_plane) * ray_length : at + kOpenMedium;
}
#endif
