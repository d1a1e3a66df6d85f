// What a pixel's surface is, from the G-buffer word and depth.
// Needs before the include: `frame`, `island_at()`, `materials[]`, and `block_textures` (sampler2DArray, repeat, trilinear) or SKERRY_UNTEXTURED.
#ifndef SKERRY_SURFACE_GLSL
#define SKERRY_SURFACE_GLSL
#include "shared/bindings.h"
#include "shared/constants.h"

#include "include/scene/coverage.glsl"
#ifdef SKERRY_STORED
#include "include/scene/stored.glsl"
layout(constant_id = kNormalCodeConstant) const uint kNormalCode = 0u;
layout(constant_id = kPositionStoredConstant) const bool kPositionStored = false;
// Where one of them is not kept, some image is bound that is never read.
layout(binding = kStoredNormalsBinding) uniform sampler2D stored_normals;
layout(binding = kStoredPositionsBinding) uniform sampler2D stored_positions;
#endif

// Of a plant: position in its voxel's cube, 0..1. Rounding at its foot must not take it for the voxel below.
vec3 place_in_voxel(vec3 lattice) { return clamp(lattice - floor(lattice + vec3(0.0, 0.001, 0.0)), 0.0, 1.0); }

#ifndef SKERRY_UNTEXTURED
#include "include/scene/face_layer.glsl"

// Texture coordinates of a lattice point on a face [blocks], v downwards.
vec2 face_uv(uint face, vec3 lattice) {
  return face >= 6u ? vec2(lattice.x, -lattice.y)
                    : face < 2u ? vec2(lattice.z, -lattice.y) : face < 4u ? lattice.xz : vec2(lattice.x, -lattice.y);
}

// Sharp texels with smooth edges: inside a texel the coordinate stays at its centre, over one pixel at its border it crosses over.
vec2 crisp_uv(vec2 uv, vec2 texels_per_pixel) {
  vec2 t = uv * kTextureEdge;
  vec2 border = floor(t + 0.5);
  return (border + clamp((t - border) / max(texels_per_pixel, 1e-6), -0.5, 0.5)) / kTextureEdge;
}

struct PlaneView {  // how a pixel sees a plane, in its island's lattice
  vec3 ray, right, up;  // the pixel's ray, and what is added to it for the pixels beside and above
  vec3 normal;
  float t;  // blocks along the view axis
};

// What a pixel covers of a texture: along its long side it is covered by some samples.
struct Footprint {
  vec2 major;  // along the long side [blocks]
  float taps;
  float lod;
  vec2 texels;  // that the pixel is wide and high
};

// @param dx, dy texture coordinates to the pixels beside and above [blocks].
Footprint footprint_of(vec2 dx, vec2 dy, uint max_taps) {
  float x2 = dot(dx, dx), y2 = dot(dy, dy);
  float major_texels = sqrt(max(x2, y2)) * kTextureEdge;
  float minor_texels = max(abs(dx.x * dy.y - dx.y * dy.x) * kTextureEdge * kTextureEdge / max(major_texels, 1e-6), 1e-6);
  float taps = clamp(ceil(major_texels / max(minor_texels, 1.0)), 1.0, float(max_taps));
  float lod = log2(max(max(minor_texels, major_texels / taps), 1e-6));
  return Footprint(x2 > y2 ? dx : dy, taps, lod, max(abs(dx) + abs(dy), 1e-7) * kTextureEdge);
}

vec4 footprint_texel(uint layer, vec2 uv, Footprint f) {
  uv = crisp_uv(uv, f.texels);
  vec4 sum = vec4(0.0);
  for (float i = 0.0; i < f.taps; ++i)
    sum += textureLod(block_textures, vec3(uv + f.major * ((i + 0.5) / f.taps - 0.5), float(layer)), f.lod);
  return sum / f.taps;
}

