// The march of a ray through all clouds, front to back; analytic within a step, so that no step length loses or makes light (Hillaire,
// Physically Based Sky, Atmosphere and Cloud Rendering in Frostbite, 2016). Needs before the include: `frame`, `sky_lut`, what
// cloud_light.glsl, cloud_layer.glsl, cloud_volumes.glsl and visibility.glsl have; with SKERRY_LIGHTS what clustered.glsl and traced.glsl have.
#ifndef SKERRY_CLOUD_MARCH_GLSL
#define SKERRY_CLOUD_MARCH_GLSL
#include "shared/constants.h"
#include "include/sky/cloud_scattering.glsl"

// What a ray through clouds brings.
struct Clouded {
  vec3 light;   // radiance of the clouds
  float clear;  // share of what is behind them that is left
};

const float kHidden = 5e-4;       // of a view: what lies behind so much cloud is not seen...
const float kDiscHidden = 1e-7;   // ...nor so much of the sun's disc
const float kDiscCosine = 0.999;  // of the angle to a disc's middle within which pixels may blend with it
const uint kParts = 4u;           // of a step: density is looked at in each, light once
const float kNearestToFog = 0.3;  // of a light: nearer it makes fog no brighter [blocks]
// More than any march takes.
const uint kMostIterations = 16384u;
const float kLayerStepGrowth = 100.0;  // blocks: the layer's steps are even up to here, then grow with the distance

// Light of a body that islands leave to a place in the open. Past the last map nothing stands in its way.
float past_islands(const uint first_cascade, vec3 p) {
  if (!kShadows) return 1.0;
  uint index = cascades_within(first_cascade, kCascades, length(p));
  Cascade c = pick_cascade(first_cascade, min(index, kCascades - 1u));
  return index >= kCascades ? 1.0 : air_tap(c, p);
}

// Where a ray is inside the layer; x > y: nowhere.
vec2 layer_range(vec3 origin, vec3 dir, float begin, float end) {
  float rise = abs(dir.y) < 1e-6 ? 1e-6 : dir.y, height = clouds.layer.place.y + origin.y;
  float a = -height / rise, b = (clouds.layer.thickness - height) / rise;
  return vec2(max(min(a, b), begin), min(min(max(a, b), end), kLayerFadeEnd));
}

// Everything there is at a place.
struct Medium {
  float extinction;  // 1/block
  vec3 emitted;      // radiance a block
  float empty;       // so far along the ray there is nothing for certain [blocks]
};

void add_volume(const uint v, vec3 p, vec3 dir, inout Medium m) {
  vec3 at = index_from_world(v, p);
  vec3 cell = cell_of_index(v, at);
  vec4 found = cell_at(v, ivec3(cell), 0);
  if (found.a > 0.0) {
    float value = volume_value(v, at, found, cell);
    m.extinction += value * clouds.volumes[v].extinction;
    m.emitted += value * clouds.volumes[v].emission;
    m.empty = 0.0;
  } else {
    m.empty = min(m.empty, empty_way(v, at, index_from_world_vector(v, dir)));
  }
}

// The sky lights clouds by itself, as sun and moon light the air too little.
layout(constant_id = kCloudSkyConstant) const bool kCloudSky = false;

// Radiance that clouds at a place send to the eye, over their extinction. @param air what clear air leaves of it, @param sky the light it has.
vec3 source_at(vec3 p, vec4 sun_phases, vec4 moon_phases, float air, vec3 sky) {
  if (kBodies == 0u && !kCloudSky) return vec3(0.0);
  vec3 light = vec3(0.0);
  float depth = 0.0, open = kBodies == 0u ? 1.0 : 0.0;
  if ((kBodies & 2u) != 0u) {
    depth = cloud_depth(1u, p);
    open = past_islands(kMoonCascade, p);
    light += clouds.lights[1].irradiance * (terms_left(moon_phases, depth) * open);
  }
  if ((kBodies & 1u) != 0u) {
    depth = cloud_depth(0u, p);
    open = past_islands(0u, p);
    light += clouds.lights[0].irradiance * (terms_left(sun_phases, depth) * open);
  }
  // The sky's light comes from all sides, and goes in as far as what is scattered most.
  if (kBodies != 0u) light += clouds.sky_beside_body * (open * exp(-depth * kTermDepth.z));
  if (kCloudSky) {
    light += clouds.sky_above * exp(-cloud_depth(kCloudZenith, p) * kTermDepth.z);
    open = mix(1.0, open, frame.body_in_air);  // of the air's own light
  }
  return light * (kCloudAlbedo * air) + sky * (open * (1.0 - air));
}

