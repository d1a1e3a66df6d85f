#version 460
#extension GL_GOOGLE_include_directive : require
// As classify_tiles.comp, for shading: tiles with surfaces (list 0) and with open pixels (1), and of the latter those in which a star or a disc may
// be seen (3, and then not in 1). Where radiance is kept beside the picture for water and glass, tiles that keep it are in lists of their own (4, 5,
// 6), since what is stored for no pixel takes lavapipe as long as what is stored for all; none keep it while no water or glass shows.
// Where that is asked for, tiles of smooth sky alone are in lists 7 and 8, not in 1 and 5; tiles with surfaces that
// lamps reach are in kLampTiles, or in the list after it; and of tiles with surfaces the squares of 4x4 pixels are
// listed: those of one plane of one block, and others with a surface.
// docs/decisions/0030-light-at-fewer-pixels.md, docs/decisions/0047-the-picture-as-it-is-shaded.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/sky.h"
#include "include/scene/coverage.glsl"
#include "include/scene/list_tiles.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kSkyBinding) uniform Sky { SkyConstants sky; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
#include "include/scene/gather_depths.glsl"
layout(scalar, binding = kLayerTilesBinding) readonly buffer Layers { TileDispatch layers[]; };

layout(constant_id = kTranslucentConstant) const bool kTranslucent = false;  // if not, something is bound in place of the layers
layout(constant_id = kStarsConstant) const bool kStars = false;              // whether they are looked for
layout(constant_id = kDiscsConstant) const bool kDiscs = false;
layout(constant_id = kSquaresConstant) const bool kSquares = false;
layout(constant_id = kSmoothSkyConstant) const bool kSmoothSky = false;

#include "include/sky/star_cells.glsl"
#include "include/light/lit_tiles.glsl"

const float kSmoothPixels = 10.0;  // from the horizon
const float kMostCells = 4.0;  // across a tile; where it covers more, some have stars

// Rays through a tile's outermost pixels.
struct Corners {
  vec3 a, b, c, d;
};

Corners corners_of(uvec2 low) {
  uvec2 high = low + (kTileEdge - 1u);
  return Corners(pixel_ray(low), pixel_ray(uvec2(high.x, low.y)), pixel_ray(uvec2(low.x, high.y)), pixel_ray(high));
}

vec3 in_sky(vec3 dir) { return vec3(dot(sky.sky_x, dir), dot(sky.sky_y, dir), dot(sky.sky_z, dir)); }

// No star is seen from below the horizon: see stars(), whose limit is at 0.05.
bool far_below(vec3 ray) { return ray.y < -0.06 * length(ray); }

// Whether a star's footprint may touch some pixel. Errs on the side of yes.
// @param pixel_angle the largest of a pixel [rad].
bool may_show_star(Corners at, float pixel_angle) {
  CubePlace a = cube_place(in_sky(at.a)), b = cube_place(in_sky(at.b)), c = cube_place(in_sky(at.c)), d = cube_place(in_sky(at.d));
  // On one face of the cube places between the corners' rays lie between the corners' places.
  bool one_face = a.side == b.side && a.side == c.side && a.side == d.side;
  float reach = star_radius(pixel_angle) * kMostCellsPerRadian;
  vec2 least = min(min(a.at, b.at), min(c.at, d.at)) - 1e-3, most = max(max(a.at, b.at), max(c.at, d.at)) + 1e-3;
  vec2 first = floor(least - 0.5), last = floor(most - 0.5) + 1.0;
  bool known = one_face && all(lessThan(last - first, vec2(kMostCells)));
  bool found = false;
  vec2 cell = first;
  while (known && !found && cell.y <= last.y) {
    CellStar star = star_in_cell(a.side, cell);
    found = star.here && all(greaterThan(star.place, least - reach)) && all(lessThan(star.place, most + reach));
    bool end_of_row = ++cell.x > last.x;
    cell = end_of_row ? vec2(first.x, cell.y + 1.0) : cell;
  }
  bool below = far_below(at.a) && far_below(at.b) && far_below(at.c) && far_below(at.d);
  return !known || (found && !below);
}

// Whether a tile may touch a disc, by chords in place of angles. Errs on the side of yes.
bool may_touch(Corners at, float pixel_angle, vec3 to_body) {
  vec3 middle = normalize(at.a + at.d);
  float half_tile = max(max(distance(middle, normalize(at.a)), distance(middle, normalize(at.b))),
                        max(distance(middle, normalize(at.c)), distance(middle, normalize(at.d))));
  return distance(middle, to_body) < 1.1 * (kDiscRadius + 1.5 * pixel_angle + half_tile);
}

// Whether all of a tile lies so far above the horizon, or below, that the sky hardly bends between a square's corners.
bool far_from_horizon(Corners at, float pixel_angle) {
  vec4 up = vec4(normalize(at.a).y, normalize(at.b).y, normalize(at.c).y, normalize(at.d).y) - sin(frame.sky_horizon);
  float margin = kSmoothPixels * pixel_angle;
  return all(greaterThan(up, vec4(margin))) || all(lessThan(up, vec4(-margin)));
}

// Reverse depth is affine in the picture on a plane: how far it may be off, of the change from one pixel to the next and of itself. Planes of blocks
// that lie one behind the other differ by more than a thousandth of it wherever single blocks can be told apart.
const float kOffPlane = 0.05, kOffDepth = 1e-5;

// What a square shows.
struct Square {
  bool covered, open;
  bool plain;  // one plane of one block
};