// Block texture at a point of a plane. The footprint is worked out from neighbouring rays, since compute has no derivatives.
vec4 plane_texel(uint layer, uint face, vec2 uv, PlaneView view, uint max_taps) {
  float facing = dot(view.normal, view.ray);
  facing = abs(facing) < 1e-6 ? 1e-6 : facing;
  // d(ray * t) along one pixel while staying on the plane.
  vec3 dx = view.t * (view.right - view.ray * (dot(view.normal, view.right) / facing));
  vec3 dy = view.t * (view.up - view.ray * (dot(view.normal, view.up) / facing));
  return footprint_texel(layer, uv, footprint_of(face_uv(face, dx), face_uv(face, dy), max_taps));
}

// Texture of the surface a word names, where the ray meets it `t` blocks along the view axis.
vec4 surface_texel(uint word, vec3 ray, float t, uint max_taps) {
  uint face = surface_face(word);
  IslandTransform island = island_at(surface_island(word));
  vec3 normal = face >= 6u ? vec3(0.70710678, 0.0, face == 6u ? -0.70710678 : 0.70710678) : face_normal(face);
  vec3 right = lattice_from_world_vector(island, frame.ray_right) * frame.pixel_to_ndc.x;
  vec3 up = lattice_from_world_vector(island, frame.ray_up) * frame.pixel_to_ndc.y;
  vec3 lattice = lattice_from_world(island, ray * t);
  vec2 uv = face >= 6u ? plant_uv(face_uv(face, place_in_voxel(lattice))) : face_uv(face, lattice);
  return plane_texel(face_layer(face, surface_block(word)), face, uv, PlaneView(lattice_from_world_vector(island, ray), right, up, normal, t), max_taps);
}

#endif

// Radiance that a surface emits, over its albedo.
float emission_of(uint word, vec3 albedo) {
  vec2 emission = unpackHalf2x16(materials[surface_block(word)].emission);
  float brightest = max(max(albedo.r, albedo.g), albedo.b);
  return emission.x * clamp(1.0 + (brightest - emission.y) / kGlowRise, 0.0, 1.0);
}

// Whether that depends on the albedo.
bool emits_in_part(uint word) { return unpackHalf2x16(materials[surface_block(word)].emission).y > 0.0; }

// Without its albedo and what comes of that. @param pixel where the word is from. @param depth of the surface, greater than 0.
Surface surface_without_texture(uint word, ivec2 pixel, float depth, vec3 ray) {
  float t = view_distance(depth, frame.near_plane);
  Surface s;
  s.position = ray * t;
#ifdef SKERRY_STORED
  if (kPositionStored && word != 0u) s.position = texelFetch(stored_positions, pixel, 0).xyz;
#endif
  IslandTransform island = island_at(surface_island(word));
  s.normal = world_from_lattice_vector(island, face_normal(surface_face(word)));
#ifdef SKERRY_STORED
  if (kNormalCode != kNormalExact && word != 0u) s.normal = normal_from_texel(texelFetch(stored_normals, pixel, 0), kNormalCode);
#endif
  s.plant = surface_face(word) >= 6u;
  s.in_voxel = place_in_voxel(lattice_from_world(island, s.position));
  s.axis_x = island.axis_x;
  s.axis_y = island.axis_y;
  s.axis_z = island.axis_z;
  s.ao = 1.0;
  s.albedo = vec3(0.0);
  s.emitted = vec3(0.0);
  s.roughness = materials[surface_block(word)].roughness;
  s.metalness = materials[surface_block(word)].metalness;
  return s;
}

#ifndef SKERRY_UNTEXTURED
// @param pixel where the word is from. @param depth of the surface, greater than 0.
Surface resolve_surface(uint word, ivec2 pixel, float depth, vec3 ray, uint max_taps) {
  Surface s = surface_without_texture(word, pixel, depth, ray);
  float t = view_distance(depth, frame.near_plane);
#ifdef SKERRY_STORED
  if (kPositionStored && word != 0u) t = dot(s.position, frame.ray_forward);
#endif
  s.albedo = surface_texel(word, ray, t, max_taps).rgb;
  s.emitted = s.albedo * emission_of(word, s.albedo);
  return s;
}
#endif
#endif
