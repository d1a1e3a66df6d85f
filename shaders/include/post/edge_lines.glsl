// Lines at which surfaces end in the picture, and the shares of a pixel on their sides. Everything is relative to one pixel's centre, in pixels.
// Needs before the include: common.glsl, `frame`, `island_at()`, `block_textures` (their coverage). Components are chosen, not indexed,
// and no arrays are used: lavapipe keeps what is indexed in memory.
#ifndef SKERRY_EDGE_LINES_GLSL
#define SKERRY_EDGE_LINES_GLSL
#include "include/scene/coverage.glsl"
#include "include/scene/face_layer.glsl"

// A value that is linear in the picture: at the pixel's centre, and its slopes to the right and down.
#define Linear vec3
float at(Linear value, vec2 place) { return value.x + dot(value.yz, place); }

// The pixel's middle, seen from the place that is sampled, which is what is meant by its centre elsewhere here.
#define kCentre (0.5 - frame.sample_in_pixel)

// One axis of a lattice, as the pixel sees it: x the eye, y the ray through the pixel's centre, z and w what is added to it a pixel to the right and
// down. What is seen at inverse distance i lies at x + y / i.
#define Axis vec4

// Of an island.
struct Sight {
  Axis x, y, z;
};

Axis axis_of(vec3 axis, vec3 translation, vec3 ray) {
  return vec4(-dot(axis, translation), dot(axis, ray), dot(axis, frame.ray_right) * frame.pixel_to_ndc.x, -dot(axis, frame.ray_up) * frame.pixel_to_ndc.y);
}

Sight sight_in(uint island, vec3 ray) {
  IslandTransform t = island_at(island);
  return Sight(axis_of(t.axis_x, t.translation, ray), axis_of(t.axis_y, t.translation, ray), axis_of(t.axis_z, t.translation, ray));
}

// The plane of the surface that a pixel shows, continued over its surroundings. Where it is seen its inverse distance is linear in the picture.
struct SeenFace {
  uint word;       // 0: the sky, at inverse distance 0
  Linear inverse;  // 1 / (blocks along the view axis)
  Axis u, v;       // in the face, as its texture's coordinates
};

// @param depth, word of the pixel that is `offset` from the one that is worked on. @param here whether it is of the island that is seen; else its
// plane is taken to face the eye.
SeenFace face_at(vec2 offset, float depth, uint word, Sight sight, bool here) {
  uint face = surface_face(word);
  bool of_x = face < 2u, of_y = (face >> 1) == 1u;
  Axis normal = of_x ? sight.x : of_y ? sight.y : sight.z;
  normal = face < kFaceCount ? normal : face == 6u ? sight.x - sight.z : sight.x + sight.z;
  float distance = view_distance(max(depth, 1e-30), frame.near_plane);
  float hit = normal.x + (normal.y + offset.x * normal.z + offset.y * normal.w) * distance;
  // Planes lie at whole numbers of the lattice, which depth alone gives less exactly.
  float height = round(hit) - normal.x;
  Linear inverse = normal.yzw / (abs(height) < 1e-6 ? 1e-6 : height);
  if (!here) inverse = vec3(depth / frame.near_plane, 0.0, 0.0);
  return SeenFace(word, inverse, of_x ? sight.z : sight.x, of_y ? sight.z : sight.y);
}

// Share of the pixel's square in which a linear value is positive: the second integral of a step along both slopes.
float positive_share(Linear value) {
  vec2 slope = abs(value.yz);
  slope = max(slope, vec2(1e-4 * max(slope.x, slope.y) + 1e-20));
  float scale = 1.0 / max(slope.x, slope.y), d = at(value, kCentre) * scale;
  slope *= scale;
  float wide = 0.5 * (slope.x + slope.y), narrow = 0.5 * abs(slope.x - slope.y);
  vec4 r = max(vec4(d + wide, d + narrow, d - narrow, d - wide), vec4(0.0));
  r *= r;
  return clamp((r.x - r.y - r.z + r.w) / (2.0 * slope.x * slope.y), 0.0, 1.0);
}

// Where one of a face's coordinates comes to the border of the cell that it is in at `from`, on the way to `to`.
struct Crossing {
  Linear line;          // 0 there, positive beyond
  float before, after;  // how far the ways' ends lie from it, each positive on its side
};

// @param within a place in the cell. @param distances from the eye to the plane, there and at `to`.
Crossing crossing_of(Axis axis, Linear inverse, vec2 from, vec2 to, vec2 within, vec2 distances) {
  float cell = axis.x + at(axis.yzw, within) * distances.x, beyond = axis.x + at(axis.yzw, to) * distances.y;
  bool up = beyond > cell;
  float border = up ? floor(cell) + 1.0 : ceil(cell) - 1.0;
  Linear line = (axis.x - border) * inverse + axis.yzw;
  line = up ? line : -line;
  return Crossing(line, -at(line, from), at(line, to));
}

