#include "tools/reference/shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "tools/reference/brdf.h"
#include "tools/reference/media.h"
#include "tools/reference/open_sky.h"
#include "tools/reference/textures.h"
#include "world/voxel/emission.h"

namespace skerry::reference {
namespace {

constexpr double kPi = std::numbers::pi;

/// How far off their surface rays begin [blocks]: far more than rounding, far less than a texel.
constexpr double kOffSurface = 1e-7;

constexpr double kInside = 1e-9;  // of a voxel [blocks]

constexpr glm::dvec3 kEye{0.0};

/// A direction, evenly spread. @param pair 0..1
glm::dvec3 on_sphere(glm::dvec2 pair) {
  const double y = 1.0 - 2.0 * pair.x, turn = 2.0 * kPi * pair.y;
  const double r = std::sqrt(std::max(0.0, 1.0 - y * y));
  return {r * std::sin(turn), y, r * std::cos(turn)};
}

/// The point of a face's plane that a direction from the eye meets, in the lattice. A plant's
/// texture does not repeat, so that there the nearest point of the plant counts.
glm::dvec3 on_plane(const Meeting& hit, glm::dvec3 eye, glm::dvec3 direction) {
  const int axis = axis_of_face(hit.face);
  const double side = hit.face == 6 ? -1.0 : 1.0;  // plants: x - z or x + z is constant
  const auto along = [&](glm::dvec3 v) { return axis == 3 ? v.x + side * v.z : v[axis]; };
  const double speed = along(direction);
  if (speed == 0.0) return hit.lattice;
  const glm::dvec3 point = eye + direction * ((along(hit.lattice) - along(eye)) / speed);
  if (axis != 3) return point;
  const glm::dvec3 low(hit.voxel.x, hit.voxel.y, hit.voxel.z);
  return glm::clamp(point, low + kInside, low + 1.0 - kInside);
}

}  // namespace

// --- Light that arrives

bool Shader::body_seen(const Receiver& at, glm::dvec3 to_light) const {
  return !scene_.shadows || !tracer_.hidden(at.point, to_light, kFar, at.plant);
}

namespace {

/// Whether a ray goes out of the block whose surface it meets.
bool leaves(const Meeting& layer, glm::dvec3 lattice_direction) {
  const int axis = axis_of_face(layer.face);
  const double middle = 0.5 + (axis == 0   ? layer.voxel.x
                               : axis == 1 ? layer.voxel.y
                                           : layer.voxel.z);
  return (middle - layer.lattice[axis]) * lattice_direction[axis] < 0.0;
}

/// Of radiance behind a surface, what there is of it before: it goes with the square of the index,
/// for in water a cone holds what comes from the air's half space. Glass counts as if it had none.
/// @param from, into that a ray passes, which goes against the light.
double through_water_surface(world::BlockId from, world::BlockId into) {
  constexpr double kSquare = kWaterIndex * kWaterIndex;
  const bool before = world::block_types()[from].liquid, after = world::block_types()[into].liquid;
  if (before == after) return 1.0;
  return after ? 1.0 / kSquare : kSquare;
}

/// Not in part, as a torch does, whose flame lights its stick.
bool glows_all_over(const world::BlockType& type) {
  return type.emission > 0.0f && type.glows_from == 0.0f;
}

}  // namespace

/// The surface of level water through which a ray leaves it; null: none before what it hits.
const Meeting* Shader::leaves_water(const Trace& trace, glm::dvec3 direction) const {
  for (const Meeting& layer : trace.layers)
    if (is_wavy(layer) && leaves(layer, tracer_.lattice_vector(layer.island, direction)))
      return &layer;
  return nullptr;
}

world::BlockId Shader::medium_behind(const Meeting& layer, glm::dvec3 direction) const {
  return leaves(layer, tracer_.lattice_vector(layer.island, direction)) ? world::kAir : layer.block;
}

/// What is left of light along a ray up to a distance [blocks].
/// @param medium that the ray begins in.
glm::dvec3 Shader::left_by_media(const Trace& trace, glm::dvec3 direction, double to,
                                 world::BlockId medium) const {
  glm::dvec3 left(1.0);
  double at = 0.0;
  const auto advance = [&](double next) {
    if (medium != world::kAir) left *= transmitted_by(medium_of(medium), next - at);
    at = next;
  };
  for (const Meeting& layer : trace.layers) {
    if (layer.t > to) break;
    advance(layer.t);
    medium = medium_behind(layer, direction);
  }
  // A medium without an end lets nothing through.
  if (medium != world::kAir) advance(to);
  return left;
}

/// Straight to a body.
glm::dvec3 Shader::left_of_body(const Receiver& at, glm::dvec3 to_light,
                                world::BlockId medium) const {
  if (!body_seen(at, to_light)) return glm::dvec3(0.0);
  Trace trace;
  trace_from(at, to_light, trace);
  return left_by_media(trace, to_light, trace.hit ? trace.hit->t : kFar, medium);
}

/// Light that reaches a place in water has been bent by the surface, which it is taken to have
/// passed where that is level: ripples turn what is seen, not what lights.
Shader::Way Shader::way_of_body(const Receiver& at, glm::dvec3 to_light) const {
  const std::optional<Tracer::Medium> in = tracer_.medium_at(at.point);
  const world::BlockId medium = in ? in->block : world::kAir;
  if (medium == world::block::kWater) {
    const glm::dvec3 up = tracer_.normal(in->island, 2);
    const double cosine = glm::dot(up, to_light);
    if (cosine <= 0.0) return {to_light, glm::dvec3(0.0)};
    const glm::dvec3 bent = -glm::refract(-to_light, up, 1.0 / kWaterIndex);
    Trace trace;
    trace_from(at, bent, trace);
    if (const Meeting* surface = leaves_water(trace, bent)) {
      const Receiver above{at.point + bent * surface->t + up * kOffSurface, up};
      return {bent,
              left_by_media(trace, bent, surface->t, medium) *
                  left_of_body(above, to_light, world::kAir) *
                  ((1.0 - fresnel(cosine, false, kWaterIndex)) * cosine / glm::dot(up, bent))};
    }
    if (trace.hit && scene_.shadows) return {bent, glm::dvec3(0.0)};
  }
  return {to_light, left_of_body(at, to_light, medium)};
}

/// Calls take(Arrival) for each light that one sample finds unhidden and before the surface.
template <class Take>
void Shader::arrive(const Receiver& at, Sampler& sampler, Take&& take) const {
  for (const Body& body : scene_.bodies) {
    const glm::dvec2 pair = sampler.next();
    const double spread = 2.0 * std::pow(std::sin(0.5 * body.angular_radius), 2.0);
    const glm::dvec3 to_light = Frame(body.to_light).world(in_cone(pair, spread));
    const Way way = way_of_body(at, to_light);
    if (glm::dot(at.normal, way.to_light) <= 0.0 || way.share == glm::dvec3(0.0)) continue;
    take(Arrival{way.to_light,
                 body.irradiance * way.share * past_clouds(at.point, to_light, sampler), nullptr});
  }
  const bool glows = at.plant && glows_all_over(world::block_types()[at.plant->block]);
  lights_.reaching(at.point, [&](const Light& light) {
    // What such a plant emits is that lamp, a point among its planes, near which light has no
    // bound.
    if (glows && is_in(light.position, *at.plant)) return;
    const std::optional<LightRay> ray = sample_light(light, at.point, sampler);
    if (!ray || glm::dot(at.normal, ray->to_light) <= 0.0) return;
    const bool placed = light.kind != shared::kLightDirectional;
    const glm::dvec3 left = tracer_.left_of_lamp(at.point, ray->to_light, ray->distance, at.plant,
                                                 placed ? &light.position : nullptr);
    if (left == glm::dvec3(0.0)) return;
    take(Arrival{ray->to_light, ray->irradiance * left, &light});
  });
}

/// What lights surfaces from beyond the voxels, sun and moon aside.
glm::dvec3 Shader::beyond_voxels(glm::dvec3 direction) const {
  if (scene_.sky_lights && scene_.sky) return sky_behind(direction, *scene_.sky);
  return scene_.environment;
}

/// What a ray from a surface meets; a plant does not meet itself.
void Shader::trace_from(const Receiver& at, glm::dvec3 direction, Trace& out) const {
  double passed = 0.0;
  std::vector<Meeting> layers;
  for (int planes = 0; planes < 4; ++planes) {
    tracer_.trace(at.point + direction * passed, direction, out);
    for (Meeting& layer : out.layers) {
      layer.t += passed;
      layers.push_back(layer);
    }
    if (out.hit) out.hit->t += passed;
    const bool own = at.plant && out.hit && out.hit->island == at.plant->island &&
                     out.hit->voxel == at.plant->voxel;
    if (!own) break;
    passed = out.hit->t + kOffSurface;
    out.hit.reset();
  }
  out.layers = std::move(layers);
}

/// At level water, from either side, a ray is bent, or mirrored back by lot; whatever else it meets
/// of water and glass it goes through straight, and they absorb.
Shader::Followed Shader::follow(const Receiver& at, glm::dvec3 direction, Sampler& sampler) const {
  constexpr int kMostParts = 8;
  Followed out{std::nullopt, at.point, direction, glm::dvec3(1.0)};
  Receiver from = at;
  Trace trace;
  for (int part = 0; part < kMostParts; ++part) {
    out.origin = from.point;
    trace_from(from, out.direction, trace);
    const std::optional<Tracer::Medium> in = tracer_.medium_at(from.point);
    const auto surface = std::ranges::find_if(trace.layers, is_wavy);
    const bool found = surface != trace.layers.end();
    const double end = found ? surface->t : trace.hit ? trace.hit->t : kFar;
    world::BlockId medium = in ? in->block : world::kAir;
    out.share *= left_by_media(trace, out.direction, end, medium);
    for (auto layer = trace.layers.begin(); layer != surface && layer->t < end; ++layer) {
      const world::BlockId next = medium_behind(*layer, out.direction);
      out.share *= through_water_surface(std::exchange(medium, next), next);
    }
    if (!found) {
      out.hit = trace.hit;
      return out;
    }
    const world::BlockId behind = medium_behind(*surface, out.direction);
    const bool leaving = behind == world::kAir;
    const glm::dvec3 normal = tracer_.normal(surface->island, surface->face);
    const glm::dvec3 point = from.point + out.direction * surface->t;
    const double mirrored = fresnel(-glm::dot(out.direction, normal), leaving, kWaterIndex);
    const bool back = sampler.next().x < mirrored;
    out.direction =
        back ? glm::reflect(out.direction, normal)
             : glm::refract(out.direction, normal, leaving ? kWaterIndex : 1.0 / kWaterIndex);
    if (!back) out.share *= through_water_surface(medium, behind);
    from.point = point + normal * (back ? kOffSurface : -kOffSurface);
  }
  out.share = glm::dvec3(0.0);
  return out;
}

bool Shader::is_in(glm::dvec3 point, const Meeting& hit) const {
  const glm::ivec3 voxel(glm::floor(tracer_.lattice_point(hit.island, point)));
  return voxel == glm::ivec3(hit.voxel.x, hit.voxel.y, hit.voxel.z);
}

/// Radiance that a surface sends back of the light that arrives there. Its own light is left out:
/// it arrives as that of a lamp, and no plant, not even a torch, reflects that of the lamp among
/// its planes, near which light has no bound. Long ways end by lot, as likely as the surface
/// swallows light.
glm::dvec3 Shader::bounced(const Meeting& hit, glm::dvec3 point, int bounces,
                           Sampler& sampler) const {
  constexpr int kSurely = 4;  // bounces
  const bool plant = axis_of_face(hit.face) == 3;
  const glm::dvec3 normal = tracer_.normal(hit.island, hit.face);
  Receiver at{point, normal, plant ? &hit : nullptr};
  if (!plant) at.point += normal * kOffSurface;
  const glm::dvec3 albedo =
      scene_.albedo.value_or(BlockTexels::shared().texel(hit.block, hit.face, hit.lattice));
  glm::dvec3 irradiance(0.0);
  arrive(at, sampler, [&](const Arrival& light) {
    if (!plant || !light.lamp || !is_in(light.lamp->position, hit))
      irradiance += light.irradiance * cosine_of(light, normal);
  });
  double goes_on = 1.0;
  if (scene_.bounces - bounces >= kSurely)
    goes_on = std::min(1.0, std::max({albedo.x, albedo.y, albedo.z}));
  if (sampler.next().x < goes_on)
    irradiance += from_around(at, bounces, sampler).radiance * (kPi / goes_on);
  return irradiance * albedo / kPi;
}

/// @param bounces that may still come before the light.
Shader::Around Shader::from_around(const Receiver& at, int bounces, Sampler& sampler) const {
  const bool lit = scene_.sky_lights || scene_.environment != glm::dvec3(0.0);
  if (bounces == 0 && !lit) return {at.normal, glm::dvec3(0.0)};
  const glm::dvec3 direction = Frame(at.normal).world(by_cosine(sampler.next()));
  const Followed way = follow(at, direction, sampler);
  if (bounces > 0 && way.hit)
    return {direction, way.share * bounced(*way.hit, way.origin + way.direction * way.hit->t,
                                           bounces - 1, sampler)};
  if (bounces == 0 && tracer_.hidden(way.origin, way.direction, kFar, at.plant))
    return {direction, glm::dvec3(0.0)};
  return {direction, way.share * beyond_voxels(way.direction)};
}

double Shader::cosine_of(const Arrival& light, glm::dvec3 normal) const {
  return scene_.flat_shading && !light.lamp ? 1.0 : glm::dot(normal, light.to_light);
}

glm::dvec3 Shader::irradiance(const Receiver& at, Sampler& sampler) const {
  glm::dvec3 sum = kPi * from_around(at, scene_.bounces, sampler).radiance;
  arrive(at, sampler,
         [&](const Arrival& light) { sum += light.irradiance * cosine_of(light, at.normal); });
  return sum;
}

glm::dvec3 Shader::soft_irradiance(const Receiver& at, double most_range, Sampler& sampler) const {
  glm::dvec3 sum = kPi * from_around(at, scene_.bounces, sampler).radiance;
  arrive(at, sampler, [&](const Arrival& light) {
    if (light.lamp && light.lamp->range <= most_range)
      sum += light.irradiance * glm::dot(at.normal, light.to_light);
  });
  return sum;
}

glm::dvec3 Shader::behind_voxels(glm::dvec3 direction) const {
  return scene_.sky ? sky_behind(direction, *scene_.sky) : scene_.environment;
}

// --- Surfaces and air

double Shader::ao(const Meeting& hit) const {
  const int axis = axis_of_face(hit.face);
  if (scene_.ao_strength == 0.0 || axis == 3) return 1.0;
  const int u = axis == 0 ? 2 : 0, v = axis == 1 ? 2 : 1;
  const glm::ivec3 front(hit.voxel.x, hit.voxel.y, hit.voxel.z);
  bool stands[9];
  for (int i = 0; i < 9; ++i) {
    glm::ivec3 at = front;
    at[axis] += hit.face % 2 == 0 ? 1 : -1;
    at[u] += i % 3 - 1;
    at[v] += i / 3 - 1;
    stands[i] = world::block_kind(tracer_.block_at(hit.island, {at.x, at.y, at.z})) ==
                world::BlockKind::kOpaque;
  }
  const glm::dvec3 inside = hit.lattice - glm::dvec3(front);
  return 1.0 - scene_.ao_strength * (1.0 - corner_ao({inside[u], inside[v]}, stands));
}

glm::dvec3 Shader::surface(const Meeting& hit, glm::dvec3 origin, glm::dvec3 direction,
                           glm::dvec3 fine, Sampler& sampler) const {
  const glm::dvec3 normal = tracer_.normal(hit.island, hit.face);
  const bool plant = axis_of_face(hit.face) == 3;
  Receiver at{origin + direction * hit.t, normal, plant ? &hit : nullptr};
  if (!plant) at.point += normal * kOffSurface;
  const glm::dvec3 place = on_plane(hit, tracer_.lattice_point(hit.island, origin),
                                    tracer_.lattice_vector(hit.island, fine));
  const glm::dvec3 albedo =
      scene_.albedo.value_or(BlockTexels::shared().texel(hit.block, hit.face, place));
  const world::BlockType& type = world::block_types()[hit.block];
  const bool matt = plant || scene_.matt || scene_.flat_shading;
  const Around around = from_around(at, scene_.bounces, sampler);
  glm::dvec3 reflected(0.0);
  arrive(at, sampler, [&](const Arrival& light) {
    const glm::dvec3 share = matt ? albedo / kPi
                                  : surface_brdf(normal, light.to_light, -direction, albedo,
                                                 type.roughness, type.metalness);
    reflected += light.irradiance * share * cosine_of(light, normal);
  });
  const glm::dvec3 share = matt ? albedo / kPi
                                : surface_brdf(normal, around.to_light, -direction, albedo,
                                               type.roughness, type.metalness);
  // Corners darken what has no other shadow in them; what comes from around has passed all voxels.
  return reflected * ao(hit) + kPi * around.radiance * share +
         world::emitted_radiance(type, albedo);
}

/// One a block; 0 where no light is that the air could scatter.
double Shader::extinction_of_air() const {
  return scene_.bodies.empty() && !scene_.sky_lights ? 0.0 : scene_.haze_per_block;
}

glm::dvec3 Shader::through_air(glm::dvec3 radiance, glm::dvec3 origin, glm::dvec3 direction,
                               double distance, Sampler& sampler) const {
  const double extinction = extinction_of_air();
  if (extinction == 0.0) return radiance;
  const double clear = std::exp(-extinction * distance), lost = -std::expm1(-extinction * distance);
  // One place on the way, as likely as the air there is the last to scatter what the eye sees.
  const double at = -std::log1p(-sampler.next().x * lost) / extinction;
  const glm::dvec3 place = origin + direction * std::min(at, distance);
  double lit = 0.0;
  if (!scene_.bodies.empty()) {
    const Body& body = scene_.bodies.front();
    const double spread = 2.0 * std::pow(std::sin(0.5 * body.angular_radius), 2.0);
    const glm::dvec3 to_light = Frame(body.to_light).world(in_cone(sampler.next(), spread));
    if (body_seen({place, to_light}, to_light))
      lit = scene_.body_in_air * past_clouds(place, to_light, sampler);
  }
  if (scene_.sky_lights && lit < 1.0) {
    if (!tracer_.hidden(place, on_sphere({sampler.next().x, sampler.next().x}))) lit = 1.0;
  }
  return radiance * clear + behind_voxels(direction) * (lost * lit);
}

// --- Clouds

/// Share of a body's light that clouds let through.
double Shader::past_clouds(glm::dvec3 from, glm::dvec3 to_light, Sampler& sampler) const {
  if (!scene_.clouds.layer && scene_.clouds.grids.empty()) return 1.0;
  return std::exp(-scene_.clouds.depth(from, to_light, sampler.next().x));
}

namespace {

constexpr double kNearestToFog = 0.3;  // blocks: nearer a lamp makes fog no brighter

/// A lamp beside a ray: where along it the lamp is nearest, and the part that it reaches.
struct LampBeside {
  double along = 0.0, aside = 0.0, from = 0.0, to = 0.0;
  double power = 0.0;  // what it would make even fog send, to a factor

