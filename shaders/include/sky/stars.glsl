// Stars fixed to the turning sky, and all that a ray into the open sees. Include after the blocks
// `frame`, `sky` and `sky_lut`.
#ifndef SKERRY_STARS_GLSL
#define SKERRY_STARS_GLSL
#include "include/sky/discs.glsl"

// The sphere is a cube of about equal cells (edge some 90 / kStarCells degrees), some of which hold
// a star. Per pixel only the four nearest cells are looked at.
const float kStarCells = 64.0;       // along a face's edge
const float kStarShare = 0.24;       // of the cells in the middle of a face; 4,500 stars in all
const float kStarFlux = 6.0e-7;      // of a star of magnitude 0 [radiance * sr]
const float kFaintestFlux = 2.5e-3;  // magnitude 6.5, over that of magnitude 0
// A footprint of at least this radius, about one pixel wide at half height, keeps stars from
// twinkling as they move.
const float kStarRadiusPixels = 1.6;

// Colour of a star, unit luminance: from orange through white to blue-white.
vec3 star_colour(float t) {
  vec3 end = t < 0.5 ? vec3(1.50, 0.90, 0.46) : vec3(0.80, 0.97, 1.75);
  vec3 c = mix(vec3(1.0), end, abs(2.0 * t - 1.0));
  return c / dot(c, vec3(0.2126, 0.7152, 0.0722));
}

// Radiance of the star of one cell, if it has one, at the place `at` [cells] of a face. The star's
// footprint has the squared radius radius2 [rad2]; metric turns offsets [cells] to squared angles.
vec3 star_of_cell(uint face, vec2 cell, vec2 at, vec3 metric, float radius2) {
  uint h = sky_hash(uvec3(face, uvec2(cell)));
  uint k = (h ^ (h >> 15)) * 747796405u;
  // Cells towards a cube's edges cover less sky and hold fewer stars: their solid angle, fitted.
  vec2 s = (cell + 0.5) * (2.0 / kStarCells) - 1.0;
  s *= s;
  float share = kStarShare * (1.0 - 0.411 * (s.x + s.y) + 0.356 * s.x * s.y);
  bool on_face = all(lessThan(abs(cell + 0.5 - 0.5 * kStarCells), vec2(0.5 * kStarCells)));
  bool here = on_face && float(h >> 20) < share * 4096.0;
  // Half a cell off the face's edge, beyond which the neighbours are not looked at.
  vec2 star = cell + vec2(uvec2(k, k >> 12) & 0xfffu) * (1.0 / 4096.0);
  vec2 d = at - clamp(star, 0.5, kStarCells - 0.5);
  float angle2 = metric.x * d.x * d.x + metric.y * d.x * d.y + metric.z * d.y * d.y;
  float w = max(0.0, 1.0 - angle2 / radius2);
  // Numbers of stars grow by a factor of 3.4 a magnitude: flux over the faintest is u^-0.75.
  float u = (float(h & 0xfffffu) + 128.0) * (1.0 / 1048576.0);
  float flux = kStarFlux * kFaintestFlux / sqrt(u * sqrt(u));
  float radiance = here ? flux * w * w * 3.0 / (kSkyPi * radius2) : 0.0;
  return star_colour(float(k >> 24) * (1.0 / 255.0)) * radiance;
}

// Stars of direction d in the sky's frame. @param cells 4, or 0 to skip.
vec3 star_field(vec3 d, float pixel_angle, int cells) {
  vec3 m = abs(d);
  int axis = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
  vec3 face = axis == 0 ? d : axis == 1 ? d.yzx : d.zxy;
  vec2 uv = face.yz / abs(face.x);
  // Cells are even in u (1.25 - 0.25 |u|), which is near enough to equal angles and cheap.
  vec2 at = (uv * (1.25 - 0.25 * abs(uv)) + 1.0) * (0.5 * kStarCells);
  vec2 per_cell = (2.0 / kStarCells) / (1.25 - 0.5 * abs(uv));
  float q = 1.0 / (1.0 + dot(uv, uv));
  vec3 metric = q * q * vec3((1.0 + uv.y * uv.y) * per_cell.x * per_cell.x,
                             -2.0 * uv.x * uv.y * per_cell.x * per_cell.y,
                             (1.0 + uv.x * uv.x) * per_cell.y * per_cell.y);
  // The four nearest cells reach half a cell, which is 0.37 of a middle one at its narrowest.
  float radius = min(kStarRadiusPixels * pixel_angle, 0.37 * 2.0 / (1.25 * kStarCells));
  uint side = uint(axis) * 2u + (face.x < 0.0 ? 1u : 0u);
  vec2 first = floor(at - 0.5);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < cells; ++i) {
    vec2 cell = first + vec2(float(i & 1), float(i >> 1));
    sum += star_of_cell(side, cell, at, metric, radius * radius);
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
