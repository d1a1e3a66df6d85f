// From exposed scene radiance to the picture. docs/conventions.md.
#ifndef SKERRY_TONEMAP_GLSL
#define SKERRY_TONEMAP_GLSL

// ACES, the fit of reference and output transforms by S. Hill (BakingLab), with its matrices from
// and to linear Rec. 709. The fit's constant term of -0.00009 is left out, so that 0 gives 0,
// darkness is not crushed, and the curve never falls. Result 0..1, linear.
vec3 tone_map(vec3 exposed) {
  vec3 v = vec3(dot(exposed, vec3(0.59719, 0.35458, 0.04823)),
                dot(exposed, vec3(0.07600, 0.90834, 0.01566)),
                dot(exposed, vec3(0.02840, 0.13383, 0.83777)));
  v = min(v, 1e6);  // beyond, the quotient of squares would overflow
  v = v * (v + 0.0245786) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  vec3 c =
      vec3(dot(v, vec3(1.60475, -0.53108, -0.07367)), dot(v, vec3(-0.10208, 1.10813, -0.00605)),
           dot(v, vec3(-0.00327, -0.07276, 1.07602)));
  return clamp(c, 0.0, 1.0);
}

// IEC 61966-2-1, exactly.
vec3 srgb_encode(vec3 linear) {
  vec3 curve = 1.055 * pow(max(linear, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

// Spreads the rounding to 8 bits over neighbouring pixels, so that dark gradients do not band:
// interleaved gradient noise (Jimenez 2014), half a step either way. 0 stays exactly 0.
vec3 dithered(vec3 encoded, uvec2 pixel) {
  float noise = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
  return mix(clamp(encoded + (noise - 0.5) / 255.0, 0.0, 1.0), vec3(0.0),
             equal(encoded, vec3(0.0)));
}

#endif
