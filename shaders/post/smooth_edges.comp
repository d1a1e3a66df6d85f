#version 460
#extension GL_GOOGLE_include_directive : require
// The listed pixels (find_edges.comp) by what covers them: the pixel's own surface and those of its four neighbours, each by its share of the
// pixel. Surfaces are faces of voxels, so that the line between two of them is known exactly: where their planes meet, or the lattice line at
// which the nearer one ends. Of leaves and plants, the share that their texture covers is asked at four places of the pixel. A second step
// stores what the first has found. docs/decisions/0043.
#include "include/frame/common.glsl"
#include "shared/edges.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kIslandsBinding) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kPictureBinding, rgba8) uniform image2D picture;
layout(scalar, binding = kListedBinding) readonly buffer Listed { TileDispatch listed; };
layout(scalar, binding = kEdgePixelsBinding) buffer Pixels { EdgePixel pixels[]; };

layout(constant_id = kStoreConstant) const bool kStore = false;

#include "include/post/edge_lines.glsl"

const ivec2 kBeside[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

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

Cover cover_of(ivec2 pixel) {
  vec3 ray = pixel_ray(pixel);
  float depth = texelFetch(depths, pixel, 0).r;
  uint word = covered_word(imageLoad(surfaces, pixel).r, depth);
  vec4 depths_beside;
  uvec4 words;
  uint island = surface_island(word), other_island = island;
  for (int i = 0; i < 4; ++i) {
    ivec2 beside = in_picture(pixel + kBeside[i]);
    depths_beside[i] = texelFetch(depths, beside, 0).r;
    words[i] = covered_word(imageLoad(surfaces, beside).r, depths_beside[i]);
    if (words[i] != 0u && surface_island(words[i]) != island) other_island = surface_island(words[i]);
  }
  // Loads of islands are what this costs on lavapipe. Where three meet, one of them is left as it is.
  Sight own_sight = sight_in(island, ray), other_sight = sight_in(other_island, ray);
  SeenFace own = face_at(vec2(0.0), depth, word, own_sight), cut_out = own;
  vec2 cut_out_seen = vec2(0.0);
  vec4 shares, holes, tips;
  for (int i = 0; i < 4; ++i) {
    uint its_island = surface_island(words[i]);
    Sight sight = own_sight;
    if (words[i] != 0u && its_island != island) sight = other_sight;
    SeenFace other = face_at(vec2(kBeside[i]), depths_beside[i], words[i], sight);
    Side side = side_of(own, other, vec2(kBeside[i]));
    bool known = words[i] == 0u || its_island == island || its_island == other_island;
    shares[i] = known ? side.share : 0.0;
    holes[i] = known ? side.hole : 0.0;
    tips[i] = known ? side.tip : 0.0;
    if (tips[i] > 0.0) {
      cut_out = other;
      cut_out_seen = vec2(kBeside[i]);
    }
  }
  float hole_count = dot(holes, vec4(1.0)), tip_count = dot(tips, vec4(1.0));
  if (hole_count > 0.0) {
    cut_out = own;
    cut_out_seen = vec2(0.0);
  }
  // One line that leaves through two sides of the pixel is found twice.
  vec2 by_axis = vec2(shares.x + shares.y, shares.z + shares.w);
  Cover cover;
  cover.own = 1.0 - min(max(by_axis.x, by_axis.y), 1.0);
  cover.beside = shares * ((1.0 - cover.own) / max(by_axis.x + by_axis.y, 1e-6));
  float solid = texture_share(cut_out, cut_out_seen);
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
  bool here = index < listed.tiles;
  EdgePixel edge = pixels[here ? index : 0u];
  ivec2 pixel = ivec2(edge.place & 0xffffu, edge.place >> 16);
  if (kStore) {
    if (here) imageStore(picture, pixel, unpackUnorm4x8(edge.colour));
    return;
  }
  Cover cover = cover_of(pixel);
  vec3 light = cover.own * light_at(pixel);
  for (int i = 0; i < 4; ++i) light += cover.beside[i] * light_at(pixel + kBeside[i]);
  if (here) pixels[index].colour = packUnorm4x8(vec4(sqrt(light), 1.0));
}
