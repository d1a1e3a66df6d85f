#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
// As choose_samples.comp, of squares of the grid that show one plane of one block: what depends on the block, on the plane and on the grid's points
// is found once for 16 pixels. An invocation takes a square, whose first pixel is a point of the grid. Points are alike if they lie on the plane,
// and differ too much if they do so for a surface of a usual albedo. docs/decisions/0085.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/clusters.h"
#include "shared/constants.h"

layout(local_size_x = kPlainGroup) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kSamplesBinding, rgba32ui) readonly uniform uimage2D samples;  // at the grid's points
// Of pixels that ask no light, and of those that ask some: the former from the beginning, the latter from the end.
layout(scalar, binding = kListedPixelsBinding) buffer Pixels { TileDispatch listed[kSampleLists]; uint pixels[]; };
layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;

#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/surface/surface.glsl"

const uint kRun = kSquareEdge;
const float kUsualAlbedo = 0.25;

#include "include/surface/grid_points.glsl"

// What a pixel sees of a plane, as an affine function of its place in the square.
struct Across {
  float corner, right, down;
};
Across across(vec3 direction, vec3 corner) {
  return Across(dot(direction, corner), dot(direction, frame.ray_right) * frame.pixel_to_ndc.x, -dot(direction, frame.ray_up) * frame.pixel_to_ndc.y);
}
float at(Across a, vec2 place) { return a.corner + a.right * place.x + a.down * place.y; }

// Coordinates of a face's texture: twin of face_uv().
struct FaceAxes {
  vec3 u, v;
};
FaceAxes face_axes(uint face, IslandTransform t) {
  return FaceAxes(face < 2u ? t.axis_z : t.axis_x, face == 2u || face == 3u ? t.axis_z : -t.axis_y);
}

// Of the plane through a square: everything by rays scaled to one block along the view axis.
struct Seen {
  Across facing, u, v;
  vec2 origin;   // texture coordinates of the eye
  float along;   // from the eye along the normal [blocks]
  vec3 right, up;  // u, v and normal of what is added for the pixels beside and above
};

Seen see(uint face, IslandTransform island, vec3 normal, vec3 ray, float z) {
  FaceAxes axes = face_axes(face, island);
  Seen s;
  s.facing = across(normal, ray);
  s.u = across(axes.u, ray);
  s.v = across(axes.v, ray);
  s.origin = -vec2(dot(axes.u, island.translation), dot(axes.v, island.translation));
  s.along = s.facing.corner * z;
  vec3 right = frame.ray_right * frame.pixel_to_ndc.x, up = frame.ray_up * frame.pixel_to_ndc.y;
  s.right = vec3(dot(axes.u, right), dot(axes.v, right), dot(normal, right));
  s.up = vec3(dot(axes.u, up), dot(axes.v, up), dot(normal, up));
  return s;
}

// Of the pixels of a row, whose footprints hardly differ: that of its middle.
Footprint row_footprint(Seen s, float row) {
  vec2 middle = vec2(0.5 * float(kSquareEdge) - 0.5, row);
  float facing = at(s.facing, middle);
  facing = abs(facing) < 1e-6 ? 1e-6 : facing;
  float z = s.along / facing;
  vec2 ray = vec2(at(s.u, middle), at(s.v, middle));
  return footprint_of(z * (s.right.xy - ray * (s.right.z / facing)), z * (s.up.xy - ray * (s.up.z / facing)), kTextureTaps);
}

// 1 for each of the four points on the plane.
vec4 on_plane(Four c, Taker by) {
  return vec4(1.0, on_plane(c.p10, by) ? 1.0 : 0.0, on_plane(c.p01, by) ? 1.0 : 0.0, on_plane(c.p11, by) ? 1.0 : 0.0);
}

float brightest(vec3 c) { return max(max(c.r, c.g), c.b); }

// Whether two points, if both are on the plane, send light that may be mixed.
bool near(vec3 most, vec3 least) { return brightest(most - least) <= kTolerance * brightest(most); }

