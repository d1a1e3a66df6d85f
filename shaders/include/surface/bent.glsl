// Rays that the surface of level water bends, by Snell's law, or mirrors.
#ifndef SKERRY_BENT_GLSL
#define SKERRY_BENT_GLSL

const float kWaterIndex = 1.333;

// From within, into the air. A ripple may turn it back into the surface's own plane: it goes on as if it had been mirrored there.
// @param dir unit. @param shading, n of the surface, with and without ripples, towards the eye.
// @return unit; 0 where all light is mirrored back.
vec3 bent_into_air(vec3 dir, vec3 shading, vec3 n) {
  vec3 bent = refract(dir, shading, kWaterIndex);
  return bent - n * (2.0 * max(dot(bent, n), 0.0));
}

// A mirrored ray that a ripple turns into its own surface's plane goes on as if it had been mirrored there again.
vec3 mirrored_ray(vec3 to_eye, vec3 shading_normal, vec3 normal) {
  vec3 mirror = reflect(-to_eye, shading_normal);
  return mirror - normal * (2.0 * min(dot(mirror, normal), 0.0));
}
#endif