#ifdef SKERRY_LIGHTS
layout(constant_id = kLitConstant) const bool kLit = false;  // lamps light clouds; if not, their lists are not read

// Mean radiance that a light with nothing in its way but the cloud, taken for as dense as here, makes a stretch of it send to the eye, over its
// extinction. Light falls off so fast that it is integrated along the stretch, not looked at in its middle.
vec3 lit_by_light(Light light, vec3 dir, float t, float length_blocks, float extinction) {
  bool placed = (light.kind & kLightKindMask) != kLightDirectional;
  float along = placed ? dot(light.position, dir) : t;
  float nearest = clamp(along, t, t + length_blocks);
  vec3 way = placed ? light.position - dir * nearest : -light.axis;
  float aside = max(length(light.position - dir * along), max(light.size, kNearestToFog));
  // The mean of 1 / d^2 along the stretch: the angle that it spans, seen from the light, over its length.
  float angle = atan(length_blocks * aside, aside * aside + (t + length_blocks - along) * (t - along));
  float mean = angle / (aside * length_blocks);
  float distance = max(length(way), 1e-6);
  vec3 to_light = way / distance;
  if (!placed) mean = 1.0;
  else mean *= light_window(light, min(distance, light.range) * min(distance, light.range));
  if ((light.kind & kLightKindMask) == kLightSpot) mean *= light_cone(light, to_light);
  return light.intensity * (kCloudAlbedo * mean * terms_left(term_phases(dot(dir, to_light)), placed ? extinction * distance : 0.0));
}

// Of all lights of a pixel's cluster, past walls. Those are looked for from the stretch's middle, before as many lights as for a surface.
vec3 lit_by_lights(uvec2 pixel, vec3 dir, float t, float length_blocks, float extinction) {
  float middle = t + 0.5 * length_blocks;
  float z = middle * dot(dir, frame.ray_forward);
  Cluster list = lights_at(pixel, z);
  // In other slices no light reaches anything, and the clusters that show no surface are not written.
  if (!kOracle && ((grid.marked_slices >> slice_at(z)) & 1u) == 0u) list.count = 0u;
  WayStart start = way_from(dir * middle);
  bool some = kLightsShadows != 0u && kLightsShadows != kEveryLight;
  Strongest strongest = no_lights();
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < list.count; ++i) {
    uint index = light_index(list, i);
    Light light = frame_light(index);
    vec3 part = lit_by_light(light, dir, t, length_blocks, extinction);
    if (kLightsShadows == kEveryLight && part != vec3(0.0)) part *= traced_visibility(start, light);
    if (some) add_strength(strongest, luminance(part), index);
    sum += part;
  }
  if (!some) return sum;
  // What arrives of the strongest stands for the others, as on surfaces.
  vec3 arrived = vec3(0.0);
  float asked = 0.0, through = 0.0;
  uint found = lights_found(strongest);
  for (uint k = 0u; k < found; ++k) {
    Light light = frame_light(strongest.lights[k]);
    vec3 part = lit_by_light(light, dir, t, length_blocks, extinction);
    float visibility = traced_visibility(start, light);
    sum -= part;
    arrived += part * visibility;
    asked += strongest.strengths[k];
    through += strongest.strengths[k] * visibility;
  }
  return arrived + max(sum, vec3(0.0)) * (asked > 0.0 ? through / asked : 1.0);
}
#endif

// Where the clusters of a place on a ray end, if lights reach any as far away.
float lights_change_at(vec3 dir, float t) {
#ifdef SKERRY_LIGHTS
  if (!kLit) return 1e30;
  float forward = dot(dir, frame.ray_forward);
  uint slice = slice_at(t * forward);
  // What rounding leaves of a slice is not worth a step.
  if (slice_begin(slice + 1u) <= t * forward * 1.00001) ++slice;
  return ((grid.marked_slices >> slice) & 1u) != 0u && slice + 1u < kClusterSlices ? slice_begin(slice + 1u) / forward : 1e30;
#else
  return 1e30;
#endif
}