  double angle(double t) const { return std::atan((t - along) / aside); }
  /// A place with 1 / d^2 as its density (Kulla and Fajardo, Importance Sampling Techniques for
  /// Path Tracing in Participating Media, 2012). @param share 0..1, even.
  double place(double share) const {
    const double low = angle(from);
    return std::clamp(along + aside * std::tan(low + share * (angle(to) - low)), from, to);
  }
  double density(double t) const {
    if (t < from || t > to) return 0.0;
    return aside / ((aside * aside + (t - along) * (t - along)) * (angle(to) - angle(from)));
  }
};

std::vector<LampBeside> lamps_beside(const std::vector<Light>& lights, glm::dvec3 origin,
                                     glm::dvec3 direction, double begin, double end) {
  std::vector<LampBeside> out;
  for (const Light& light : lights) {
    if (light.kind == shared::kLightDirectional) continue;
    const glm::dvec3 way = light.position - origin;
    LampBeside lamp;
    lamp.along = glm::dot(way, direction);
    const double off = glm::length(way - direction * lamp.along);
    if (off >= light.range) continue;
    const double reach = std::sqrt(light.range * light.range - off * off);
    lamp.aside = std::max(off, kNearestToFog);
    lamp.from = std::max(begin, lamp.along - reach);
    lamp.to = std::min(end, lamp.along + reach);
    if (lamp.to <= lamp.from) continue;
    lamp.power = (light.intensity.x + light.intensity.y + light.intensity.z) / lamp.aside *
                 (lamp.angle(lamp.to) - lamp.angle(lamp.from));
    if (lamp.power > 0.0) out.push_back(lamp);
  }
  return out;
}

}  // namespace

/// What lamps that are seen make a cloud send to the eye, over its extinction.
glm::dvec3 Shader::lamps_in_cloud(glm::dvec3 p, glm::dvec3 direction, Sampler& sampler) const {
  glm::dvec3 sum(0.0);
  lights_.reaching(p, [&](const Light& light) {
    const std::optional<LightRay> ray = sample_light(light, p, sampler);
    const bool placed = light.kind != shared::kLightDirectional;
    if (!ray || tracer_.hidden(p, ray->to_light, ray->distance, nullptr,
                               placed ? &light.position : nullptr))
      return;
    const double depth = scene_.clouds.depth(p, ray->to_light, sampler.next().x, ray->distance);
    const double close = placed ? std::min(1.0, ray->distance / kNearestToFog) : 1.0;
    sum += ray->irradiance *
           (close * close * scattered_share(glm::dot(direction, ray->to_light), depth));
  });
  return sum;
}

/// Light of lamps that clouds scatter at one place. It is as likely as light of an even lamp comes
/// from there, or as light of one of the lamps does: where a ray passes a lamp closely almost all
/// light comes from a few blocks, which the former would hardly ever find.
glm::dvec3 Shader::lamps_along(const CloudMeeting& met, glm::dvec3 origin, glm::dvec3 direction,
                               double air, Sampler& sampler) const {
  if (scene_.lights.empty()) return glm::dvec3(0.0);
  const CloudMeeting::Step& last = met.steps.back();
  const std::vector<LampBeside> beside = lamps_beside(
      scene_.lights, origin, direction, met.steps.front().from, last.from + last.length);
  const double even = beside.empty() ? 1.0 : 0.5;
  double power = 0.0;
  for (const LampBeside& lamp : beside) power += lamp.power;
  const glm::dvec2 pair = sampler.next();
  const LampBeside* chosen = nullptr;
  double left = pair.x < even ? -1.0 : (pair.x - even) / (1.0 - even) * power;
  for (const LampBeside& lamp : beside) {
    if (left < 0.0) break;
    chosen = &lamp;
    left -= lamp.power;
  }
  const double t = chosen ? chosen->place(pair.y) : met.place(pair.y);
  const double weight = met.weight_at(t);
  if (weight == 0.0) return glm::dvec3(0.0);
  double density = even * weight / (1.0 - met.clear);
  for (const LampBeside& lamp : beside)
    density += (1.0 - even) * lamp.power / power * lamp.density(t);
  return lamps_in_cloud(origin + direction * t, direction, sampler) *
         (weight / density * std::exp(-air * t));
}

/// Light that clouds scatter at one place, as likely as what the eye sees was scattered there last;
/// the air before them; and what is left of what is behind.
Seen Shader::through_clouds(Seen behind, glm::dvec3 origin, glm::dvec3 direction, double begin,
                            double end, Sampler& sampler) const {
  if (!scene_.clouds.layer && scene_.clouds.grids.empty()) return behind;
  const double air = extinction_of_air();
  const CloudMeeting met =
      meet_clouds(scene_.clouds, {origin, direction, begin, end}, air, sampler.next().x);
  if (met.clear == 1.0) return {behind.radiance + met.emitted, behind.open};
  const glm::dvec3 lamps = lamps_along(met, origin, direction, air, sampler);
  const double at = met.place(sampler.next().x);
  const glm::dvec3 p = origin + direction * at;
  const double clear_air = std::exp(-air * at);
  glm::dvec3 light(0.0);
  const glm::dvec3 air_light = behind_voxels(direction) * (1.0 - clear_air);
  for (const Body& body : scene_.bodies) {
    const glm::dvec2 pair = sampler.next(), other = sampler.next();
    const double spread = 2.0 * std::pow(std::sin(0.5 * body.angular_radius), 2.0);
    const glm::dvec3 to_light = Frame(body.to_light).world(in_cone(pair, spread));
    const double depth = scene_.clouds.depth(p, to_light, other.x);
    if (!body_seen({p, to_light}, to_light)) continue;
    light += body.irradiance * scattered_share(glm::dot(direction, to_light), depth) * clear_air;
    if (&body != &scene_.bodies.front()) continue;
    light += air_light * scene_.body_in_air;
    const glm::dvec3 aside = on_sphere({sampler.next().x, other.y});
    light += behind_voxels(aside) * (sky_share(depth) * scene_.air_light * clear_air);
  }
  if (scene_.sky_lights && scene_.sky && scene_.air_light < 1.0) {
    // What sun and moon do not stand for: the sky's own light, from where it is seen.
    const glm::dvec3 aside = on_sphere(sampler.next());
    if (!tracer_.hidden(p, aside)) {
      const double depth = scene_.clouds.depth(p, {0.0, 1.0, 0.0}, sampler.next().x);
      light += (air_light +
                render::sky_radiance(aside, scene_.sky->model) * (sky_share(depth) * clear_air)) *
               (1.0 - scene_.air_light);
    }
  }
  return {behind.radiance * met.clear + light * (1.0 - met.clear) + lamps + met.emitted,
          behind.open * met.clear};
}

/// Without water, glass and clouds.
Seen Shader::behind_media(const Trace& trace, const Ray& ray, glm::dvec3 fine,
                          Sampler& sampler) const {
  Seen seen;
  if (trace.hit) {
    seen.radiance = through_air(surface(*trace.hit, ray.origin, ray.direction, fine, sampler),
                                ray.origin, ray.direction, trace.hit->t, sampler);
  } else {
    seen.radiance = behind_voxels(ray.direction);
    seen.open = glm::dvec3(1.0);
    if (scene_.sky) {
      seen.radiance += disc_radiance(fine, *scene_.sky);
      if (moon_hides_stars(fine, *scene_.sky)) seen.open = glm::dvec3(0.0);
    }
  }
  return seen;
}

Seen Shader::look(const Trace& trace, glm::dvec3 direction, glm::dvec3 fine,
                  Sampler& sampler) const {
  const double end = trace.hit ? trace.hit->t : kFar;
  if (trace.layers.empty() && scene_.view.medium == world::kAir)
    return through_clouds(behind_media(trace, {kEye, direction}, fine, sampler), kEye, direction,
                          0.0, end, sampler);
  const double surface = trace.layers.empty() ? end : trace.layers.front().t;
  Seen seen;
  if (!bends(trace))
    seen = through_clouds(behind_media(trace, {kEye, direction}, fine, sampler), kEye, direction,
                          surface, end, sampler);
  seen = through_media(trace, direction, fine, seen, sampler);
  if (scene_.view.medium != world::kAir) return seen;
  return through_clouds(seen, kEye, direction, 0.0, surface, sampler);
}

// --- Water and glass

/// What lights bring to a point of a translucent surface.
struct Shader::Reach {
  glm::dvec3 light{0.0};     // irradiance
  glm::dvec3 mirrored{0.0};  // towards the eye
};

/// A ray's way through media so far.
struct Shader::Passage {
  glm::dvec3 radiance{0.0}, through{1.0};
  glm::dvec3 light_in{0.0};  // irradiance on the medium it is in
  world::BlockId medium = world::kAir;
  double at = 0.0;
  /// The air between the eye and the last surface: what is left of light, and what it sends.
  double clear = 1.0;
  glm::dvec3 air{0.0};
  glm::dvec3 entered{1.0};  // `through` before that surface
  glm::dvec3 seen{0.0};     // of all up to there, through the air before it

