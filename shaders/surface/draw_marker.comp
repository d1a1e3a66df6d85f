#version 460
#extension GL_GOOGLE_include_directive : require
// Outline and cracks of the block pointed at, over the developed picture and behind what is nearer. docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/marker.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kPictureBinding, rgba8) uniform image2D picture;
layout(scalar, push_constant) uniform Push { MarkerConstants marker; } push;

layout(constant_id = kSamplesPerEdgeConstant) const uint kSamplesPerEdge = 1u;  // of a pixel, in the depth image

const float kRim = 1.0;            // pixels of light around a line, so that it shows before what is dark, too
const float kLineCover = 0.85, kRimCover = 0.22, kCrackCover = 0.65, kCrackRim = 0.1;
const float kOnBox = 0.01;         // blocks by which rounding may part a surface from the box it belongs to
const uint kCrackTexels = 32u;     // along a face's edge
const float kCrackCells = 4.0;     // shards along a face's edge
const float kCrackWidth = 0.08;    // of a shard

vec2 screen_scale() { return 0.5 * vec2(frame.picture_size); }

// Pixel coordinates and distance along the view axis.
vec3 project(vec3 point) {
  MarkerConstants m = push.marker;
  vec3 from_eye = point - m.eye;
  float z = dot(from_eye, m.forward);
  vec2 ndc = vec2(dot(from_eye, m.right) / dot(m.right, m.right), -dot(from_eye, m.up) / dot(m.up, m.up)) / z;
  return vec3((ndc + 1.0) * screen_scale(), z);
}

// How far a pixel is from the box's edge a to b, if nothing nearer hides it there; far away if something does.
float edge_distance(vec3 a, vec3 b, vec2 pixel, float surface_z, bool on_box) {
  const float kFar = 1e6;
  float za = dot(a - push.marker.eye, push.marker.forward), zb = dot(b - push.marker.eye, push.marker.forward);
  float near_plane = frame.near_plane;
  if (max(za, zb) <= near_plane) return kFar;
  // What reaches behind the eye ends before it.
  vec3 a_seen = za < near_plane ? mix(a, b, (near_plane - za) / (zb - za)) : a;
  vec3 b_seen = zb < near_plane ? mix(b, a, (near_plane - zb) / (za - zb)) : b;
  vec3 pa = project(a_seen), pb = project(b_seen);
  vec2 along = pb.xy - pa.xy;
  float s = clamp(dot(pixel - pa.xy, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
  float z = 1.0 / mix(1.0 / pa.z, 1.0 / pb.z, s);
  // A line lies on the block's faces and on those that go on beside it; a pixel beside it, these may be nearer than it by their slope.
  float slack = 0.01 + 0.004 * z * z;
  if (!on_box && surface_z < z - slack) return kFar;
  return distance(pixel, pa.xy + s * along);
}

// Distance to the nearest visible edge of the faces that look at the eye.
float outline_distance(vec2 pixel, float surface_z, bool on_box) {
  MarkerConstants m = push.marker;
  float nearest = 1e6;
  for (int axis = 0; axis < 3; ++axis) {
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    bool low = m.eye[axis] < 0.0, high = m.eye[axis] > m.size[axis];
    if (!low && !high) continue;
    for (int corner = 0; corner < 4; ++corner) {
      // Around the face: (0,0) (1,0) (1,1) (0,1).
      vec3 a = vec3(0.0), b = vec3(0.0);
      a[axis] = b[axis] = high ? m.size[axis] : 0.0;
      a[u] = corner == 1 || corner == 2 ? m.size[u] : 0.0;
      a[v] = corner >= 2 ? m.size[v] : 0.0;
      b[u] = corner <= 1 ? m.size[u] : 0.0;
      b[v] = corner == 1 || corner == 2 ? m.size[v] : 0.0;
      nearest = min(nearest, edge_distance(a, b, pixel, surface_z, on_box));
    }
  }
  return nearest;
}

uint mixed(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}
vec2 shard_centre(ivec2 cell, uint face) {
  uint h = mixed(uint(cell.x + 8) + uint(cell.y + 8) * 32u + face * 1024u);
  return vec2(cell) + vec2(float(h & 0xffffu), float(h >> 16)) / 65535.0;
}

// Whether a crack runs through a texel of a face: along the borders of shards (the cells of S. Worley, A cellular texture basis
// function, 1996), from the middle of the face outwards as digging goes on.
bool cracked(ivec2 texel, uint face) {
  vec2 uv = (vec2(texel) + 0.5) / float(kCrackTexels);
  vec2 at = uv * kCrackCells;
  float nearest = 1e6, second = 1e6;
  for (int i = 0; i < 9; ++i) {
    float d = distance(at, shard_centre(ivec2(floor(at)) + ivec2(i % 3 - 1, i / 3 - 1), face));
    second = min(second, max(d, nearest));
    nearest = min(nearest, d);
  }
  return second - nearest < kCrackWidth && length(uv - 0.5) < 0.1 + 0.65 * push.marker.dug;
}

vec3 with_cracks(vec3 colour, vec3 on_face) {
  vec3 share = on_face / push.marker.size;
  vec3 to_face = min(abs(share), abs(1.0 - share));
  int axis = to_face.x < min(to_face.y, to_face.z) ? 0 : to_face.y < to_face.z ? 1 : 2;
  vec2 uv = clamp(vec2(share[(axis + 1) % 3], share[(axis + 2) % 3]), 0.0, 0.9999);
  uint face = uint(axis) * 2u + (share[axis] > 0.5 ? 0u : 1u);
  ivec2 texel = ivec2(uv * float(kCrackTexels));
  if (cracked(texel, face)) return colour * (1.0 - kCrackCover);
  // Light catches the lower rims, so that cracks show at night, too.
  return cracked(texel + ivec2(1), face) ? mix(colour, vec3(frame.display_peak), kCrackRim) : colour;
}

void main() {
  MarkerConstants m = push.marker;
  uvec2 pixel = m.first + gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, m.end))) return;
  vec2 centre = vec2(pixel) + 0.5;
  vec2 ndc = centre / screen_scale() - 1.0;
  vec3 ray = m.forward + m.right * ndc.x - m.up * ndc.y;
  float depth = texelFetch(depths, ivec2(pixel * kSamplesPerEdge + kSamplesPerEdge / 2u), 0).r;
  float surface_z = depth > 0.0 ? view_distance(depth, frame.near_plane) : 1e6;
  vec3 surface = m.eye + ray * surface_z;
  bool on_box = all(greaterThan(surface, vec3(-kOnBox))) && all(lessThan(surface, m.size + kOnBox));

  vec3 colour = imageLoad(picture, ivec2(pixel)).rgb;
  if (on_box && m.dug > 0.0) colour = with_cracks(colour, surface);
  float away = outline_distance(centre, surface_z, on_box);
  float rim = clamp(m.half_width + kRim + 0.5 - away, 0.0, 1.0), line = clamp(m.half_width + 0.5 - away, 0.0, 1.0);
  colour = mix(colour, vec3(frame.display_peak), kRimCover * rim);
  colour = mix(colour, vec3(0.0), kLineCover * line);
  imageStore(picture, ivec2(pixel), vec4(colour, 1.0));
}
