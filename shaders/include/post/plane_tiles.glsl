// Tiles whose pixels all lie on one plane. Needs before the include: `frame`, `depths`.
#ifndef SKERRY_PLANE_TILES_GLSL
#define SKERRY_PLANE_TILES_GLSL

struct Sample {
  vec2 place;
  float depth;
};

Sample sample_at(ivec2 pixel) {
  pixel = clamp(pixel, ivec2(0), ivec2(frame.size) - 1);
  return Sample(vec2(pixel), texelFetch(depths, pixel, 0).r);
}

// The plane through three pixels at a tile's corners.
struct Plane {
  vec2 place, slope;
  float depth;
};

Plane plane_through(Sample a, Sample b, Sample c) {
  vec2 ab = b.place - a.place, ac = c.place - a.place;
  vec2 rise = vec2(b.depth, c.depth) - a.depth;
  return Plane(a.place, vec2(rise.x * ac.y - rise.y * ab.y, rise.y * ab.x - rise.x * ac.x) / (ab.x * ac.y - ab.y * ac.x), a.depth);
}

// @param bend of reverse depth, as a share of it: less is a plane.
bool lies_on(Plane plane, Sample s, float bend) {
  return abs(plane.depth + dot(plane.slope, s.place - plane.place) - s.depth) <= bend * max(plane.depth, s.depth);
}

// Pixels of the tile and of those beside it, some in each of its rows and columns: a line across the tile is met wherever it lies.
bool is_plane(ivec2 low, float bend) {
  Plane plane = plane_through(sample_at(low - 1), sample_at(low + ivec2(8, 0)), sample_at(low + ivec2(0, 8)));
#define on(x, y) lies_on(plane, sample_at(low + ivec2(x, y)), bend)
  bool inner = on(1, 3) && on(2, 6) && on(3, 1) && on(4, 4) && on(5, 7) && on(6, 2) && on(7, 5);
  return inner && on(8, 6) && on(-1, 2) && on(-1, 6) && on(2, -1) && on(6, -1) && on(5, 8);
}
#endif
