// Stars fixed to the turning sky, and all that a ray into the open sees. Include after the blocks
// `frame`, `sky` and `sky_lut`.
#ifndef SKERRY_STARS_GLSL
#define SKERRY_STARS_GLSL
#include "include/sky/discs.glsl"
#include "include/sky/star_cells.glsl"

// Per pixel only the four nearest cells are looked at.
const float kStarFlux = 6.0e-7;      // of a star of magnitude 0 [radiance * sr]
const float kFaintestFlux = 2.5e-3;  // magnitude 6.5, over that of magnitude 0

// Colour of a star, unit luminance: from orange through white to blue-white.
vec3 star_colour(float t) {
  vec3 end = t < 0.5 ? vec3(1.50, 0.90, 0.46) : vec3(0.80, 0.97, 1.75);
  vec3 c = mix(vec3(1.0), end, abs(2.0 * t - 1.0));
  return c / dot(c, vec3(0.2126, 0.7152, 0.0722));
}

// Radiance of the star of one cell, if it has one, at the place `at` [cells] of a face. The star's
// footprint has the squared radius radius2 [rad2]; metric turns offsets [cells] to squared angles.
vec3 star_of_cell(uint face, vec2 cell, vec2 at, vec3 metric, float radius2) {
  CellStar star = star_in_cell(face, cell);
  vec2 d = at - star.place;
  float angle2 = metric.x * d.x * d.x + metric.y * d.x * d.y + metric.z * d.y * d.y;
  float w = max(0.0, 1.0 - angle2 / radius2);
  // Numbers of stars grow by a factor of 3.4 a magnitude: flux over the faintest is u^-0.75.
  float u = (float(star.look & 0xfffffu) + 128.0) * (1.0 / 1048576.0);
  float flux = kStarFlux * kFaintestFlux / sqrt(u * sqrt(u));
  float radiance = star.here ? flux * w * w * 3.0 / (kSkyPi * radius2) : 0.0;
  return star_colour(float(star.colour >> 24) * (1.0 / 255.0)) * radiance;
}

// Stars of direction d in the sky's frame. @param cells 4, or 0 to skip.
vec3 star_field(vec3 d, float pixel_angle, int cells) {
  CubePlace place = cube_place(d);
  vec2 uv = place.uv, at = place.at;
  vec2 per_cell = (2.0 / kStarCells) / (1.25 - 0.5 * abs(uv));
  float q = 1.0 / (1.0 + dot(uv, uv));
  vec3 metric = q * q * vec3((1.0 + uv.y * uv.y) * per_cell.x * per_cell.x,
                             -2.0 * uv.x * uv.y * per_cell.x * per_cell.y,
                             (1.0 + uv.x * uv.x) * per_cell.y * per_cell.y);
  float radius = star_radius(pixel_angle);
  vec2 first = floor(at - 0.5);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < cells; ++i) {
    vec2 cell = first + vec2(float(i & 1), float(i >> 1));
    sum += star_of_cell(place.side, cell, at, metric, radius * radius);
  }
  return sum;
}

// Radiance of the stars for a pixel of pixel_angle [rad]; 0 by day.
vec3 stars(vec3 dir, float pixel_angle) {
  float seen = sky.stars * smoothstep(-0.05, 0.20, dir.y);  // none from below the horizon
  // A loop of no rounds, not a branch: lavapipe runs both sides of a branch.
  int cells = seen > 0.0 ? 4 : 0;
  vec3 d = vec3(dot(sky.sky_x, dir), dot(sky.sky_y, dir), dot(sky.sky_z, dir));
  return star_field(d, pixel_angle, cells) * (seen * (1.0 - moon_hides(dir, pixel_angle)));
}

// Everything a ray into the open sees: sky, stars unless it is day, discs if they may be in the picture. dir is unit.
vec3 sky_seen(vec3 dir, bool with_stars, bool with_discs) {
  // A pixel's mean angle: off the axis it covers the cube of the cosine of the middle one's sky.
  float c = max(0.1, dot(dir, frame.ray_forward));
  float pixel_angle = frame.pixel_to_ndc.y * length(frame.ray_up) * c * sqrt(c);
  vec3 colour = sample_sky(sky_lut, dir, frame.sky_horizon, frame.sky_yaw);
  if (with_discs) colour += discs(dir, pixel_angle);
  if (with_stars) colour += stars(dir, pixel_angle);
  return colour;
}

#endif
