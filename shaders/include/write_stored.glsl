// For fragment shaders of a G-buffer that keeps normals or positions: one or two more colour targets, the normal first.
#ifndef SKERRY_WRITE_STORED_GLSL
#define SKERRY_WRITE_STORED_GLSL
#include "shared/bindings.h"
#include "shared/constants.h"
#include "include/stored.glsl"

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kIslandsBinding) uniform Islands { IslandTransform islands[kMaxIslands]; };

layout(constant_id = kStoredConstant) const bool kStored = false;  // else what follows is not used
layout(constant_id = kNormalCodeConstant) const uint kNormalCode = 0u;
layout(constant_id = kPositionStoredConstant) const bool kPositionStored = false;

layout(location = 1) out vec4 out_first;
layout(location = 2) out vec4 out_second;  // the position, when both are kept

void write_stored(uint word) {
  vec3 ray = pixel_ray(ivec2(gl_FragCoord.xy));
  vec4 position = vec4(ray * view_distance(gl_FragCoord.z, frame.near_plane), 1.0);
  vec3 normal = world_from_lattice_vector(islands[surface_island(word)], face_normal(surface_face(word)));
  out_first = kNormalCode != kNormalExact ? texel_from_normal(normal, kNormalCode) : position;
  if (kNormalCode != kNormalExact && kPositionStored) out_second = position;
}
#endif
