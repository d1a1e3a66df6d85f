// For fragment shaders of a G-buffer that keeps normals or positions: a further colour target, or with SKERRY_STORED_BOTH two.
#ifndef SKERRY_WRITE_STORED_GLSL
#define SKERRY_WRITE_STORED_GLSL
#include "shared/bindings.h"
#include "shared/constants.h"
#include "include/scene/stored.glsl"

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"

layout(constant_id = kNormalCodeConstant) const uint kNormalCode = 0u;

#ifdef SKERRY_STORED_BOTH
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec4 out_position;
#else
layout(location = 1) out vec4 out_stored;  // the normal, or the position if normals are exact
#endif

void write_stored(uint word) {
  vec3 ray = pixel_ray(ivec2(gl_FragCoord.xy));
  vec4 position = vec4(ray * view_distance(gl_FragCoord.z, frame.near_plane), 1.0);
  vec3 normal = world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word)));
#ifdef SKERRY_STORED_BOTH
  out_normal = texel_from_normal(normal, kNormalCode);
  out_position = position;
#else
  out_stored = kNormalCode != kNormalExact ? texel_from_normal(normal, kNormalCode) : position;
#endif
}
#endif