// What is left of the view when a march ends. A disc is so bright that it shines through more than anything else.
float clear_enough(vec3 dir) {
  float off_disc = max(dot(dir, clouds.lights[0].to_light), dot(dir, clouds.lights[1].to_light));
  return off_disc > kDiscCosine ? kDiscHidden : kHidden;
}

struct CloudRay {
  uvec2 pixel;
  vec3 origin;  // the eye, 0, or where its view is mirrored
  vec3 dir;     // unit
};

// Where the ray is in the layer and in each file's box: from x to y, if y is greater.
vec2 in_layer, in_volume[kMaxCloudVolumes];

// Sets them. @param begin, end blocks along the ray. @return from where to where it may be in any.
vec2 find_ranges(CloudRay ray, float begin, float end) {
  in_layer = kCloudLayer ? layer_range(ray.origin, ray.dir, begin, end) : vec2(1.0, 0.0);
  float stop = in_layer.y > in_layer.x ? in_layer.y : 0.0, t = in_layer.y > in_layer.x ? in_layer.x : 1e30;
  for (uint v = 0u; v < kCloudVolumes; ++v) {
    vec2 range = box_range(v, index_from_world(v, ray.origin), index_from_world_vector(v, ray.dir));
    in_volume[v] = vec2(max(range.x, begin), min(range.y, end));
    bool met = in_volume[v].y > in_volume[v].x;
    stop = met ? max(stop, in_volume[v].y) : stop;
    t = met ? min(t, in_volume[v].x) : t;
  }
  return vec2(min(t, stop), stop);
}

// Whether the ray passes a file's box that glows and takes nothing.
bool passes_glow() {
  bool glows = false;
  for (uint v = 0u; v < kCloudVolumes; ++v)
    glows = glows || (in_volume[v].y > in_volume[v].x && clouds.volumes[v].extinction == 0.0);
  return glows;
}

struct CloudsHere {
  bool layer;
  float whole;   // step: the shortest of what is here; 1e30: nothing is
  float change;  // where something here ends or anything begins
  float begins;  // where anything begins
};

// @param growth of the layer's steps, @param stop where the last range ends.
CloudsHere clouds_here(float t, float growth, float stop) {
  CloudsHere here = CloudsHere(kCloudLayer && t >= in_layer.x && t < in_layer.y, 1e30, stop, stop);
  if (here.layer) {
    here.whole = (kLayerStepGrowth + t) * growth;
    here.change = min(here.change, in_layer.y);
  } else if (kCloudLayer && t < in_layer.x && in_layer.x < in_layer.y) {
    here.begins = min(here.begins, in_layer.x);
  }
  for (uint v = 0u; v < kCloudVolumes; ++v) {
    if (t >= in_volume[v].y || in_volume[v].y <= in_volume[v].x) continue;
    bool inside = t >= in_volume[v].x;
    here.whole = inside ? min(here.whole, clouds.volumes[v].step_blocks) : here.whole;
    here.change = inside ? min(here.change, in_volume[v].y) : here.change;
    here.begins = inside ? here.begins : min(here.begins, in_volume[v].x);
  }
  here.change = min(here.change, here.begins);
  return here;
}

struct CloudStep {
  float clear;               // of the view, after the step
  float seen_share, seen_at; // opacity as seen, and its sum of places
  float empty_until;         // so far along the ray there is nothing for certain; 0: there may be something
  vec3 sent;                 // by what glows and by lamps
};

