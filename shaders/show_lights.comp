#version 460
#extension GL_GOOGLE_include_directive : require
// Debug views of the clusters. docs/conventions.md.
#include "include/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(scalar, binding = kIslandsBinding) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kPictureBinding, rgba8) writeonly uniform image2D picture;

layout(constant_id = kReachingConstant) const bool kReaching = false;  // count the lights that light the pixel, not those of its list

#include "include/clustered.glsl"

// 0 black, then blue over green and yellow to red: each step of the scale doubles the count, up to 256 and more.
vec3 heat(uint count) {
  float h = log2(float(count) + 1.0) / 8.0;
  vec3 warm = clamp(vec3(4.0 * h - 2.0, 2.0 - abs(4.0 * h - 2.0), 2.0 - 4.0 * h), 0.0, 1.0);
  return count == 0u ? vec3(0.0) : mix(vec3(0.0, 0.0, 0.4), warm, min(4.0 * h, 1.0));
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.size))) return;
  uint word = imageLoad(surfaces, ivec2(pixel)).r;
  float depth = texelFetch(depths, ivec2(pixel), 0).r;
  bool here = word != 0u && depth > 0.0;
  float z = view_distance(here ? depth : 1.0, frame.near_plane);
  Cluster list = lights_at(pixel, z);
  uint count = here ? list.count : 0u;
  if (kReaching) {
    vec3 normal = world_from_lattice_vector(islands[surface_island(word)], face_normal(surface_face(word)));
    uint reaching = 0u;
    for (uint i = 0u; i < count; ++i)
      if (light_received(lights[light_index(list, i)], pixel_ray(pixel) * z, normal) != vec3(0.0)) ++reaching;
    count = reaching;
  }
  imageStore(picture, ivec2(pixel), vec4(heat(count), 1.0));
}
