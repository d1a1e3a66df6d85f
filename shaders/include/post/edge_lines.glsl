// Lines at which surfaces end in the picture, and the shares of a pixel on their sides. Everything is relative to one pixel's centre, in pixels.
// Needs before the include: common.glsl, `frame`, `islands`, `materials`, `block_textures`.
#ifndef SKERRY_EDGE_LINES_GLSL
#define SKERRY_EDGE_LINES_GLSL
#include "include/surface/surface.glsl"

// A value that is linear in the picture: at the pixel's centre, and its slopes to the right and down.
#define Linear vec3
float at(Linear value, vec2 place) { return value.x + dot(value.yz, place); }

// The eye and the pixel's ray in an island's lattice.
struct Sight {
  vec3 eye;
  vec3 ray, ray_x, ray_y;  // through the pixel's centre, and what is added to it a pixel further
};

Sight sight_in(uint island, vec3 ray) {
  IslandTransform t = islands[island];
  return Sight(-lattice_from_world_vector(t, t.translation), lattice_from_world_vector(t, ray),
               lattice_from_world_vector(t, frame.ray_right) * frame.pixel_to_ndc.x, -lattice_from_world_vector(t, frame.ray_up) * frame.pixel_to_ndc.y);
}

// The plane of the surface that a pixel shows, continued over its surroundings. Where it is seen its inverse distance is linear in the picture.
struct SeenFace {
  uint word;       // 0: the sky, at inverse distance 0
  Linear inverse;  // 1 / (blocks along the view axis)
  Sight sight;     // in its island
};

// @param depth, word of the pixel that is `offset` from the one that is worked on.
SeenFace face_at(vec2 offset, float depth, uint word, Sight sight) {
  uint face = surface_face(word);
  vec3 normal = face >= 6u ? vec3(1.0, 0.0, face == 6u ? -1.0 : 1.0) : abs(face_normal(face));
  vec3 hit = sight.eye + (sight.ray + offset.x * sight.ray_x + offset.y * sight.ray_y) * view_distance(max(depth, 1e-30), frame.near_plane);
  // Planes lie at whole numbers of the lattice, which depth alone gives less exactly.
  float height = round(dot(normal, hit)) - dot(normal, sight.eye);
  Linear inverse = vec3(dot(normal, sight.ray), dot(normal, sight.ray_x), dot(normal, sight.ray_y)) / (abs(height) < 1e-6 ? 1e-6 : height);
  return SeenFace(word, word == 0u ? vec3(0.0) : inverse, sight);
}

// Share of the pixel's square in which a linear value is positive: the second integral of a step along both slopes.
float positive_share(Linear value) {
  vec2 slope = max(abs(value.yz), vec2(1e-4 * max(abs(value.y), abs(value.z)) + 1e-20));
  float scale = 1.0 / max(slope.x, slope.y), d = value.x * scale;
  slope *= scale;
  float wide = 0.5 * (slope.x + slope.y), narrow = 0.5 * abs(slope.x - slope.y);
  vec4 r = max(vec4(d + wide, d + narrow, d - narrow, d - wide), vec4(0.0));
  r *= r;
  return clamp((r.x - r.y - r.z + r.w) / (2.0 * slope.x * slope.y), 0.0, 1.0);
}

vec3 lattice_at(SeenFace s, vec2 place) {
  return s.sight.eye + (s.sight.ray + place.x * s.sight.ray_x + place.y * s.sight.ray_y) / at(s.inverse, place);
}

// The value that is 0 on the line of one lattice coordinate, positive beyond it, and how far from `from` to `to` the line is crossed: more than
// 1 if it is not.
void lattice_line(SeenFace s, int axis, vec2 from, vec2 to, float cell, float beyond, inout Linear line, inout float crossed) {
  bool up = beyond > cell;
  float border = up ? floor(cell) + 1.0 : ceil(cell) - 1.0;
  Linear value = (s.sight.eye[axis] - border) * s.inverse + vec3(s.sight.ray[axis], s.sight.ray_x[axis], s.sight.ray_y[axis]);
  value = up ? value : -value;
  float first = at(value, from), second = at(value, to);
  float place = second > 0.0 ? first / (first - second) : 2.0;
  bool nearer = place < crossed;
  line = nearer ? value : line;
  crossed = nearer ? place : crossed;
}

// Quads are drawn a little larger than faces (draw_quads.vert): a pixel may show a surface that ends so far before its centre.
const float kGrown = 1.0 / 64.0;