// @param clear of the view before the step.
CloudStep march_step(CloudRay ray, float t, float length_blocks, bool layer, float clear) {
  float part_blocks = length_blocks / float(kParts);
  CloudStep seen = CloudStep(clear, 0.0, 0.0, 1e30, vec3(0.0));
  float cover = layer ? layer_cover(ray.origin + ray.dir * (t + 0.5 * length_blocks), clouds.layer) : 0.0;
  for (uint part = 0u; part < kParts; ++part) {
    float from = t + float(part) * part_blocks;
    vec3 p = ray.origin + ray.dir * (from + 0.5 * part_blocks);
    Medium m = Medium(0.0, vec3(0.0), 1e30);
    if (layer) {
      m.extinction = layer_extinction(p, cover, clouds.layer);
      m.empty = 0.0;
    }
    for (uint v = 0u; v < kCloudVolumes; ++v)
      if (t >= in_volume[v].x && t < in_volume[v].y) add_volume(v, p, ray.dir, m);
    seen.empty_until = m.empty > 0.0 && seen.empty_until > 0.0 ? from + 0.5 * part_blocks + m.empty : 0.0;
    if (kCloudVolumes != 0u && seen.empty_until >= t + length_blocks) break;
    float depth = m.extinction * part_blocks;
    float opacity = opacity_of(depth);
    // In a dense part what is seen is what lies in front.
    float free_path = min(part_blocks, 1.0 / max(m.extinction, 1e-6));
    float middle = from + min(0.5 * part_blocks, free_path);
    if (kCloudVolumes != 0u)
      seen.sent += m.emitted * (clear * clear_air(ray.dir * middle) * (depth > 1e-4 ? opacity / m.extinction : part_blocks));
#ifdef SKERRY_LIGHTS
    if (kLit && opacity > 0.0 && clear > kHidden)
      seen.sent += lit_by_lights(ray.pixel, ray.dir, from, free_path, m.extinction) * (clear * opacity * clear_air(ray.dir * middle));
#endif
    seen.seen_share += clear * opacity;
    seen.seen_at += clear * opacity * middle;
    clear *= 1.0 - opacity;
  }
  seen.clear = clear;
  return seen;
}

// @param origin, dir see CloudRay; @param begin, end blocks along it; @param jitter over 0, up to 1: how much of the first step is taken.
Clouded march_clouds(uvec2 pixel, vec3 origin, vec3 dir, float begin, float end, float jitter) {
  CloudRay ray = CloudRay(pixel, origin, dir);
  vec2 range = find_ranges(ray, begin, end);
  float t = range.x, stop = range.y;
  float growth = pow((kLayerStepGrowth + in_layer.y) / (kLayerStepGrowth + in_layer.x), 1.0 / clouds.steps) - 1.0;
  float enough = passes_glow() ? kDiscHidden : clear_enough(dir);
  Clouded seen = Clouded(vec3(0.0), 1.0);
  vec4 sun_phases = term_phases(dot(dir, clouds.lights[0].to_light)), moon_phases = term_phases(dot(dir, clouds.lights[1].to_light));
  vec3 sky = (kBodies != 0u || kCloudSky) && kHaze && t < stop ? sample_sky(sky_lut, dir, frame.sky_horizon, frame.sky_yaw) : vec3(0.0);
  for (uint i = 0u; i < kMostIterations && t < stop && seen.clear > enough; ++i) {
    CloudsHere here = clouds_here(t, growth, stop);
    if (here.whole == 1e30) {
      t = max(here.change, t * 1.000001);
      continue;
    }
    float change = min(here.change, lights_change_at(dir, t));
    // The step is not lost in the distance's last digits.
    float least = max(t * 1e-6, 1e-4);
    float length_blocks = max(min(here.whole * jitter, change - t), least);
    CloudStep one = march_step(ray, t, length_blocks, here.layer, seen.clear);
    jitter = 1.0;
    if (one.seen_share > 0.0 && seen.clear > kHidden) {
      // Sun, moon and sky are looked up once, where the step is seen from in the mean.
      vec3 way = dir * (one.seen_at / one.seen_share);
      one.sent += source_at(origin + way, sun_phases, moon_phases, clear_air(way), sky) * one.seen_share;
    }
    seen.light += one.sent;
    seen.clear = one.clear;
    // Whole steps only, so that where samples lie does not show where bricks do; and none over what begins.
    float passed = t + length_blocks;
    float skipped = (min(one.empty_until, here.begins) - passed) / max(here.whole, least);
    t = passed + clamp(floor(skipped), 0.0, 1e6) * here.whole;
  }
  if (seen.clear <= enough) seen.clear = 0.0;
  return seen;
}

// A value of a pixel that its neighbours' differ from as much as they can (Jimenez, Next Generation Post Processing in Call of Duty, 2014); more
// than 0, for it is the share of a step.
float gradient_jitter(uvec2 pixel) {
  return max(fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715)))), 1.0 / 64.0);
}
#endif