bool is_crossed(Crossing c) { return c.after > 0.0 && c.before + c.after > 0.0; }

// Quads are drawn a little larger than faces (draw_quads.vert): a pixel may show a surface that ends so far before its centre.
const float kGrown = 1.0 / 64.0;

// How the surface beside a pixel meets the pixel's own.
struct Side {
  float share;  // of the pixel, that the other surface covers beyond a line that is known
  float hole;   // 1: the pixel's own is a leaf or a plant whose texture ends within the pixel or beside it
  float tip;    // 1: the other one is, and is the nearer
};

// @param towards the neighbour. @param known whether the nearer of the two is of the island that is seen.
Side side_of(SeenFace own, SeenFace other, vec2 towards, bool known) {
  // How much the continued planes lie before what is seen: there, and here.
  float there = at(own.inverse, towards) - at(other.inverse, towards), here = other.inverse.x - own.inverse.x;
  bool apart = known && (((own.word ^ other.word) & 0x7fff0000u) != 0u || abs(there) > 1e-4 * own.inverse.x);
  bool crease = there * here > -kGrown * max(there * there, here * here), own_ends = there > 0.0;
  SeenFace nearer = other;
  if (own_ends) nearer = own;
  // Where the nearer one ends between the pixel that shows it and the one that does not.
  vec2 from = own_ends ? vec2(0.0) : towards, to = own_ends ? towards : vec2(0.0), within = from - kGrown * (to - from);
  vec2 distances = 1.0 / vec2(at(nearer.inverse, within), at(nearer.inverse, to));
  Crossing u = crossing_of(nearer.u, nearer.inverse, from, to, within, distances);
  Crossing v = crossing_of(nearer.v, nearer.inverse, from, to, within, distances);
  // The first of the two: before / (before + after) is the less.
  if (is_crossed(v) && (!is_crossed(u) || v.before * u.after < u.before * v.after)) u = v;
  // A plant ends by its texture, at the border of its voxel at the latest.
  bool ends = distances.y > 0.0 && is_crossed(u) && surface_face(nearer.word) < kFaceCount;
  float side = abs(there) > abs(here) ? sign(there) : sign(here);
  Linear line = crease ? side * (own.inverse - other.inverse) : own_ends ? u.line : -u.line;
  bool in_texture = apart && !ends && !crease;
  return Side(apart && (ends || crease) ? positive_share(line) : 0.0, float(in_texture && own_ends), float(in_texture && !own_ends));
}

// Share of the pixel that a leaf's or a plant's texture covers; of any other surface 1. @param seen a pixel that shows it.
// @param places of the pixel that are asked, 1 or 2.
float texture_share(SeenFace s, vec2 seen, int places) {
  uint face = surface_face(s.word);
  uint layer = face_layer(face, surface_block(s.word));
  bool plant = face >= kFaceCount, level_face = (face >> 1) == 1u;
  float down_v = level_face ? 1.0 : -1.0;  // v runs downwards
  float distance = 1.0 / s.inverse.x, distance_seen = 1.0 / at(s.inverse, seen);
  vec2 middle = vec2(s.u.x + s.u.y * distance, s.v.x + s.v.y * distance);
  vec2 shown = vec2(s.u.x + at(s.u.yzw, seen) * distance_seen, s.v.x + at(s.v.yzw, seen) * distance_seen);
  // A pixel further, on the plane.
  vec2 way = middle - vec2(s.u.x, s.v.x);
  vec2 right = (vec2(s.u.z, s.v.z) - way * s.inverse.y) * distance, down = (vec2(s.u.w, s.v.w) - way * s.inverse.z) * distance;
  float texels = kTextureEdge * sqrt(max(dot(right, right), dot(down, down)));
  // Each place stands for half the pixel; its edges are as soft as that is wide.
  float level = round(max(log2(texels) - 1.0, 0.0)), steep = max(2.0 / max(texels, 1e-3), 1.0);
  // A plant's texture is that of one voxel and ends with it.
  middle -= plant ? floor(shown + vec2(0.0, 0.001)) : floor(middle);
  vec2 place = vec2(-0.125, 0.25);
  float sum = 0.0;
  for (int i = 0;;) {
    vec2 asked = place + kCentre, hit = middle + asked.x * right + asked.y * down, inside = abs(hit - 0.5), uv = vec2(hit.x, down_v * hit.y);
    if (plant) uv = plant_uv(uv);
    float alpha = clamp((textureLod(block_textures, vec3(uv, float(layer)), level).r - 0.5) * steep + 0.5, 0.0, 1.0);
    sum += plant && max(inside.x, inside.y) > 0.5 ? 0.0 : alpha;
    place = -place;  // across the centre
    if (++i >= places) break;
  }
  return s.word != 0u && s.inverse.x > 0.0 ? sum / float(places) : 0.0;
}
#endif
