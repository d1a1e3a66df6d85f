// The points of a grid that pixels take light from. Needs before the include: what list_pixels.glsl does, `samples`, and kRun: pixels of a row that
// have their four points in common, if kStep is as much.
// docs/decisions/0030-light-at-fewer-pixels.md.
#ifndef SKERRY_GRID_POINTS_GLSL
#define SKERRY_GRID_POINTS_GLSL
#include "shared/constants.h"
#include "include/surface/light_samples.glsl"
#include "include/surface/list_pixels.glsl"

layout(constant_id = kToleranceConstant) const float kTolerance = 0.3;  // how much the four may differ, of the brightest

// How far apart planes may lie that are lit alike: by rounding; a plant above its foot; and pixels, which far planes lie closer than.
const float kAlikeBlocks = 0.05, kAlikePlants = 1.05, kAlikePixels = 1.0;
// How much farther or nearer, as a share and in blocks.
const float kAlikeShare = 0.1, kAlikeNear = 2.0;

// A pixel's surface, as far as it decides whose light it can take.
struct Taker {
  uint key;
  vec3 normal;  // of the lit face, world
  float along;  // of its plane, from the eye along the normal [blocks]
  float z;
  float apart;  // of planes, at most [blocks]
  bool plant;
  vec3 albedo;
};

// A point of the grid.
struct Point {
  uint key;
  vec3 position;
  float z;
  bool plant;
  mat2x3 sent;
};

Point point_at(uvec2 at) {
  uvec4 texel = imageLoad(samples, ivec2(at));
  float z = place_z(texel.w);
  return Point(place_key(texel.w), pixel_ray(at * kStep) * z, z, place_on_plant(texel.w), sample_of(texel));
}

struct Four {
  Point p00, p10, p01, p11;
};

Four four_at(uvec2 low, uvec2 high) {
  high = min(high, grid_size() - 1u);
  return Four(point_at(low), point_at(uvec2(high.x, low.y)), point_at(uvec2(low.x, high.y)), point_at(high));
}

// The four around a pixel.
Four four_around(uvec2 pixel) {
  uvec2 low = pixel / kStep, beside = pixel % kStep;
  return four_at(low, low + (kStep == kRun ? uvec2(1u, min(beside.y, 1u)) : min(beside, 1u)));
}

// Whether a point of the grid shows what lies on the pixel's plane and is lit as it is.
bool on_plane(Point p, Taker by) {
  float apart = by.plant || p.plant ? by.apart + kAlikePlants : by.apart;
  return p.key == by.key && abs(dot(by.normal, p.position) - by.along) <= apart;
}

// 1 if it is also about as far, else 0.
float alike(Point p, Taker by) { return on_plane(p, by) && abs(p.z - by.z) <= kAlikeNear + kAlikeShare * by.z ? 1.0 : 0.0; }

#endif
