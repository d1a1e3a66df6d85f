// From exposed scene radiance to the picture. docs/conventions.md.
#ifndef SKERRY_TONEMAP_GLSL
#define SKERRY_TONEMAP_GLSL
#include "shared/constants.h"

layout(constant_id = kToneConstant) const uint kTone = 0u;  // render::ToneCurve

// ACES, the fit of reference and output transforms by S. Hill (BakingLab), with its matrices from
// and to linear Rec. 709. The fit's constant term of -0.00009 is left out, so that 0 gives 0,
// darkness is not crushed, and the curve never falls. Result 0..1, linear.
vec3 aces_fit(vec3 exposed) {
  vec3 v = vec3(dot(exposed, vec3(0.59719, 0.35458, 0.04823)),
                dot(exposed, vec3(0.07600, 0.90834, 0.01566)),
                dot(exposed, vec3(0.02840, 0.13383, 0.83777)));
  v = v * (v + 0.0245786) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  vec3 c =
      vec3(dot(v, vec3(1.60475, -0.53108, -0.07367)), dot(v, vec3(-0.10208, 1.10813, -0.00605)),
           dot(v, vec3(-0.00327, -0.07276, 1.07602)));
  return clamp(c, 0.0, 1.0);
}

// The fit takes an eighth of the light of sunlit ground, its shade at noon, for a twenty-fourth: black beside it. So light whose brightest
// channel, b, is dark is raised before it, three times at 0, twice at kDark and hardly at b = 0.3; 0 stays 0, and ratios stay.
// The fit sends all that is far brighter than white to white, flames and crystals at night without any shape. So b
// is drawn together beyond kBright: b becomes kBright + 10.5 u, which begins with slope 1, still rises after ten stops and ends at 12; and of
// the result 0.75 w takes the ratios of the channels that the light has. Between the two nothing changes, and luminance never falls as light
// rises. Result 0..1, linear. docs/exposure.md has the formula.
vec3 aces(vec3 exposed) {
  const float kBright = 1.5, kDark = 0.05;
  vec3 e = min(exposed, 1e9);
  float b = max(max(e.r, e.g), e.b);
  float dark = b / kDark, lift = 1.0 + 2.0 / (1.0 + dark * dark);
  e *= lift;
  b *= lift;
  float y = max(b / kBright - 1.0, 0.0), p = y + 2.88, q = y + 150.0, r = y + 0.4;
  float pq = p * q, rb = r * b, share = 1.0 / (pq * rb);  // one division for all
  float u = y * (0.4 * q + 0.6 * p) * rb * share, w = y * pq * b * share;
  vec3 ratios = e * (pq * r * share);
  bool bright = b > kBright;
  vec3 c = aces_fit(bright ? ratios * (kBright + 10.5 * u) : e);
  return bright ? mix(c, ratios * max(max(c.r, c.g), c.b), 0.75 * w) : c;
}

// AgX (T. Sobotka, 2022): primaries drawn together, log2 over 16.5 stops about middle grey, a sigmoid with its pivot at grey, slope 2 and
// powers of 3 in the toe and 3.25 in the shoulder, and back. Matrices as B. Wrensch publishes them for linear Rec. 709 (Minimal AgX
// Implementation, 2023); the sigmoid is Sobotka's own, which ends at 0 and 1. 0.6: ACES renders middle grey as if exposed to that share, and
// one exposure is to suit both curves. Result 0..1, linear.
vec3 agx(vec3 exposed) {
  vec3 e = min(exposed * 0.6, 1e9);
  vec3 v = vec3(dot(e, vec3(0.842479062253094, 0.0784335999999992, 0.0792237451477643)),
                dot(e, vec3(0.0423282422610123, 0.878468636469772, 0.0791661274605434)),
                dot(e, vec3(0.0423756549057051, 0.0784336, 0.879142973793104)));
  vec3 x = clamp((log2(max(v, 1e-9)) + 12.47393) / 16.5, 0.0, 1.0);
  vec3 d = 2.0 * (x - 20.0 / 33.0), far = abs(d);
  // 1 / scale^power = 1 / height^power - 1 / (slope * width)^power, of the part below the pivot and of the one above.
  vec3 toe = d * pow(1.0 + 7.438484375 * far * far * far, vec3(-1.0 / 3.0));
  vec3 shoulder = d * pow(1.0 + 7.343421118 * pow(far, vec3(3.25)), vec3(-1.0 / 3.25));
  // What is darker than the lowest stop is black without a rounding's rest.
  vec3 y = mix(mix(shoulder, toe, lessThan(d, vec3(0.0))) + 0.5, vec3(0.0), equal(x, vec3(0.0)));
  vec3 c = vec3(dot(y, vec3(1.19687900512017, -0.0980208811401368, -0.0990297440797205)),
                dot(y, vec3(-0.0528968517574562, 1.15190312990417, -0.0989611768448433)),
                dot(y, vec3(-0.0529716355144438, -0.0980434501171241, 1.15107367264116)));
  return pow(clamp(c, 0.0, 1.0), vec3(2.2));
}

vec3 tone_map(vec3 exposed) { return kTone == 1u ? agx(exposed) : aces(exposed); }

// IEC 61966-2-1, exactly.
vec3 srgb_encode(vec3 linear) {
  vec3 curve = 1.055 * pow(max(linear, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
  return mix(curve, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

// Fits an encoded colour to a display: the brightest is `peak`, and what is darker than a few hundredths is drawn towards `black`, the
// darkest level that its viewer can tell from black. Rises all the way, from exactly 0 to exactly `peak`.
vec3 displayed(vec3 encoded, float peak, float black) {
  const float kDark = 1.0 / 64.0;
  return peak * ((1.0 - black) * encoded + black * (1.0 + kDark) * encoded / (encoded + kDark));
}

// Spreads the rounding to 8 bits over neighbouring pixels, so that dark gradients do not band:
// interleaved gradient noise (Jimenez 2014), half a step either way. 0 stays exactly 0.
vec3 dithered(vec3 encoded, uvec2 pixel) {
  float noise = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
  return mix(clamp(encoded + (noise - 0.5) / 255.0, 0.0, 1.0), vec3(0.0),
             equal(encoded, vec3(0.0)));
}

#endif