// The pixels that may take light of the points about them, a bit each: the first, and with it the first row, the first column, or all.
uint sharing(Four c, vec4 same) {
  vec3 usual = vec3(kUsualAlbedo), c00 = radiance_at(c.p00.sent, usual);
  vec3 c10 = mix(c00, radiance_at(c.p10.sent, usual), same.y), c01 = mix(c00, radiance_at(c.p01.sent, usual), same.z);
  vec3 c11 = mix(c00, radiance_at(c.p11.sent, usual), same.w);
  vec3 row_most = max(c00, c10), row_least = min(c00, c10), most = max(max(row_most, c01), c11), least = min(min(row_least, c01), c11);
  return near(most, least) ? 0xffffu : 1u | (near(row_most, row_least) ? 0x000fu : 0u) | (near(max(c00, c01), min(c00, c01)) ? 0x1111u : 0u);
}

void main() {
  uvec2 first;
  bool square = listed_square((gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * kPlainGroup + gl_LocalInvocationIndex, first);
  uint word = imageLoad(surfaces, ivec2(first)).r, face = surface_face(word);
  float z = view_distance(surface_depth(texelFetch(depths, ivec2(first), 0).r), frame.near_plane);
  vec3 ray = pixel_ray(first);
  IslandTransform island = island_at(surface_island(word));
  vec3 normal = world_from_lattice_vector(island, face_normal(face));
  Seen seen = see(face, island, normal, ray, z);
  uint layer = face_layer(face, surface_block(word));
  float apart = kAlikeBlocks + kAlikePixels * z * frame.pixel_to_ndc.y * length(frame.ray_up);
  Four c = four_at(first / kStep, first / kStep + 1u);
  vec4 same = on_plane(c, Taker(alike_key(word), normal, seen.along, z, apart, false, vec3(0.0)));
  uint shares = emits_in_part(word) ? 0u : sharing(c, same);
  MeterRun run = meter_run(first);
  [[unroll]] for (uint y = 0u; y < kSquareEdge; ++y) {
    Footprint footprint = row_footprint(seen, float(y));
    float low = float(y) / float(kSquareEdge), high = 1.0 - low;
    mat2x3 left = c.p00.sent * high + c.p01.sent * (same.z * low), right = c.p10.sent * (same.y * high) + c.p11.sent * (same.w * low);
    float left_weight = high + same.z * low, right_weight = same.y * high + same.w * low;
    [[unroll]] for (uint x = 0u; x < kSquareEdge; ++x) {
      uvec2 pixel = first + uvec2(x, y);
      if (!in_one_cell(kSquareEdge)) run = meter_run(pixel);
      vec2 place = vec2(x, y);
      float t = seen.along / at(seen.facing, place);
      vec3 albedo = footprint_texel(layer, vec2(at(seen.u, place), at(seen.v, place)) * t + seen.origin, footprint).rgb;
      float f = float(x) / float(kSquareEdge), weight = mix(left_weight, right_weight, f);
      mat2x3 sent = (left * (1.0 - f) + right * f) * (1.0 / weight);
      bool shared_light = square && (shares >> (y * kSquareEdge + x) & 1u) != 0u;
      put_shown(pixel, shown(radiance_at(sent, albedo), shared_light), shared_light, run);
      if (!in_one_cell(kSquareEdge)) end_run(run);
    }
  }
  if (in_one_cell(kSquareEdge)) end_run(run);
  uint without = square ? ~shares & 0xffffu : 0u, lit = 0u;
  for (uint left = kLit ? without : 0u; left != 0u; left &= left - 1u) {
    uint i = uint(findLSB(left));
    uvec2 pixel = first + uvec2(i % kSquareEdge, i / kSquareEdge);
    if (asks_lights(pixel, texelFetch(depths, ivec2(pixel), 0).r)) lit |= left & -left;
  }
  Slots slots = first_slots(uint(bitCount(without & ~lit)), uint(bitCount(lit)));
  for (uint left = without; left != 0u; left &= left - 1u) {
    uint i = uint(findLSB(left));
    list_pixel(slots, (lit & left & -left) != 0u, first + uvec2(i % kSquareEdge, i / kSquareEdge));
  }
}
