#version 460
#extension GL_GOOGLE_include_directive : require
// One channel of the G-buffer, one term of the light or what clusters hold, in place of the lit scene. docs/conventions.md.
#define SKERRY_STORED
#include "include/frame/common.glsl"
#include "shared/exposure.h"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kPictureBinding, rgba8) writeonly uniform image2D picture;
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;

layout(scalar, binding = kExposureBinding) uniform Chosen { Exposure exposure; };

layout(constant_id = kChannelConstant) const uint kChannel = 1u;  // render::DebugView

#include "include/surface/surface.glsl"
#include "include/sky/sky.glsl"
#include "include/light/visibility.glsl"
#include "include/light/corners.glsl"
#include "include/post/tonemap.glsl"
#include "include/light/clustered.glsl"

layout(constant_id = kLitConstant) const bool kLit = false;  // clusters are shown, and there are some
const uint kClustersChannel = 10u, kLightCountChannel = 11u;

vec3 hashed_colour(uint id) {
  uint h = id * 0x9e3779b1u;
  h ^= h >> 15;
  h *= 0x85ebca77u;
  return vec3((h >> 8) & 255u, (h >> 16) & 255u, h >> 24) / 255.0;
}

uint cascade_at(Body body, float distance) {
  uint c = body.first_cascade;
  while (c < body.first_cascade + body.cascade_count && distance > frame.cascades[c].radius) ++c;
  return c;
}

// 0 black, then blue over green and yellow to red: each step of the scale doubles the count, up to 256 and more.
vec3 heat(uint count) {
  float h = log2(float(count) + 1.0) / 8.0;
  vec3 warm = clamp(vec3(4.0 * h - 2.0, 2.0 - abs(4.0 * h - 2.0), 2.0 - 4.0 * h), 0.0, 1.0);
  return count == 0u ? vec3(0.0) : mix(vec3(0.0, 0.0, 0.4), warm, min(4.0 * h, 1.0));
}

// How many lights the pixel's list has; or how many of them light it.
vec3 light_count(uint word, uvec2 pixel, float depth) {
  bool here = word != 0u && depth > 0.0;
  float z = view_distance(here ? depth : 1.0, frame.near_plane);
  Cluster list = lights_at(pixel, z);
  uint count = here ? list.count : 0u;
  if (kChannel == kLightCountChannel) {
    vec3 normal = world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word)));
    uint reaching = 0u;
    for (uint i = 0u; i < count; ++i)
      if (light_received(frame_light(light_index(list, i)), pixel_ray(pixel) * z, normal) != vec3(0.0)) ++reaching;
    count = reaching;
  }
  return heat(count);
}

vec3 channel(uint word, ivec2 pixel, float depth, vec3 ray) {
  Surface s = resolve_surface(word, pixel, depth, ray, 1u);
  if (kChannel == 1u) return srgb_encode(s.albedo);
  if (kChannel == 2u) return s.normal * 0.5 + 0.5;
  // Position in its island's lattice: red, green, blue repeat every block along x, y, z.
  if (kChannel == 3u) return fract(lattice_from_world(island_at(surface_island(word)), s.position));
  if (kChannel == 4u) return hashed_colour(surface_block(word) | (surface_island(word) << 16));
  if (kChannel == 5u) return srgb_encode(tone_map(s.emitted * exp2(-exposure.ev)));
  if (kChannel == 6u) return vec3(fract(log2(view_distance(depth, frame.near_plane))));
  if (kChannel == 9u) return vec3(surface_ao(s, word));
  if (kChannel >= kClustersChannel) return vec3(0.0);  // lights, of which there are none
  Body body = frame.bodies[(kBodies & 1u) != 0u ? 0 : 1];
  if (kChannel == 7u) return hashed_colour(cascade_at(body, length(s.position)) + 3u) * 0.6 + 0.4 * s.albedo;
  float n_dot_l = dot(s.normal, body.to_light);
  return vec3(n_dot_l > 0.0 && body.cascade_count != 0u ? surface_visibility(s, body.to_light, 0u, n_dot_l) : 0.0);
}

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.size))) return;
  float depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, depth);
  vec3 colour = vec3(0.0);
  if (kLit && kChannel >= kClustersChannel)
    colour = light_count(word, pixel, depth);
  else if (word != 0u)
    colour = channel(word, ivec2(pixel), surface_depth(depth), pixel_ray(pixel));
  imageStore(picture, ivec2(pixel), vec4(floor(clamp(colour, 0.0, 1.0) * 255.0 + 0.5) / 255.0, 1.0));
}
