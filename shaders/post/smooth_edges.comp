#version 460
#extension GL_GOOGLE_include_directive : require
// The listed pixels (find_edges.comp) by what covers them: the pixel's own surface and those of its four neighbours, each by its share of the
// pixel. Surfaces are faces of voxels, so that the line between two of them is known exactly: where their planes meet, or the lattice line at
// which the nearer one ends. Of leaves and plants, the share that their texture covers is asked at two places of the pixel. A second step
// stores what the first has found. docs/decisions/0043.
#include "include/frame/common.glsl"
#include "shared/edges.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;  // their coverage: render::coverage_texels()
layout(binding = kPictureBinding, rgba8) uniform image2D picture;
layout(scalar, binding = kTileDispatchesBinding) readonly buffer Dispatches { TileDispatch dispatches[kEdgeDispatches]; };  // 1: pixels
layout(scalar, binding = kEdgePixelsBinding) buffer Pixels { EdgePixel pixels[]; };

layout(constant_id = kStoreConstant) const bool kStore = false;

#include "include/post/edge_lines.glsl"

ivec2 in_picture(ivec2 pixel) { return clamp(pixel, ivec2(0), ivec2(frame.size) - 1); }

// Light of the display, by a curve near enough to sRGB's: it is only mixed, and encoded again.
vec3 light_at(ivec2 pixel) {
  vec3 encoded = imageLoad(picture, in_picture(pixel)).rgb;
  return encoded * encoded;
}

// What covers a pixel, by share: itself and its neighbours.
struct Cover {
  float own;
  vec4 beside;
};

// What a pixel shows.
struct Seen {
  float depth;
  uint word;
};

Seen seen_at(ivec2 pixel) {
  pixel = in_picture(pixel);
  float depth = texelFetch(depths, pixel, 0).r;
  return Seen(depth, covered_word(imageLoad(surfaces, pixel).r, depth));
}

bool is_of(Seen seen, uint island) { return seen.word != 0u && surface_island(seen.word) == island; }

Cover cover_of(ivec2 pixel) {
  Seen own = seen_at(pixel), left = seen_at(pixel - ivec2(1, 0)), right = seen_at(pixel + ivec2(1, 0));
  Seen above = seen_at(pixel - ivec2(0, 1)), below = seen_at(pixel + ivec2(0, 1));
  // Where islands meet, lines are the nearest one's.
  Seen nearest = own;
  if (left.depth > nearest.depth) nearest = left;
  if (right.depth > nearest.depth) nearest = right;
  if (above.depth > nearest.depth) nearest = above;
  if (below.depth > nearest.depth) nearest = below;
  uint island = surface_island(nearest.word);
  Sight sight = sight_in(island, pixel_ray(pixel));
  bool own_of = is_of(own, island);
  const vec2 kLeft = vec2(-1.0, 0.0), kRight = vec2(1.0, 0.0), kAbove = vec2(0.0, -1.0), kBelow = vec2(0.0, 1.0);
  SeenFace face = face_at(vec2(0.0), own.depth, own.word, sight, own_of);
#define side_to(other, towards) \
  side_of(face, face_at(towards, other.depth, other.word, sight, is_of(other, island)), towards, own_of || is_of(other, island))
  Side at_left = side_to(left, kLeft), at_right = side_to(right, kRight), at_above = side_to(above, kAbove), at_below = side_to(below, kBelow);
  vec4 shares = vec4(at_left.share, at_right.share, at_above.share, at_below.share);
  vec4 holes = vec4(at_left.hole, at_right.hole, at_above.hole, at_below.hole);
  vec4 tips = vec4(at_left.tip, at_right.tip, at_above.tip, at_below.tip);
  float hole_count = dot(holes, vec4(1.0)), tip_count = dot(tips, vec4(1.0));
  // The leaf or plant that covers a part of the pixel.
  Seen cut_out = own;
  vec2 seen = vec2(0.0);
  if (hole_count == 0.0) {
    if (tips.x > 0.0) { cut_out = left; seen = kLeft; }
    if (tips.y > 0.0) { cut_out = right; seen = kRight; }
    if (tips.z > 0.0) { cut_out = above; seen = kAbove; }
    if (tips.w > 0.0) { cut_out = below; seen = kBelow; }
  }
  // One line that leaves through two sides of the pixel is found twice.
  vec2 by_axis = vec2(shares.x + shares.y, shares.z + shares.w);
  Cover cover;
  cover.own = 1.0 - min(max(by_axis.x, by_axis.y), 1.0);
  cover.beside = shares * ((1.0 - cover.own) / max(by_axis.x + by_axis.y, 1e-6));
  int places = hole_count + tip_count > 0.0 ? 2 : 1;
  float solid = texture_share(face_at(seen, cut_out.depth, cut_out.word, sight, is_of(cut_out, island)), seen, places);
  if (hole_count > 0.0) {
    cover.beside += holes * (cover.own * (1.0 - solid) / hole_count);
    cover.own *= solid;
  } else if (tip_count > 0.0 && solid < 1.0) {  // else it is no cut-out, and ends where nothing says
    cover.beside = mix(cover.beside, tips / tip_count, solid);
    cover.own *= 1.0 - solid;
  }
  return cover;
}

void main() {
  uint index = (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  bool here = index < dispatches[1].tiles;
  EdgePixel edge = pixels[here ? index : 0u];
  ivec2 pixel = ivec2(edge.place & 0xffffu, edge.place >> 16);
  if (kStore) {
    if (here) imageStore(picture, pixel, unpackUnorm4x8(edge.colour));
    return;
  }
  Cover cover = cover_of(pixel);
  vec3 light = cover.own * light_at(pixel);
  light += cover.beside.x * light_at(pixel - ivec2(1, 0)) + cover.beside.y * light_at(pixel + ivec2(1, 0));
  light += cover.beside.z * light_at(pixel - ivec2(0, 1)) + cover.beside.w * light_at(pixel + ivec2(0, 1));
  if (here) pixels[index].colour = packUnorm4x8(vec4(sqrt(light), 1.0));
}
