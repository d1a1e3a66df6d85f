// Helpers every pass shares. Conventions: docs/conventions.md.
#ifndef SKERRY_COMMON_GLSL
#define SKERRY_COMMON_GLSL
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"
#include "shared/geometry.h"
#include "include/frame/halves.glsl"

// Unit normal of a face in the lattice; a plant's diagonals stand for a surface that faces up.
vec3 face_normal(uint face) {
  if (face >= 6u) return vec3(0.0, 1.0, 0.0);
  float s = (face & 1u) == 0u ? 1.0 : -1.0;
  uint axis = face >> 1;
  return vec3(axis == 0u ? s : 0.0, axis == 1u ? s : 0.0, axis == 2u ? s : 0.0);
}

const float kTextureEdge = 32.0;  // texels a block

// A plant's texture does not repeat: its top must not show below its foot. @param uv u 0..1, v -1..0.
vec2 plant_uv(vec2 uv) { return clamp(uv, vec2(0.0, -1.0) + 0.5 / kTextureEdge, vec2(1.0, 0.0) - 0.5 / kTextureEdge); }

vec3 world_from_lattice_vector(IslandTransform t, vec3 v) { return t.axis_x * v.x + t.axis_y * v.y + t.axis_z * v.z; }
vec3 world_from_lattice(IslandTransform t, vec3 p) { return world_from_lattice_vector(t, p) + t.translation; }
vec3 lattice_from_world_vector(IslandTransform t, vec3 v) { return vec3(dot(t.axis_x, v), dot(t.axis_y, v), dot(t.axis_z, v)); }
vec3 lattice_from_world(IslandTransform t, vec3 p) { return lattice_from_world_vector(t, p - t.translation); }

// The surface at a pixel.
struct Surface {
  vec3 position;  // world
  vec3 normal;    // world, unit, exact: it comes from the island's axes
  bool plant;     // lit as if it were level, but it stands upright
  vec3 albedo;    // linear
  vec3 emitted;   // radiance
  float roughness;  // perceptual
  float metalness;
  vec3 in_voxel;  // of a plant: position in its voxel's cube, 0..1
  vec3 axis_x;    // island axes in the world
  vec3 axis_y;
  vec3 axis_z;
  float ao;  // share of light that the corners of its face leave to it, 0..1
};

// Whether a pixel lies in an area, from xy to before zw.
bool in_area(uvec2 pixel, uvec4 area) { return all(greaterThanEqual(pixel, area.xy)) && all(lessThan(pixel, area.zw)); }

// Ray through the place of a pixel that is sampled, scaled to one block along the view axis.
#define pixel_ray(pixel) \
  (frame.ray_forward + frame.ray_right * ((float((pixel).x) + frame.sample_in_pixel.x) * frame.pixel_to_ndc.x - 1.0) - \
   frame.ray_up * ((float((pixel).y) + frame.sample_in_pixel.y) * frame.pixel_to_ndc.y - 1.0))

// Where the picture shows a place [pixels], by the inverse of pixel_ray() for the pixels' corners. @param z its distance along the view axis.
#define pixel_place(place, z) \
  ((vec2(dot(place, frame.ray_right) / dot(frame.ray_right, frame.ray_right), -dot(place, frame.ray_up) / dot(frame.ray_up, frame.ray_up)) / \
    max(z, 1e-3) + 1.0) / frame.pixel_to_ndc)

// Distance along the view axis from reverse-Z infinite depth. @pre depth > 0.
float view_distance(float depth, float near_plane) { return near_plane / depth; }

// RGBA16F's largest finite value; what leaves a pass is clamped to it.
const float kMaxRadiance = 65504.0;
bool finite3(vec3 c) { return !(any(isnan(c)) || any(isinf(c))); }
vec3 sanitised(vec3 c) { return finite3(c) ? clamp(c, vec3(0.0), vec3(kMaxRadiance)) : vec3(0.0); }

#endif
