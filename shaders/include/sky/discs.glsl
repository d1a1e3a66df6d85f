// The discs of sun and moon. Include after the block `sky`: a function that took the whole
// SkyConstants would load all of it for every pixel.
#ifndef SKERRY_DISCS_GLSL
#define SKERRY_DISCS_GLSL
#include "include/sky/sky.glsl"

// Where dir meets a disc with these axes: x across, y towards the celestial pole, in disc radii; z
// the depth of the near half of its sphere, 0 at the limb.
vec3 disc_place(vec3 dir, vec3 right, vec3 up) {
  vec2 p = vec2(dot(dir, right), dot(dir, up));
  return vec3(p, sqrt(max(0.0, 1.0 - dot(p, p))));
}

// Share of a pixel that the disc at disc_place p fills.
float disc_cover(vec3 p, float pixel_angle) {
  return clamp((1.0 - length(p.xy)) * (kDiscRadius / pixel_angle) + 0.5, 0.0, 1.0);
}

// A dark plain of the moon about `centre`, 0..1.
float mare(vec2 p, vec2 centre, float radius) {
  vec2 d = (p - centre) / radius;
  float w = max(0.0, 1.0 - dot(d, d));
  return w * (2.0 - w);
}

// Radiance of the moon's disc at p: ground lit from the sun's direction (Lommel and Seeliger,
// without limb darkening when full), with maria about where the real ones are.
vec3 moon_disc(vec3 p) {
  float lit = max(0.0, dot(p, sky.moon_lit));
  vec2 q = p.xy;
  float dark = mare(q, vec2(-0.22, 0.52), 0.36) + mare(q, vec2(0.22, 0.45), 0.26) +
               mare(q, vec2(0.40, 0.16), 0.28) + mare(q, vec2(-0.55, 0.10), 0.42) +
               mare(q, vec2(-0.20, -0.32), 0.30) + mare(q, vec2(0.66, 0.30), 0.15) +
               mare(q, vec2(0.58, -0.08), 0.22);
  float ground = 1.0 - 0.52 * min(1.0, dark) + 0.12 * mare(q, vec2(-0.10, -0.68), 0.12);
  return sky.moon_disc * (ground * 2.0 * lit / max(lit + p.z, 1e-3));
}

// Radiance of both discs in front of the sky, for a pixel of pixel_angle [rad].
vec3 discs(vec3 dir, float pixel_angle) {
  float near = cos(kDiscRadius + pixel_angle);
  vec3 sun = disc_place(dir, sky.sun_right, sky.sun_up);
  vec3 moon = disc_place(dir, sky.moon_right, sky.moon_up);
  float sun_cover = dot(dir, sky.sun.to_body) > near ? disc_cover(sun, pixel_angle) : 0.0;
  float moon_cover = dot(dir, sky.moon.to_body) > near ? disc_cover(moon, pixel_angle) : 0.0;
  vec3 limb = 1.0 - vec3(kLimbRed, kLimbGreen, kLimbBlue) * (1.0 - sun.z);
  // The mist hides what has set.
  float risen = clamp((dir.y - sky.horizon_sine) * kHorizonSharpness + 0.5, 0.0, 1.0);
  return (sky.sun_disc * limb * sun_cover + moon_disc(moon) * moon_cover) * risen;
}

// Share of the pixel behind which the moon hides the stars, lit or not.
float moon_hides(vec3 dir, float pixel_angle) {
  vec3 p = disc_place(dir, sky.moon_right, sky.moon_up);
  return dot(dir, sky.moon.to_body) > 0.0 ? disc_cover(p, pixel_angle) : 0.0;
}

#endif