// Where the nearer of two surfaces ends between the pixel that shows it and the one that does not: positive beyond.
// @return whether that is known.
bool end_of(SeenFace s, vec2 from, vec2 to, out Linear line) {
  line = vec3(0.0);
  uint face = surface_face(s.word);
  int u = face < 2u ? 2 : 0, v = face == 2u || face == 3u ? 2 : 1;
  vec3 cell = lattice_at(s, from - kGrown * (to - from)), beyond = lattice_at(s, to);
  float crossed = 2.0;
  lattice_line(s, u, from, to, cell[u], beyond[u], line, crossed);
  lattice_line(s, v, from, to, cell[v], beyond[v], line, crossed);
  // A plant ends by its texture, at the border of its voxel at the latest.
  return at(s.inverse, to) > 0.0 && crossed <= 1.0 && face < kFaceCount;
}

// How the surface beside a pixel meets the pixel's own.
struct Side {
  float share;  // of the pixel, that the other surface covers beyond a line that is known
  float hole;   // 1: the pixel's own is a leaf or a plant whose texture ends within the pixel or beside it
  float tip;    // 1: the other one is, and is the nearer
};

// @param towards the neighbour.
Side side_of(SeenFace own, SeenFace other, vec2 towards) {
  // How much the continued planes lie before what is seen: there, and here.
  float there = at(own.inverse, towards) - at(other.inverse, towards), here = other.inverse.x - own.inverse.x;
  bool apart = ((own.word ^ other.word) & 0x7fff0000u) != 0u || abs(there) > 1e-4 * own.inverse.x;
  bool crease = there * here > -kGrown * max(there * there, here * here), own_ends = there > 0.0;
  SeenFace nearer = other;
  if (own_ends) nearer = own;
  Linear line;
  bool known = end_of(nearer, own_ends ? vec2(0.0) : towards, own_ends ? towards : vec2(0.0), line);
  float side = abs(there) > abs(here) ? sign(there) : sign(here);
  line = crease ? side * (own.inverse - other.inverse) : own_ends ? line : -line;
  bool in_texture = apart && !known && !crease;
  return Side(apart && (known || crease) ? positive_share(line) : 0.0, float(in_texture && own_ends), float(in_texture && !own_ends));
}

// Share of the pixel that a leaf's or a plant's texture covers; of any other surface 1. @param seen a pixel that shows it.
float texture_share(SeenFace s, vec2 seen) {
  uint face = surface_face(s.word);
  Material material = materials[surface_block(s.word)];
  uint layer = face == 2u ? material.layer_top : face == 3u ? material.layer_bottom : material.layer_side;
  vec3 middle = lattice_at(s, vec2(0.0)), shown = lattice_at(s, seen), way = middle - s.sight.eye;
  // A pixel further, on the plane.
  vec3 right = (s.sight.ray_x - way * s.inverse.y) / s.inverse.x, down = (s.sight.ray_y - way * s.inverse.z) / s.inverse.x;
  vec2 uv_right = face_uv(face, right), uv_down = face_uv(face, down);
  float texels = kTextureEdge * sqrt(max(dot(uv_right, uv_right), dot(uv_down, uv_down)));
  // Each place stands for a quarter of the pixel; its edges are as soft as that is wide.
  float level = round(max(log2(texels) - 1.0, 0.0)), steep = max(2.0 / max(texels, 1e-3), 1.0);
  // A plant's texture is that of one voxel and ends with it.
  bool plant = face >= kFaceCount;
  vec3 voxel = plant ? floor(shown + vec3(0.0, 0.001, 0.0)) : floor(middle);
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec2 place = vec2((i & 1) == 0 ? -0.125 : 0.125, 0.375) * (i < 2 ? 1.0 : -1.0);
    if ((i & 1) != 0) place = place.yx;
    vec3 hit = middle + place.x * right + place.y * down - voxel;
    vec2 uv = face_uv(face, hit), inside = abs(uv - vec2(0.5, -0.5));
    if (plant) uv = plant_uv(uv);
    float alpha = clamp((textureLod(block_textures, vec3(uv, float(layer)), level).a - 0.5) * steep + 0.5, 0.0, 1.0);
    sum += plant && max(inside.x, inside.y) > 0.5 ? 0.0 : alpha;
  }
  return s.word != 0u && s.inverse.x > 0.0 ? 0.25 * sum : 0.0;
}
#endif
