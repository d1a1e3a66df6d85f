// What clouds do with light: two Henyey-Greenstein lobes, and light scattered many times as terms of the form of light scattered once (after Wrenninge,
// Kulla, Lundqvist, Oz: The Great and Volumetric, 2013). docs/clouds.md. Twin, written on its own: tools/reference/clouds.cpp.
#ifndef SKERRY_CLOUD_SCATTERING_GLSL
#define SKERRY_CLOUD_SCATTERING_GLSL

const float kCloudAlbedo = 0.99;
const float kForward = 0.75, kBackward = -0.35, kBackwardShare = 0.3;
// Light scattered once, then three terms for what is scattered more often: each has a share of the light, meets a share of the optical depth,
// and is a share as one-sided. Fitted to random walks in slabs: docs/clouds.md.
const vec4 kTermLight = vec4(1.0, 1.5, 0.36, 0.05);
const vec4 kTermDepth = vec4(1.0, 0.9, 0.063, 0.14);
const vec4 kTermLobe = vec4(1.0, 0.0, 0.45, 0.7);

// Henyey and Greenstein, Diffuse radiation in the galaxy, 1941 [1/sr].
float henyey_greenstein(float cosine, float g) {
  float d = 1.0 + g * g - 2.0 * g * cosine;
  return (0.25 * 0.31830988618) * (1.0 - g * g) / (d * sqrt(d));
}
float cloud_phase(float cosine, float narrowing) {
  return mix(henyey_greenstein(cosine, kForward * narrowing), henyey_greenstein(cosine, kBackward * narrowing), kBackwardShare);
}
// Of each term, times its light. @param cosine of the angle by which light is turned.
vec4 term_phases(float cosine) {
  return kTermLight * vec4(cloud_phase(cosine, kTermLobe.x), cloud_phase(cosine, kTermLobe.y), cloud_phase(cosine, kTermLobe.z),
                             cloud_phase(cosine, kTermLobe.w));
}
float terms_left(vec4 phases, float depth) { return dot(phases, exp(-depth * kTermDepth)); }

// 1 - exp(-x), to the last digits for small x.
float opacity_of(float x) { return x < 0.02 ? x * (1.0 - x * (0.5 - x * (1.0 / 6.0))) : 1.0 - exp(-x); }
#endif
