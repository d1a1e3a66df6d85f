// What clouds do with light: two Henyey-Greenstein lobes, and light scattered many times as octaves of light scattered once (Wrenninge, Kulla,
// Lundqvist, Oz: The Great and Volumetric, 2013). docs/clouds.md. Twin, written on its own: tools/reference/clouds.cpp.
#ifndef SKERRY_CLOUD_SCATTERING_GLSL
#define SKERRY_CLOUD_SCATTERING_GLSL

const float kCloudAlbedo = 0.99;
const float kForward = 0.75, kBackward = -0.35, kBackwardShare = 0.3;
// An octave has this share of the light of the one before, meets this share of its optical depth, and is this much less one-sided.
const vec4 kOctaveLight = vec4(1.0, 0.6, 0.36, 0.216);
const vec4 kOctaveDepth = vec4(1.0, 0.4, 0.16, 0.064);
const vec4 kOctaveLobe = vec4(1.0, 0.5, 0.25, 0.125);

// Henyey and Greenstein, Diffuse radiation in the galaxy, 1941 [1/sr].
float henyey_greenstein(float cosine, float g) {
  float d = 1.0 + g * g - 2.0 * g * cosine;
  return (0.25 * 0.31830988618) * (1.0 - g * g) / (d * sqrt(d));
}
float cloud_phase(float cosine, float narrowing) {
  return mix(henyey_greenstein(cosine, kForward * narrowing), henyey_greenstein(cosine, kBackward * narrowing), kBackwardShare);
}
// Of each octave, times its light. @param cosine of the angle by which light is turned.
vec4 octave_phases(float cosine) {
  return kOctaveLight * vec4(cloud_phase(cosine, kOctaveLobe.x), cloud_phase(cosine, kOctaveLobe.y), cloud_phase(cosine, kOctaveLobe.z),
                             cloud_phase(cosine, kOctaveLobe.w));
}
float octaves_left(vec4 phases, float depth) { return dot(phases, exp(-depth * kOctaveDepth)); }

// 1 - exp(-x), to the last digits for small x.
float opacity_of(float x) { return x < 0.02 ? x * (1.0 - x * (0.5 - x * (1.0 / 6.0))) : 1.0 - exp(-x); }
#endif
