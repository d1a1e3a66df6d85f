// One moment, for the sky's shaders. Filled by engine/render/sky/sky_model.h.
#ifndef SKERRY_SHARED_SKY_H
#define SKERRY_SHARED_SKY_H
#include "types.h"
SHARED_BEGIN

// Sky-view table: u is the azimuth from +z towards +x, v the elevation with a square root about the
// true horizon, which lies below 0 for an eye above the mist. The outermost texel centres lie on
// the seam and on the two poles, so that clamped sampling needs no wrapping.
SHARED_CONST uint kSkyLutWidth = 192u;
SHARED_CONST uint kSkyLutHeight = 108u;
SHARED_CONST uint kSkyAzimuths = 13u;  // of half a turn from a body, in what it has scattered
SHARED_CONST uint kSkyLutGroup = 8u;   // edge of a workgroup of bake_sky.comp

// The discs are drawn this much larger than the real 0.53 degrees: a game's wide field of view
// makes them look tiny.
SHARED_CONST float kDiscEnlargement = 3.0f;
SHARED_CONST float kDiscRadius = 3.0f * 0.004625f;  // [rad]

// The mist hides discs below the horizon over this many radians, inverted: about a pixel.
SHARED_CONST float kHorizonSharpness = 400.0f;

SHARED_CONST float kAerosolAsymmetry = 0.8f;  // of its phase function

// Limb darkening of the sun, linear law 1 - u (1 - mu), u at about 700, 550 and 440 nm.
SHARED_CONST float kLimbRed = 0.45f;
SHARED_CONST float kLimbGreen = 0.56f;
SHARED_CONST float kLimbBlue = 0.72f;

// What the air scatters along a direction, of a body of irradiance 1.
struct SkyScatter {
  vec3 rayleigh;  // once, by molecules, over their phase function
  vec3 mie;       // once, by aerosol, likewise
  vec3 multiple;  // more than once, and by the ground: radiance
};

struct SkyBody {
  vec3 to_body;  // unit
  vec3 light;    // irradiance at the top of the air, linear RGB
};

struct SkyConstants {
  SkyBody sun;
  SkyBody moon;
  vec3 sun_disc;   // radiance in the middle of the disc
  vec3 moon_disc;  // radiance of its fully lit ground
  vec3 sun_right;  // across the disc and towards the celestial pole, over the sine of kDiscRadius
  vec3 sun_up;
  vec3 moon_right;
  vec3 moon_up;
  vec3 moon_lit;  // towards the sun in the moon's frame: right, up, towards the eye
  vec3 sky_x;     // rows of sky_from_world: the frame in which the stars stand still
  vec3 sky_y;
  vec3 sky_z;
  float height_km;  // of the eye above the mist
  float horizon;    // elevation of the true horizon [rad], not positive
  float horizon_sine;
  float stars;  // 0 by day .. 1 in a dark night
};

SHARED_END
#endif
