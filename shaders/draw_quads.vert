#version 460
#extension GL_GOOGLE_include_directive : require
// Pulls one corner of a merged quad. Indexed draws: vertex = 4 * quad + corner, firstInstance = section. docs/conventions.md.
#include "include/common.glsl"

layout(scalar, binding = 0) readonly buffer Quads { Quad quads[]; };
layout(scalar, binding = 1) readonly buffer Sections { Section sections[]; };
layout(scalar, binding = 2) readonly buffer Islands { IslandTransform islands[]; };
layout(scalar, binding = 3) readonly buffer Views { mat4 clip_from_source[]; };
layout(push_constant) uniform Push {
  uint view;          // which matrix
  uint first_island;  // its island table: each view has its own, relative to its own centre
} push;

layout(constant_id = 0) const bool kTextured = false;  // cut-outs need texture coordinates

layout(location = 0) flat out uint out_surface;
layout(location = 1) out vec2 out_uv;

invariant gl_Position;

void main() {
  Quad quad = quads[gl_VertexIndex >> 2];
  uint corner = gl_VertexIndex & 3u;
  Section section = sections[gl_InstanceIndex];
  uint face = (quad.material >> 16) & 7u;
  vec3 low = vec3(quad.geometry & 63u, (quad.geometry >> 6) & 63u, (quad.geometry >> 12) & 63u);
  float along_u = float((quad.geometry >> 18) & 63u) + 1.0;
  float along_v = float((quad.geometry >> 24) & 63u) + 1.0;
  float u = (corner == 1u || corner == 2u) ? along_u : 0.0;
  float v = corner >= 2u ? along_v : 0.0;

  vec3 p;
  if (face < 6u) {
    uint axis = face >> 1;
    // u x v points along +axis for z (x, y) only; for x (z, y) and y (x, z) it points along -axis. Swapping u's direction of travel
    // keeps every face counter-clockwise seen from outside.
    bool mirrored = (axis == 2u) == ((face & 1u) != 0u);
    if (mirrored) u = along_u - u;
    float plane = (face & 1u) == 0u ? 1.0 : 0.0;
    p = low + (axis == 0u ? vec3(plane, v, u) : axis == 1u ? vec3(u, plane, v) : vec3(u, v, plane));
  } else {
    p = low + vec3(u, v, face == 6u ? u : 1.0 - u);
  }
  float voxel = float(1u << section.voxel_size_log2);
  vec3 lattice = vec3(section.origin) + p * voxel;
  gl_Position = clip_from_source[push.view] * vec4(world_from_lattice(islands[push.first_island + section.island], lattice), 1.0);
  out_surface = pack_surface(quad.material & 0xffffu, section.island, face);
  out_uv = vec2(0.0);
  if (kTextured) {
    vec3 within = lattice - vec3(section.origin);  // whole blocks off, so that texture coordinates stay small
    out_uv = face >= 6u ? vec2(u, -within.y) : face < 2u ? vec2(within.z, -within.y) : face < 4u ? within.xz : vec2(within.x, -within.y);
  }
}
