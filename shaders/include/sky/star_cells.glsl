// Where stars stand: on a sphere that is a cube of about equal cells (edge some 90 / kStarCells degrees), some of which hold one.
#ifndef SKERRY_STAR_CELLS_GLSL
#define SKERRY_STAR_CELLS_GLSL
#include "include/sky/sky.glsl"

const float kStarCells = 64.0;  // along a face's edge
const float kStarShare = 0.24;  // of the cells in the middle of a face; 4,500 stars in all
// A footprint of at least this radius, about one pixel wide at half height, keeps stars from
// twinkling as they move.
const float kStarRadiusPixels = 1.6;
const float kMostCellsPerRadian = 60.0;  // across a cell: 58.8 at the cube's corners, 40 in the middle of a face

// Radius of a star's footprint [rad]. The four nearest cells reach half a cell, which is 0.37 of a middle one at its narrowest.
float star_radius(float pixel_angle) { return min(kStarRadiusPixels * pixel_angle, 0.37 * 2.0 / (1.25 * kStarCells)); }

// A direction on the cube.
struct CubePlace {
  uint side;
  vec2 uv;      // on the face, -1..1
  vec2 at;      // [cells]
};

// @param d in the sky's frame, of any length.
CubePlace cube_place(vec3 d) {
  vec3 m = abs(d);
  int axis = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
  vec3 face = axis == 0 ? d : axis == 1 ? d.yzx : d.zxy;
  vec2 uv = face.yz / abs(face.x);
  // Cells are even in u (1.25 - 0.25 |u|), which is near enough to equal angles and cheap.
  return CubePlace(uint(axis) * 2u + (face.x < 0.0 ? 1u : 0u), uv, (uv * (1.25 - 0.25 * abs(uv)) + 1.0) * (0.5 * kStarCells));
}

// What a cell holds.
struct CellStar {
  bool here;
  vec2 place;  // [cells], half a cell off the face's edge, beyond which the neighbours are not looked at
  uint look;   // bits that flux and colour are chosen by
  uint colour;
};

CellStar star_in_cell(uint face, vec2 cell) {
  uint h = sky_hash(uvec3(face, uvec2(cell)));
  uint k = (h ^ (h >> 15)) * 747796405u;
  // Cells towards a cube's edges cover less sky and hold fewer stars: their solid angle, fitted.
  vec2 s = (cell + 0.5) * (2.0 / kStarCells) - 1.0;
  s *= s;
  float share = kStarShare * (1.0 - 0.411 * (s.x + s.y) + 0.356 * s.x * s.y);
  bool on_face = all(lessThan(abs(cell + 0.5 - 0.5 * kStarCells), vec2(0.5 * kStarCells)));
  bool here = on_face && float(h >> 20) < share * 4096.0;
  vec2 star = cell + vec2(uvec2(k, k >> 12) & 0xfffu) * (1.0 / 4096.0);
  return CellStar(here, clamp(star, 0.5, kStarCells - 0.5), h, k);
}
#endif
