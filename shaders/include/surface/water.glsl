// Water, glass and what is seen through them. Needs what shade_translucent.glsl declares.
#ifndef SKERRY_WATER_GLSL
#define SKERRY_WATER_GLSL
#include "shared/constants.h"
#include "include/surface/haze.glsl"
#include "include/surface/media.glsl"
#include "include/surface/mirror.glsl"
#include "include/surface/foam.glsl"

// Lobe of waves, whose slopes end where GGX's do not: of slopes s by exp(-(s / alpha)^4). Else as mirror_lobe(). The first number: pi^-1.5 / 2.
float wave_lobe(float alpha, vec3 normal, vec3 half_way, float n_dot_l, float n_dot_v) {
  float alpha2 = alpha * alpha, n_dot_h = max(dot(normal, half_way), 1e-3), cos2 = n_dot_h * n_dot_h, k = 0.5 * alpha;
  vec3 across = cross(normal, half_way);
  float slope2 = dot(across, across) / (cos2 * alpha2);
  float shadowing = (n_dot_l * (1.0 - k) + k) * (n_dot_v * (1.0 - k) + k);
  return 0.0897936 * exp(-slope2 * slope2) / (alpha2 * cos2 * cos2 * shadowing);
}

// Light mirrored by a wavy surface, by the waves too small to draw. @param irradiance of a surface that faces the light.
vec3 glitter(vec3 irradiance, vec3 to_light, vec3 n, vec3 to_eye, Gloss gloss) {
  vec3 sum = to_light + to_eye;
  vec3 h = sum * inversesqrt(max(dot(sum, sum), 1e-12));
  float n_dot_l = max(dot(n, to_light), 0.0);
  float n_dot_v = max(dot(n, to_eye), 1e-3);
  float lobe = mix(mirror_lobe(gloss.alpha, n, h, n_dot_l, n_dot_v), wave_lobe(gloss.alpha, n, h, n_dot_l, n_dot_v), gloss.waves);
  return irradiance * (lobe * fresnel(max(dot(h, to_eye), 0.0), false, kWaterIndex) * n_dot_l);
}

struct Reach {   // what lights bring to a point of a surface
  vec3 light;    // irradiance on a level surface
  vec3 mirrored; // towards the eye
  float any;     // largest visibility of sun and moon: all that is known of the sky's where it lights nothing
};

struct LitPoint {       // a point of a surface, or in the open
  vec3 p, n;            // place relative to the camera, normal of the face
  vec3 shading_normal;  // with ripples
  vec3 to_eye;
  Gloss gloss;
  uint word;            // of the surface; 0 in the open
  Depth depth;          // under water and behind glass
};

// Of a layer, or of the medium before the eye: the light that glass lets through to it.
Depth behind_glass(Depth depth, uint k, uvec2 pixel) {
  if (kGlass) depth.through_glass = unpacked_share(share_of_layer(k, ivec2(pixel)));
  return depth;
}

void add_light(inout Reach r, const uint index, const uint first_cascade, LitPoint at) {
  Body body = frame.bodies[index];
  BodyWay way = body_way(at.depth, body.to_light);
  float n_dot_l = dot(at.n, way.to_light), cosine = dot(at.n, body.to_light);
  float visibility = cosine > 0.0 ? body_visibility(first_cascade, near_surface(at.depth, at.p, way.to_light), at.n, cosine) : 0.0;
  vec3 irradiance = body.irradiance * way.share * (visibility * light_through_clouds(index, at.p));
  if (kGlass && index == frame.glass_body) irradiance *= at.depth.through_glass;
  r.light += irradiance * max(n_dot_l, 0.0);
  r.mirrored += glitter(irradiance, way.to_light, at.shading_normal, at.to_eye, at.gloss);
  r.any = max(r.any, visibility);
}

layout(constant_id = kBentConstant) const uint kBent = kBentIntoWater;  // how bend_rays.comp has been over the radiance
layout(constant_id = kLitConstant) const bool kLit = false;  // lamps are; if not, their lists are not read

// Walls are looked for before every light.
WayStart layer_start(LitPoint at) {
  if (at.word == 0u) return WayStart(at.p, at.n, ~0u, ivec3(0), vec3(0.0));
  Surface s;
  s.position = at.p;
  s.normal = at.n;
  s.plant = false;
  return way_start(s, at.word);
}