// Whether four pixels' depths, gathered from `at` on, lie on the plane. @param plane its depth at the square's corner, and what is added for a pixel
// beside and below.
bool all_on_plane(vec4 depth, vec2 at, vec3 plane) {
  vec4 there = plane.y * (at.x + vec4(0.0, 1.0, 1.0, 0.0)) + plane.z * (at.y + vec4(1.0, 1.0, 0.0, 0.0));
  return all(lessThanEqual(abs(depth - plane.x - there), kOffPlane * (abs(plane.y) + abs(plane.z)) + kOffDepth * depth));
}

Square square_at(uvec2 corner) {
  ivec2 low = ivec2(corner);
  vec4 d00 = depths_about(low, frame.size), d10 = depths_about(low + ivec2(2, 0), frame.size);
  vec4 d01 = depths_about(low + ivec2(0, 2), frame.size), d11 = depths_about(low + 2, frame.size);
  float least = min(min(least_of(d00), least_of(d10)), min(least_of(d01), least_of(d11)));
  float most = max(max(most_of(d00), most_of(d10)), max(most_of(d01), most_of(d11)));
  Square s = Square(most > 0.0, least <= 0.0, all(lessThanEqual(corner + kSquareEdge, frame.size)));
  if (!kSquares && !kDepth16) return s;
  if (kDepth16) s.covered = s.open = false;
  uint first = imageLoad(surfaces, ivec2(min(corner, frame.size - 1u))).r;
  for (uint i = 0u; i < kSquareEdge * kSquareEdge; ++i) {
    uint word = imageLoad(surfaces, ivec2(min(corner + uvec2(i % kSquareEdge, i / kSquareEdge), frame.size - 1u))).r;
    s.plain = s.plain && word == first;
    if (!kDepth16) continue;
    s.covered = s.covered || word != 0u;
    s.open = s.open || word == 0u;
  }
  vec3 plane = vec3(d00.w, d00.z - d00.w, d00.x - d00.w);
  bool on = all_on_plane(d00, vec2(0.0), plane) && all_on_plane(d10, vec2(2.0, 0.0), plane);
  on = on && all_on_plane(d01, vec2(0.0, 2.0), plane) && all_on_plane(d11, vec2(2.0), plane);
  s.plain = s.plain && on && !s.open && surface_face(first) < 6u;
  return s;
}

// Squares of a tile, a bit each.
void list_squares(const uint kind, bool keeps, uint squares, uvec2 tile, uvec2 count) {
  const uint across = kTileEdge / kSquareEdge, group = kind == kPlainSquares ? kPlainGroup : kMixedGroup / kSquareEdge;
  uint list = keeps ? kind + 1u : kind;
  uint more = uint(bitCount(squares)), slot = atomicAdd(dispatches[list].tiles, more), groups = (slot + more + group - 1u) / group;
  atomicMax(dispatches[list].groups_x, min(groups, kTileRow));
  atomicMax(dispatches[list].groups_y, (groups + kTileRow - 1u) / kTileRow);
  uint room = across * across * count.x * count.y, begin = kTileKinds * count.x * count.y + (keeps ? room : 0u), last = begin + room - 1u;
  for (uint left = squares; left != 0u; left &= left - 1u) {
    uint i = uint(findLSB(left));
    uvec2 at = tile * across + uvec2(i % across, i / across);
    tiles[kind == kPlainSquares ? begin + slot : last - slot] = at.x | (at.y << 16);
    ++slot;
  }
}

void main() {
  uvec2 count = (frame.size + (kTileEdge - 1u)) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  uvec2 at = uvec2(tile % count.x, tile / count.x), low = at * kTileEdge;
  const uint across = kTileEdge / kSquareEdge;
  bool covered = false, open = false;
  uint plain = 0u, mixed = 0u;
  for (uint i = 0u; i < across * across; ++i) {
    uvec2 corner = low + uvec2(i % across, i / across) * kSquareEdge;
    Square s = square_at(corner);
    covered = covered || s.covered;
    open = open || s.open;
    plain |= s.plain ? 1u << i : 0u;
    mixed |= s.covered && !s.plain && all(lessThan(corner, frame.size)) ? 1u << i : 0u;
  }
  bool keeps = kTranslucent && (layers[0].tiles != 0u || frame.camera_medium != 0u) && all(lessThan(low, frame.radiance_area.zw)) &&
               all(greaterThan(low + kTileEdge, frame.radiance_area.xy));
  bool detailed = false, smooth_sky = false;
  if (kStars || kDiscs || kSmoothSky) {
    Corners corners = corners_of(low);
    float pixel_angle = frame.pixel_to_ndc.y * length(frame.ray_up);
    if (kSmoothSky) smooth_sky = !covered && all(lessThanEqual(low + kTileEdge, frame.size)) && far_from_horizon(corners, pixel_angle);
    if (kStars) detailed = may_show_star(corners, pixel_angle);
    if (kDiscs) detailed = detailed || may_touch(corners, pixel_angle, sky.sun.to_body) || may_touch(corners, pixel_angle, sky.moon.to_body);
  }
  uint lit = keeps ? kLampTiles + 1u : kLampTiles, others = keeps ? 4u : 0u;
  if (covered) list_tile(lamps_reach(at, count) ? lit : others, at, count);
  if (kSquares && covered) {
    list_squares(kPlainSquares, keeps, plain, at, count);
    list_squares(kMixedSquares, keeps, mixed, at, count);
  }
  if (open && !detailed && !smooth_sky) list_tile(keeps ? 5u : 1u, at, count);
  if (open && !detailed && smooth_sky) list_tile_of(keeps ? kSmoothSkyTiles + 1u : kSmoothSkyTiles, at, count, kSmoothSkyGroup);
  if (open && detailed) list_tile(keeps ? 6u : 3u, at, count);
}
