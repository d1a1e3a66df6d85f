// How a surface reflects light: the one model of deferred and translucent shading. Cook-Torrance: GGX (Walter et al. 2007, alpha =
// roughness^2), Smith's shadowing as Schlick fits it (k = alpha / 2), Schlick's Fresnel term; and a diffuse part that gets what the lobe leaves.
// Twin, written on its own: tools/reference/brdf.cpp.
#ifndef SKERRY_BRDF_GLSL
#define SKERRY_BRDF_GLSL

const float kInvPi = 0.31830988618;
const float kLeastRoughness = 0.06;  // a point light's image in a smoother surface would be smaller than a pixel
const float kDielectric = 0.04;      // reflectance of what is not metal, from above

float fifth(float x) {
  float x2 = x * x;
  return x2 * x2 * x;
}

// The Cook-Torrance lobe without its Fresnel factor: D G / (4 (n.l) (n.v)). @param half_way unit. Cosines are not negative.
float mirror_lobe(float alpha, vec3 normal, vec3 half_way, float n_dot_l, float n_dot_v) {
  // Next to the mirror direction 1 - cos^2 has no digits left, the sine has.
  float n_dot_h = max(dot(normal, half_way), 0.0), alpha2 = alpha * alpha, k = 0.5 * alpha;
  vec3 across = cross(normal, half_way);
  float spread = n_dot_h * n_dot_h * alpha2 + dot(across, across);
  float shadowing = (n_dot_l * (1.0 - k) + k) * (n_dot_v * (1.0 - k) + k);
  return (0.25 * kInvPi) * alpha2 / (spread * spread * shadowing);
}

// A surface's reflectance for one eye.
struct Brdf {
  vec3 diffuse;     // of the half of it that depends on the eye
  vec3 mirror;      // reflectance from above; 0: there is no lobe
  float taken;      // what the lobe takes of light from above, and how much more of grazing light:
  float taken_more; // by Schlick's curve, so that diffuse and lobe together never exceed 1 (tests/render/light/light_formulas_test.cpp)
  float alpha;
  float n_dot_v;
};

// A matt surface: what plants are, whose planes stand for loose leaves, and everything with shading=flat.
Brdf matt_brdf(vec3 albedo) { return Brdf(albedo * kInvPi, vec3(0.0), 0.0, 0.0, 1.0, 1.0); }

// @param roughness perceptual, @param metalness 0..1. @param n_dot_v cosine to the eye.
Brdf brdf_of(vec3 albedo, float roughness, float metalness, float n_dot_v) {
  Brdf b;
  roughness = clamp(roughness, kLeastRoughness, 1.0);
  b.alpha = roughness * roughness;
  b.n_dot_v = clamp(n_dot_v, 1e-3, 1.0);
  // The rougher, the less of grazing light the lobe sends out: its own facets hide it.
  float smooth_part = 1.0 - b.alpha;
  smooth_part *= smooth_part;
  b.taken = kDielectric;
  b.taken_more = (1.0 - kDielectric) * smooth_part * smooth_part * smooth_part;
  b.diffuse = albedo * ((1.0 - metalness) * kInvPi * (1.0 - b.taken - b.taken_more * fifth(1.0 - b.n_dot_v)));
  b.mirror = mix(vec3(kDielectric), albedo, metalness);
  return b;
}

vec3 brdf_diffuse(Brdf b, float n_dot_l) { return b.diffuse * (1.0 - b.taken - b.taken_more * fifth(1.0 - n_dot_l)); }

// @param n_dot_l not negative.
vec3 brdf_mirror(Brdf b, vec3 normal, vec3 to_eye, vec3 to_light, float n_dot_l) {
  vec3 sum = to_light + to_eye;
  vec3 h = sum * inversesqrt(max(dot(sum, sum), 1e-12));
  vec3 f = b.mirror + (1.0 - b.mirror) * fifth(1.0 - clamp(dot(h, to_eye), 0.0, 1.0));
  float lobe = mirror_lobe(b.alpha, normal, h, n_dot_l, b.n_dot_v);
  return b.mirror == vec3(0.0) ? vec3(0.0) : f * lobe;
}

// Share of the irradiance of even light from all sides that goes to the eye [1/sr]: brdf() averaged over the half space by the cosine. Of the
// lobe a fit, right to .1 of its mirror and, of what is rougher than .5, to .04 beyond it.
vec3 brdf_around(Brdf b) {
  float grazing = fifth(1.0 - b.n_dot_v), smoothness = 1.0 - sqrt(b.alpha);
  float above = 0.564 + 0.038 * b.alpha + b.n_dot_v * (0.531 - 0.908 * b.alpha);
  float beyond = smoothness * smoothness * grazing * (1.33 - 0.74 * grazing);
  vec3 lobe = b.mirror == vec3(0.0) ? vec3(0.0) : kInvPi * (b.mirror * above + beyond);
  return b.diffuse * (1.0 - b.taken - b.taken_more * (1.0 / 21.0)) + lobe;
}

// Share of a directional light's irradiance that goes to the eye [1/sr]. @param n_dot_l cosine to the light, not negative.
vec3 brdf(Brdf b, vec3 normal, vec3 to_eye, vec3 to_light, float n_dot_l) {
  return brdf_diffuse(b, n_dot_l) + brdf_mirror(b, normal, to_eye, to_light, n_dot_l);
}
#endif