void add_lights(inout Reach r, uvec2 pixel, float z, LitPoint at) {
  Cluster list = lights_at(pixel, z);
  WayStart start = layer_start(at);
  vec3 mirror = reflect(-at.to_eye, at.shading_normal);
  for (uint i = 0u; i < list.count;) {
    Light light = frame_light(light_index(list, i));
    Arrival a = arrive(light, at.p, at.n, mirror, at.gloss.alpha);
    vec3 arrives = a.facing > 0.0 ? light.intensity * left_by_panes(light, at.p) : vec3(0.0);
    if (kLightsShadows != 0u && a.facing > 0.0) arrives *= traced_visibility(start, light);
    r.light += arrives * a.facing;
    r.mirrored += glitter(arrives * a.mirrored, a.to_mirrored, at.shading_normal, at.to_eye, at.gloss);
    if (++i == list.count) break;
  }
}

// Of sun, moon and lamps. @param z of the point along the view axis, as the depth of the pixel says.
Reach light_at(uvec2 pixel, float z, LitPoint at) {
  Reach r = Reach(vec3(0.0), vec3(0.0), 0.0);
  if ((kBodies & 1u) != 0u) add_light(r, 0u, 0u, at);
  if ((kBodies & 2u) != 0u) add_light(r, 1u, kMoonCascade, at);
  if (kLit) add_lights(r, pixel, z, at);
  return r;
}

FaceSky sky_about(vec3 p, uint word) {
  if (kIndirect == kIndirectOff) return FaceSky(vec3(0.0), vec3(0.0), vec3(0.0), vec4(0.0), vec4(0.0), vec3(1.0), false);
  return sky_of_face(p, word);
}

// A surface of a pixel.
struct Layer {
  uint k, word;  // word 0: there is none
  float t;       // of the surface along the view axis
  vec3 n;        // its normal
};

Layer layer_at(uint k, uvec2 pixel) {
  uint word = k < kWaterLayers ? layer_surface(k, ivec2(pixel)) : 0u;
  float t = view_distance(word != 0u ? layer_depth(k, ivec2(pixel)) : 1.0, frame.near_plane);
  return Layer(k, word, t, world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word))));
}

// What the nearest surface of a pixel mirrors of the world. Once a pixel: a march for each layer would cost as much again.
// @param outwards the ray to follow instead: what looks_out() gives. 0: none. @param shown of bend_rays.comp, which may have found it in the picture.
Mirrored mirrored_by_nearest(uvec2 pixel, vec3 ray, vec3 to_eye, vec3 outwards, vec4 shown) {
  Layer first = layer_at(0u, pixel);
  uint word = first.word;
  float t = first.t;
  vec3 n = first.n;
  vec3 dir = mirrored_ray(to_eye, shading_normal(word, ray, t), n);
  LitPoint at = LitPoint(ray * t, n, n, to_eye, Gloss(1.0, 0.0), word, no_depth());
  if (kBent == kBentIntoAir && outwards != vec3(0.0)) {
    dir = outwards;
    at.n = -n;
    at.word = word ^ kOppositeFace;
  }
  bool found = kBent == kBentIntoAir && shown.w < 0.0;
  Mirrored met = mirrored_voxels(layer_start(at), at.p, dir, word != 0u && !found);
  return found ? Mirrored(shown.rgb, -shown.w, false) : met;
}

// What a surface mirrors, seen from outside. @param nearest what it mirrors of the world, if that is known.
vec3 mirrored_outside(LitPoint at, vec3 mirror, FaceSky around, float lit, bool known, Mirrored nearest, bool clouds, uvec2 pixel) {
  vec3 sky = sample_sky(sky_lut, mirror, frame.sky_horizon, frame.sky_yaw);
  if (clouds) sky = past_mirrored_clouds(mirrored_clouds, sky, pixel);
  vec3 about = mirrored_about(around, at.word, mirror, sky, lit);
  return !known ? about : nearest.sky ? sky : nearest.radiance;
}

// What an eye in water sees through its level surface where the picture does not show it. @param dir the bent ray in the air. @param met by it.
vec3 seen_above(vec3 dir, Mirrored met, bool clouds, uvec2 pixel) {
  vec3 sky = sample_sky(sky_lut, dir, frame.sky_horizon, frame.sky_yaw);
  if (clouds) sky = past_mirrored_clouds(mirrored_clouds, sky, pixel);
  if (kMirrorWorld) return met.sky ? sky : met.radiance;
  return mirrored_about(sky_about(frame.medium_surface_place, frame.medium_surface), frame.medium_surface, dir, sky, 1.0);
}

