// Stars fixed to the turning sky, and all that a ray into the open sees. Include after the blocks
// `frame`, `sky` and `sky_lut`.
#ifndef SKERRY_STARS_GLSL
#define SKERRY_STARS_GLSL
#include "include/sky.glsl"

// The sphere is a cube of equal-angle cells (edge 90 / kStarCells degrees), some of which hold a
// star.
const float kStarCells = 64.0;
const float kStarShare = 0.22;    // of the cells in the middle of a face; some 4,500 stars in all
const float kStarFlux = 6.0e-7;   // of a star of magnitude 0 [radiance * sr]
const float kFaintestStar = 6.5;  // magnitude
const float kStarRadiusPixels = 1.6;  // a footprint of at least this radius (about one pixel at
                                      // half height) keeps stars from twinkling as they move
const float kMilkyWay = 3.0e-4;       // radiance in its middle

float unit_float(uint h) {
  return float(h >> 8) * (1.0 / 16777216.0);
}

// Colour of a star, unit luminance: from orange through white to blue-white.
vec3 star_colour(float t) {
  vec3 c = t < 0.5 ? mix(vec3(1.55, 0.90, 0.45), vec3(1.0), 2.0 * t)
                   : mix(vec3(1.0), vec3(0.80, 0.97, 1.75), 2.0 * t - 1.0);
  return c / dot(c, vec3(0.2126, 0.7152, 0.0722));
}

vec3 cube_dir(int axis, float s, vec2 uv) {
  vec3 d = vec3(s, uv);
  return axis == 0 ? d : axis == 1 ? d.zxy : d.yzx;
}

// Radiance of the star of one cell, if it has one, seen in direction d of the sky frame.
vec3 star_of_cell(vec3 d, int axis, float s, vec2 cell, float radius) {
  vec3 colour = vec3(0.0);
  uint h = sky_hash(uvec3(uint(axis) * 2u + (s > 0.0 ? 1u : 0u), uvec2(cell)));
  // Cells towards a cube's corner cover less sky and hold fewer stars.
  vec2 middle = tan((cell + 0.5) * (0.5 * kSkyPi / kStarCells) - 0.25 * kSkyPi);
  vec2 stretch = 1.0 + middle * middle;
  float share = kStarShare * stretch.x * stretch.y * pow(1.0 + dot(middle, middle), -1.5);
  bool inside = all(greaterThanEqual(cell, vec2(0.0))) && all(lessThan(cell, vec2(kStarCells)));
  for (int once = inside && unit_float(h) < share ? 1 : 0; once > 0; --once) {
    uint a = sky_hash(uvec3(h, 1u, 2u)), b = sky_hash(uvec3(h, 3u, 4u)),
         c = sky_hash(uvec3(h, 5u, 6u));
    // Half a cell off the face's edge, beyond which the neighbours are not looked at.
    vec2 at = clamp(cell + vec2(unit_float(a), unit_float(b)), 0.5, kStarCells - 0.5);
    vec3 star = normalize(cube_dir(axis, s, tan(at * (0.5 * kSkyPi / kStarCells) - 0.25 * kSkyPi)));
    // Numbers of stars grow as 10^(0.5 m): u spread evenly gives m = faintest + 2 log10(u), and flux
    // goes as 10^(-0.4 m).
    float u = max(unit_float(c), 2e-4);
    float flux = kStarFlux * exp2(-0.4 * kFaintestStar * 3.32192809) * pow(u, -0.8);
    vec3 apart = d - star;
    float w = max(0.0, 1.0 - dot(apart, apart) / (radius * radius));
    colour = star_colour(unit_float(sky_hash(uvec3(h, 7u, 8u)))) *
             (flux * w * w * 3.0 / (kSkyPi * radius * radius));
  }
  return colour;
}

vec3 star_field(vec3 d, float pixel_angle) {
  vec3 m = abs(d);
  int axis = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
  vec3 face = axis == 0 ? d : axis == 1 ? d.yzx : d.zxy;
  float s = face.x < 0.0 ? -1.0 : 1.0;
  vec2 at = (atan(face.yz / abs(face.x)) * (4.0 / kSkyPi) + 1.0) * (0.5 * kStarCells);
  // Half a cell is the farthest that the four nearest cells can reach; cells narrow to 0.7 of their
  // width off the middle of a face.
  float radius = min(kStarRadiusPixels * pixel_angle, 0.34 * 0.5 * kSkyPi / kStarCells);
  vec2 first = floor(at - 0.5);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i)
    sum += star_of_cell(d, axis, s, first + vec2(float(i & 1), float(i >> 1)), radius);
  return sum;
}

vec3 milky_way(vec3 d) {
  vec3 colour = vec3(0.0);
  float lat = dot(d, vec3(0.200, 0.871, 0.449));
  for (int once = abs(lat) < 0.5 ? 1 : 0; once > 0; --once) {
    float cloud = 0.6 * sky_noise(d * 5.0 + 20.0) + 0.4 * sky_noise(d * 13.0 + 40.0);
    float dust = sky_noise(d * 9.0 + 60.0);
    float band = exp(-lat * lat * 28.0) * (0.35 + 1.1 * cloud) *
                 (1.0 - 0.55 * exp(-lat * lat * 260.0) * dust);
    colour = vec3(0.92, 0.97, 1.15) * (kMilkyWay * band * smoothstep(0.5, 0.35, abs(lat)));
  }
  return colour;
}

// Radiance of the stars for a pixel of pixel_angle [rad]; 0 by day.
vec3 stars(vec3 dir, SkyConstants sky, float pixel_angle) {
  vec3 colour = vec3(0.0);
  float seen = sky.stars * smoothstep(-0.05, 0.20, dir.y);
  for (int once = seen > 0.0 ? 1 : 0; once > 0; --once) {
    vec3 d = vec3(dot(sky.sky_x, dir), dot(sky.sky_y, dir), dot(sky.sky_z, dir));
    colour = (star_field(d, pixel_angle) + milky_way(d)) *
             (seen * (1.0 - moon_cover(dir, sky, pixel_angle)));
  }
  return colour;
}

// Everything a ray into the open sees: sky, discs, and stars unless it is day. dir is unit.
vec3 sky_seen(vec3 dir, bool with_stars) {
  float pixel_angle = frame.pixel_to_ndc.y * length(frame.ray_up);
  vec3 colour = sample_sky(sky_lut, dir) + discs(dir, sky, pixel_angle);
  if (with_stars) colour += stars(dir, sky, pixel_angle);
  return colour;
}

#endif
