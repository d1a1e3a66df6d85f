// What is too bright in the picture, which bloom takes. Needs before the include: shared/bloom.h, include/frame/common.glsl, `exposure`.
// docs/exposure.md.
#ifndef SKERRY_TOO_BRIGHT_GLSL
#define SKERRY_TOO_BRIGHT_GLSL

vec3 exposed_for_bloom(vec3 radiance) { return min(sanitised(radiance) * exp2(-exposure.ev), kMostTaken); }

float brightest_of(vec3 exposed) { return max(exposed.r, max(exposed.g, exposed.b)); }

// False where too_bright() is black. @param brightest channel.
bool over_knee(float brightest, float threshold) { return brightest - threshold + 0.5 * threshold > 0.0; }

// What exceeds the threshold; half of it already begins to count, softly.
vec3 too_bright(vec3 radiance, float threshold) {
  vec3 exposed = exposed_for_bloom(radiance);
  float brightest = brightest_of(exposed), knee = 0.5 * threshold;
  float over = brightest - threshold, soft = clamp(over + knee, 0.0, 2.0 * knee);
  return exposed * (max(over, knee > 0.0 ? soft * soft / (4.0 * knee) : 0.0) / max(brightest, 1e-9));
}
#endif