  /// Ends what is seen through the air before the last surface: what it and the medium behind it
  /// send, and this air itself as far as they stop the light behind it, which has passed the same.
  void end_surface() {
    seen += radiance * clear + (entered - through) * air;
    radiance = glm::dvec3(0.0);
    entered = through;
  }

  /// Goes on inside the medium, if it is in one.
  void advance(double to) {
    if (medium != world::kAir) {
      const Medium inside = medium_of(medium);
      radiance += through * scattered_in(inside, light_in, to - at);
      through *= transmitted_by(inside, to - at);
    }
    at = to;
  }
};

Shader::Reach Shader::reach(const Receiver& at, glm::dvec3 shading_normal, glm::dvec3 to_eye,
                            const Gloss& gloss, Sampler& sampler) const {
  Reach reach;
  reach.light = kPi * from_around(at, scene_.bounces, sampler).radiance;
  arrive(at, sampler, [&](const Arrival& light) {
    reach.light += light.irradiance * glm::dot(at.normal, light.to_light);
    const double lobe =
        (1.0 - gloss.waves) * mirror_lobe(shading_normal, light.to_light, to_eye,
                                          std::sqrt(gloss.alpha), kWaterIndex) +
        gloss.waves * wave_lobe(shading_normal, light.to_light, to_eye, gloss.alpha, kWaterIndex);
    reach.mirrored +=
        light.irradiance * (lobe * std::max(0.0, glm::dot(shading_normal, light.to_light)));
  });
  return reach;
}

/// Of level water, with its ripples.
glm::dvec3 Shader::rippled_normal(const Meeting& layer) const {
  return scene_.islands[layer.island].rotation * ripples_of(layer, scene_.time_s) *
         (layer.face == 2 ? 1.0 : -1.0);
}

/// Whether what is seen is seen through the surface of level water, from either side.
bool Shader::bends(const Trace& trace) const {
  if (trace.layers.empty() || !is_wavy(trace.layers.front())) return false;
  return scene_.view.medium == world::kAir || scene_.view.medium == trace.layers.front().block;
}

/// Behind level water, by Snell's law at its rippled surface. A ripple may turn a ray that leaves
/// back into the surface's own plane: it goes on as if it had been mirrored there. Direction 0: all
/// light is mirrored.
Shader::Ray Shader::bent_ray(const Meeting& surface, glm::dvec3 direction) const {
  const glm::dvec3 normal = tracer_.normal(surface.island, surface.face);
  const bool out = scene_.view.medium == surface.block;
  glm::dvec3 bent =
      glm::refract(direction, rippled_normal(surface), out ? kWaterIndex : 1.0 / kWaterIndex);
  if (out && glm::dot(bent, normal) > 0.0) bent = glm::reflect(bent, normal);
  return {direction * surface.t - normal * kOffSurface, bent};
}

/// What a bent ray meets that is opaque, or the sky. @param direction, before of the ray from the
/// eye, up to the surface: air is looked through as if it went on straight, but not by an eye in
/// water.
Seen Shader::behind_bent_ray(const Trace& trace, const Ray& ray, glm::dvec3 direction,
                             double before, Sampler& sampler) const {
  if (scene_.view.medium != world::kAir) {
    const Seen seen = behind_media(trace, ray, ray.direction, sampler);
    return through_clouds({seen.radiance, glm::dvec3(0.0)}, ray.origin, ray.direction, 0.0,
                          trace.hit ? trace.hit->t : kFar, sampler);
  }
  if (!trace.hit) return {behind_voxels(ray.direction), glm::dvec3(1.0)};
  return {through_air(surface(*trace.hit, ray.origin, ray.direction, ray.direction, sampler), kEye,
                      direction, before + trace.hit->t, sampler),
          glm::dvec3(0.0)};
}

/// What a surface mirrors, seen from outside: voxels, clouds and sky, but no water and glass.
glm::dvec3 Shader::mirrored_outside(glm::dvec3 from, glm::dvec3 direction, Sampler& sampler) const {
  Trace trace;
  tracer_.trace(from, direction, trace);
  Seen seen{behind_voxels(direction), glm::dvec3(0.0)};
  if (trace.hit)
    seen.radiance = through_air(surface(*trace.hit, from, direction, direction, sampler), from,
                                direction, trace.hit->t, sampler);
  return through_clouds(seen, from, direction, 0.0, trace.hit ? trace.hit->t : kFar, sampler)
      .radiance;
}

/// The same from inside: of level water what the ray meets in it; else the medium alone, as deep as
/// it goes.
glm::dvec3 Shader::mirrored_inside(const Meeting& layer, glm::dvec3 from, glm::dvec3 direction,
                                   glm::dvec3 light_in, Sampler& sampler) const {
  constexpr double kDeep = 1e3;  // blocks
  const Medium medium = medium_of(layer.block);
  Trace trace;
  if (is_wavy(layer)) tracer_.trace(from, direction, trace);
  if (!trace.hit) return scattered_in(medium, light_in, kDeep);
  return scattered_in(medium, light_in, trace.hit->t) +
         transmitted_by(medium, trace.hit->t) *
             surface(*trace.hit, from, direction, direction, sampler);
}

/// A surface of water or glass: what foam covers as a diffuse surface; of the rest Fresnel's share
/// of what it mirrors, lights that glitter, what the texture covers; what is left goes through.
void Shader::pass_surface(const Meeting& layer, const Ray& ray, glm::dvec3 fine, Passage& passage,
                          Sampler& sampler) const {
  const glm::dvec3 direction = ray.direction;
  const glm::dvec3 to_eye = -direction, normal = tracer_.normal(layer.island, layer.face);
  const bool entering = passage.medium != layer.block;
  const bool wavy = is_wavy(layer);
  const glm::dvec3 shading = wavy ? rippled_normal(layer) : normal;
  const double reflected =
      fresnel(std::clamp(glm::dot(shading, to_eye), 0.02, 1.0), !entering, kWaterIndex);
  const glm::dvec3 from = ray.origin + layer.t * direction + normal * kOffSurface;
  const Reach reached = reach({from, normal}, shading, to_eye, gloss_of(layer), sampler);
  // A ripple may turn the ray into the surface's own plane: it is mirrored there again.
  glm::dvec3 mirror = glm::reflect(direction, shading);
  if (glm::dot(mirror, normal) < 0.0) mirror = glm::reflect(mirror, normal);
  const glm::dvec3 mirrored = entering
                                  ? mirrored_outside(from, mirror, sampler)
                                  : mirrored_inside(layer, from, mirror, passage.light_in, sampler);
  if (wavy) {
    const double foam = foam_cover(tracer_, layer, scene_.time_s);
    passage.radiance += passage.through * foam * kFoamAlbedo / kPi * reached.light;
    passage.through *= 1.0 - foam;
  }
  passage.radiance += passage.through * (reached.mirrored + reflected * mirrored);
  passage.through *= 1.0 - reflected;
  const world::BlockId next = entering ? layer.block : world::kAir;
  passage.through *= through_water_surface(passage.medium, next);
  if (!wavy) {
    const glm::dvec3 place = on_plane(layer, tracer_.lattice_point(layer.island, ray.origin),
                                      tracer_.lattice_vector(layer.island, fine));
    const glm::dvec4 texel = BlockTexels::shared().texel(layer.block, layer.face, place);
    passage.radiance += passage.through * texel.w * glm::dvec3(texel) / kPi * reached.light;
    passage.through *= 1.0 - texel.w;
  }
  passage.light_in = reached.light;
  passage.medium = next;
}

Seen Shader::through_media(const Trace& trace, glm::dvec3 direction, glm::dvec3 fine, Seen behind,
                           Sampler& sampler) const {
  constexpr double kOpenWater = 1e4;  // blocks: a medium that the ray never leaves
  Passage passage;
  passage.medium = scene_.view.medium;
  if (passage.medium != world::kAir)  // the light half a block ahead stands for all of it
    passage.light_in = irradiance({direction * 0.5, glm::dvec3(0.0, 1.0, 0.0)}, sampler);
  Ray ray{kEye, direction};
  const auto see_surface = [&](const Meeting& layer, double distance) {
    passage.end_surface();
    if (scene_.view.medium == world::kAir) {
      passage.clear = std::exp(-extinction_of_air() * distance);
      passage.air = through_air(glm::dvec3(0.0), kEye, direction, distance, sampler);
    }
    pass_surface(layer, ray, fine, passage, sampler);
  };
  double before = 0.0;  // blocks to where the ray's last part begins
  Trace bent;
  const Trace* rest = &trace;
  // Only the first surface bends a ray: what else it meets, it goes through straight.
  if (bends(trace)) {
    const Meeting& surface = trace.layers.front();
    passage.advance(surface.t);
    see_surface(surface, surface.t);
    before = surface.t;
    ray = bent_ray(surface, direction);
    if (ray.direction == glm::dvec3(0.0)) {
      passage.end_surface();
      return {passage.seen, glm::dvec3(0.0)};
    }
    fine = ray.direction;
    tracer_.trace(ray.origin, ray.direction, bent);
    rest = &bent;
    passage.at = 0.0;
    behind = behind_bent_ray(bent, ray, direction, before, sampler);
  }
  for (const Meeting& layer : rest->layers) {
    passage.advance(layer.t);
    see_surface(layer, before + layer.t);
  }
  passage.advance(rest->hit ? rest->hit->t : std::max(kOpenWater, passage.at));
  passage.end_surface();
  return {passage.seen + passage.through * behind.radiance, passage.through * behind.open};
}

}  // namespace skerry::reference