// The ray in the air, bent by the nearest surface, if that is of the water about the eye and the picture does not show what the ray meets; else 0.
// Behind a second surface things are seen straight, and where nothing is known of what hides the sky, as in a sealed room.
// @param way of bend_rays.comp: 0 where the picture shows nothing.
vec3 looks_out(uvec2 pixel, vec3 ray, float way) {
  if (kBent != kBentIntoAir || !(kMirrorWorld || (kIndirect != kIndirectOff && frame.medium_surface != 0u))) return vec3(0.0);
  Layer first = layer_at(0u, pixel);
  uint word = first.word;
  float t = first.t;
  vec3 n = first.n;
  vec3 bent = bent_into_air(normalize(ray), shading_normal(word, ray, t), n);
  const uint next = min(kWaterLayers - 1u, 1u);
  uint second = layer_surface(next, ivec2(pixel));
  float far = view_distance(max(layer_depth(next, ivec2(pixel)), 1e-12), frame.near_plane);
  bool alone = second == 0u || are_one_surface(second, word, n, ray, pixel_ray(pixel + 1u), t, far);
  bool out_of_water = word != 0u && has_ripples(word) && surface_block(word) == frame.camera_medium;
  return out_of_water && way == 0.0 && alone ? bent : vec3(0.0);
}

// The same from inside a medium: as deep as it goes, or up to what it mirrors of the world.
vec3 mirrored_inside(Material m, vec3 light_in, bool known, Mirrored nearest) {
  bool met = known && !nearest.sky;
  float way = met ? nearest.distance : 1e3;
  return scattered(m, light_in, way) + (met ? exp(-extinction(m) * way) * nearest.radiance : vec3(0.0));
}

// The first from layer k on that is not the same surface as the one before it, of a word at t.
Layer next_layer(uint k, uvec2 pixel, vec3 ray, uint before, float t) {
  Layer next = layer_at(k, pixel);
  while (next.word != 0u && are_one_surface(next.word, before, next.n, ray, pixel_ray(pixel + 1u), t, next.t)) next = layer_at(next.k + 1u, pixel);
  return next;
}

