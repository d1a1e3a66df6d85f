#version 460
#extension GL_GOOGLE_include_directive : require
// Pulls one corner of a merged quad. Indexed draws: vertex = 4 * quad + corner, firstInstance = section. docs/conventions.md.
// Two loads of the quad and three of its section are all a vertex reads: on lavapipe loads are what vertices cost.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(scalar, binding = kQuadsBinding) readonly buffer Quads { uvec2 quads[]; };  // Quad
layout(scalar, binding = kSectionTransformsBinding) readonly buffer Transforms { SectionTransform transforms[]; };
layout(push_constant, scalar) uniform Push {
  mat4 clip_from_source;  // of this view
  uint first_transform;   // of this view
  float growth;           // see below, blocks a block of distance (of an orthographic view: blocks)
  float level_growth;     // the same of quads that lie level
} push;

layout(constant_id = kTexturedConstant) const bool kTextured = false;  // cut-outs need texture coordinates
layout(constant_id = kBlendedConstant) const bool kBlended = false;

layout(location = 0) flat out uint out_surface;
layout(location = 1) out vec2 out_uv;  // without texture coordinates x is the other translucent block that the face touches, see Quad
layout(location = 0, component = 1) flat out uvec2 out_blend;  // Section.blend, and 1 if the quad is opaque

invariant gl_Position;

void main() {
  uvec2 quad = quads[gl_VertexIndex >> 2];
  uint corner = gl_VertexIndex & 3u;
  uint face = surface_face(quad.y);
  uint axis = face >> 1;
  vec3 low = vec3(quad.x & 63u, (quad.x >> 6) & 63u, (quad.x >> 12) & 63u);
  float along_u = float((quad.x >> 18) & 63u) + 1.0;
  float along_v = float((quad.x >> 24) & 63u) + 1.0;
  bool plus = (face & 1u) == 0u;
  // u x v points along +axis for z faces (x, y); for x (z, y) and y (x, z) it points along -axis. Swapping u's direction of travel keeps
  // every face counter-clockwise seen from outside.
  bool mirrored = (axis == 2u) != plus;
  float u = ((corner == 1u || corner == 2u) != (mirrored && face < 6u)) ? along_u : 0.0;
  float v = corner >= 2u ? along_v : 0.0;
  float plane = plus ? 1.0 : 0.0;
  vec3 offset = axis == 0u ? vec3(plane, v, u) : axis == 1u ? vec3(u, plane, v) : axis == 2u ? vec3(u, v, plane) : vec3(u, v, plus ? u : 1.0 - u);
  vec3 voxel = low + offset;
  SectionTransform t = transforms[push.first_transform + gl_InstanceIndex];
  // Merged quads meet in T-junctions, and vertices snap to 1/256 pixel, so that light shines through between them. Every quad grows in its
  // own plane by 1/128 pixel; in voxels, where its plane stays exact.
  vec4 p = vec4(dot(t.x, vec4(voxel, 1.0)), dot(t.y, vec4(voxel, 1.0)), dot(t.z, vec4(voxel, 1.0)), 1.0);
  float distance = dot(vec4(push.clip_from_source[0].w, push.clip_from_source[1].w, push.clip_from_source[2].w, push.clip_from_source[3].w), p);
  float by = max(distance, 0.05) * (axis == 1u ? push.level_growth : push.growth) * inversesqrt(dot(vec3(t.x.x, t.y.x, t.z.x), vec3(t.x.x, t.y.x, t.z.x)));
  float by_u = u > 0.0 ? by : -by, by_v = v > 0.0 ? by : -by;
  voxel += axis == 0u ? vec3(0.0, by_v, by_u) : axis == 1u ? vec3(by_u, 0.0, by_v) : axis == 2u ? vec3(by_u, by_v, 0.0) : vec3(0.0);
  p = vec4(dot(t.x, vec4(voxel, 1.0)), dot(t.y, vec4(voxel, 1.0)), dot(t.z, vec4(voxel, 1.0)), 1.0);
  gl_Position = push.clip_from_source * p;
  out_surface = (quad.y & ((1u << kTouchedShift) - 1u)) | kSurfaceHere;
  out_uv = vec2(float(touched_by(quad.x, quad.y)), 0.0);
  out_blend = uvec2(0u);
  if (kBlended) out_blend = uvec2(t.blend, uint(uint(gl_VertexIndex) >> 2 < t.first_cutout));
  // In voxels: cut-outs of coarse levels show one texture a voxel. v runs downwards, so its sign is turned.
  if (kTextured) out_uv = axis == 0u ? vec2(u, -v) : axis == 1u ? vec2(u, v) : vec2(u, -v);
}
