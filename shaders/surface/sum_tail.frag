#version 460
#extension GL_GOOGLE_include_directive : require
// Translucent surfaces behind the last peeled layer, added up in any order (the tail of Maule et al., Hybrid Transparency, 2013): optical
// depth of media and of surfaces, which add up exactly, and the light that surfaces send, to be spread evenly over that depth. docs/decisions/0054.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(location = 0) flat in uint in_surface;
layout(location = 1) in vec2 in_touched;  // x: see draw_quads.vert
layout(location = 0) out vec4 out_depths;  // rgb: in media from here to the ray's end, negative where one ends; a: of this surface
layout(location = 1) out vec4 out_light;   // rgb: share of the irradiance that it and media send on, times pi; a: share of the sky that it mirrors

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kDepthsBinding) uniform sampler2D opaque_depth;
layout(binding = kPreviousDepthsBinding) uniform sampler2D last_depth;  // of the last layer
layout(binding = kLayerSurfacesBinding) uniform usampler2DArray layer_surfaces;

layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 3u;

#include "include/surface/surface.glsl"
#include "include/surface/ripples.glsl"
#include "include/surface/touched.glsl"
#include "include/surface/media.glsl"

const float kLeastTransmittance = 1e-7;  // of a surface: behind a closed one nothing is seen, and its optical depth stays finite

void main() {
  uint touched = touched_number(in_touched.x);
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float z = gl_FragCoord.z, last = texelFetch(last_depth, pixel, 0).r, opaque = texelFetch(opaque_depth, pixel, 0).r;
  bool entering = gl_FrontFacing;
  uint word = entering ? in_surface : in_surface ^ kOppositeFace;
  // The last layer's surface once more, where two of its quads overlap (draw_quads.vert).
  bool again = z >= last - fwidth(z) / 32.0 - z * 1e-6 && word == texelFetch(layer_surfaces, ivec3(pixel, kWaterLayers - 1u), 0).r;
  if (z >= last || z <= opaque || (!entering && touched != 0u) || again) discard;

  vec3 ray = pixel_ray(pixel);
  float ray_length = length(ray), t = view_distance(z, frame.near_plane);
  float at = view_distance(last, frame.near_plane) * ray_length;
  float to_end = end_of_media(opaque, at, ray_length) - t * ray_length;
  Material m = materials[surface_block(word)];
  float begun = entering ? to_end : -to_end;
  vec3 in_media = extinction(m) * begun;
  float scattered_in_media = m.scattering * begun;
  bool into_water = entering && m.liquid != 0u, from_water = !entering && m.liquid != 0u;
  if (touched != 0u) {
    Material left = materials[materials[touched].translucent_block];
    from_water = left.liquid != 0u;
    in_media -= extinction(left) * to_end;
    scattered_in_media -= left.scattering * to_end;
  }

  float cosine = clamp(dot(shading_normal(word, ray, t), -ray / ray_length), 0.02, 1.0);
  float reflected = fresnel(cosine, !entering, kWaterIndex);
  vec4 texel = has_ripples(word) ? vec4(0.0) : surface_texel(word, ray, t, 1u);
  float covered = (1.0 - reflected) * texel.a, taken = reflected + covered;
  float depth = -log(max(1.0 - taken, kLeastTransmittance)), by_depth = depth / taken;
  // From inside, the medium itself is what is mirrored.
  vec3 sent = covered * texel.rgb + (entering ? vec3(0.0) : 0.25 * reflected * m.scattering / max(extinction(m), 1e-6));
  // The square of the index, as look_through() has it.
  const float squared = 2.0 * log(kWaterIndex);
  out_depths = vec4(in_media, depth + squared * (float(into_water) - float(from_water)));
  out_light = by_depth * vec4(sent, entering ? reflected : 0.0) + vec4(vec3(0.25 * scattered_in_media), 0.0);
}