// @param behind radiance of what is opaque there, or what bend_rays.comp found; w: how far it lies from the water's surface by that ray [blocks], or 0.
vec3 look_through(uvec2 pixel, vec3 ray, vec4 behind) {
  float ray_length = length(ray);
  vec3 to_eye = -ray / ray_length;
  float opaque = texelFetch(depths, ivec2(pixel), 0).r;
  vec3 colour = vec3(0.0), through = vec3(1.0), light_in = vec3(0.0), sky_mirrored = vec3(0.0);
  vec3 sky_light = vec3(0.0);  // irradiance of the sky and what is about, where the medium was entered: faces seen from inside have none of their own
  uint medium = frame.camera_medium;
  float at = 0.0;  // blocks along the ray
  if (medium != 0u) {
    const vec3 up = vec3(0.0, 1.0, 0.0);
    Depth depth = behind_glass(depth_in_medium(ray / ray_length * 0.5), kWaterLayers, pixel);
    light_in = light_at(pixel, 0.5 / ray_length, LitPoint(ray / ray_length * 0.5, up, up, to_eye, Gloss(0.01, 0.0), 0u, depth)).light;
    if (frame.medium_surface != 0u) sky_light = frame.medium_light * sky_about(frame.medium_surface_place, frame.medium_surface).irradiance;
    light_in += sky_light * sky_share(depth);
  }
  Mirrored nearest = Mirrored(vec3(0.0), 0.0, true);
  vec3 bent = looks_out(pixel, ray, behind.w);
  bool outwards = bent != vec3(0.0);
  if (kMirrorWorld) nearest = mirrored_by_nearest(pixel, ray, to_eye, bent, behind);
  // What has been seen so far through the air before it; of the last surface how clear that air is, what it sends, and what is let through to it.
  vec3 seen = vec3(0.0), air = vec3(0.0), entered = vec3(1.0);
  float clear = 1.0;
  Layer layer = layer_at(0u, pixel);
  while (layer.word != 0u) {
    uint k = layer.k, word = layer.word;
    float t = layer.t;
    float next = t * ray_length;
    vec3 n = layer.n;
    if (medium != 0u) {
      Material m = materials[medium];
      colour += through * scattered(m, light_in, next - at);
      through *= exp(-extinction(m) * (next - at));
    }
    seen += colour * clear + (entered - through) * air;
    colour = vec3(0.0);
    entered = through;
    uint block = surface_block(word);
    bool entering = medium != block;
    Material m = materials[block];
    bool wavy = has_ripples(word);
    vec3 shading = shading_normal(word, ray, t);
    float cosine = clamp(dot(shading, to_eye), 0.02, 1.0);
    float reflected = fresnel(cosine, !entering, kWaterIndex);
    vec3 mirror = mirrored_ray(to_eye, shading, n);
    LitPoint point = LitPoint(ray * t, n, shading, to_eye, gloss_of(word, ray, t), word, behind_glass(no_depth(), k, pixel));
    Reach reach = light_at(pixel, t, point);
    FaceSky around = sky_about(point.p, word);
    if (frame.camera_medium == 0u) {
      clear = clear_air(point.p);
      air = seen_through_air(vec3(0.0), point.p, open_share(around, surface_face(word)));
    }
    if (entering) sky_light = around.irradiance;
    reach.light += sky_light;
    bool known = kMirrorWorld && k == 0u;
    vec3 outside = mirrored_outside(point, mirror, around, reach.any, known, nearest, kMirroredClouds && k == 0u, pixel);
    vec3 mirrored_sky = entering ? outside : mirrored_inside(m, light_in, known && wavy && !outwards, nearest);
    if (entering) sky_mirrored = mirrored_sky;
    float foam = foam_cover(word, ray, t);
    colour += through * (foam * kFoamAlbedo * kInvPi) * reach.light;
    through *= 1.0 - foam;
    colour += through * (reach.mirrored + reflected * mirrored_sky);
    through *= 1.0 - reflected;
    // Radiance goes with the square of the index: in water a cone holds what comes from the air's half space. Glass is as thin as if it had none.
    bool from_water = materials[medium].liquid != 0u, into_water = entering && m.liquid != 0u;
    if (from_water != into_water) through *= into_water ? 1.0 / (kWaterIndex * kWaterIndex) : kWaterIndex * kWaterIndex;
    // What the texture covers (the frame of a pane) is a diffuse surface.
    for (int once = wavy ? 0 : 1; once > 0; --once) {
      vec4 texel = surface_texel(word, ray, t, 1u);
      colour += through * texel.a * texel.rgb * kInvPi * reach.light;
      through *= 1.0 - texel.a;
    }
    light_in = reach.light;
    medium = entering ? block : 0u;
    at = next;
    layer = next_layer(k + 1u, pixel, ray, word, t);
    if (layer.word == 0u) break;  // here, since a CPU driver runs a round to its end where no pixel takes part: docs/lavapipe.md
  }
  if (outwards) behind.rgb = seen_above(bent, nearest, kMirroredClouds, pixel);
  float end = kBent == kBentIntoWater && behind.w > 0.0 ? at + behind.w : end_of_media(opaque, at, ray_length);
  bool tail = kTail && layer_surface(kWaterLayers - 1u, ivec2(pixel)) != 0u;
  if (tail) {
    vec4 depths_behind = texelFetch(tail_depths, ivec2(pixel), 0), light_behind = texelFetch(tail_light, ivec2(pixel), 0);
    vec3 in_media = depths_behind.rgb;
    vec3 sent_on = light_behind.rgb;
    if (medium != 0u) {
      in_media += extinction(materials[medium]) * max(end - at, 0.0);
      sent_on += 0.25 * materials[medium].scattering * max(end - at, 0.0);
    }
    in_media = max(in_media, 0.0);
    vec3 sent = max(sent_on, 0.0) * (kInvPi * light_in) + light_behind.a * sky_mirrored;
    vec3 depth = in_media + depths_behind.a;
    colour += through * sent * mean_transmittance(depth);
    through *= exp(-depth);
  } else if (medium != 0u) {
    Material m = materials[medium];
    colour += through * scattered(m, light_in, max(end - at, 0.0));
    through *= exp(-extinction(m) * max(end - at, 0.0));
  }
  // What lies behind has been seen through the air up to there. Of the air before each surface it has as much as all surfaces let through: where
  // they stop more, the nearer air is seen nevertheless, as far as what stands before it lets it through.
  return seen + colour * clear + (entered - through) * air + through * behind.rgb;
}
#endif
