#include "engine/render/sky/sky_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <utility>

#include "engine/render/light/cascades.h"

namespace skerry::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

double altitude_deg(double sine) {
  return std::asin(std::clamp(sine, -1.0, 1.0)) / kDegree;
}

double luminance(glm::dvec3 c) {
  return glm::dot(c, glm::dvec3{0.2126, 0.7152, 0.0722});
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Whether any air that an eye sees can be lit: the sun reaches the last air 10 degrees behind its
/// horizon, which the eye sees 10 degrees behind its own.
bool lights_air(double sine, double horizon) {
  constexpr double kReachDeg = 22.0;
  return altitude_deg(sine) > horizon / kDegree - kReachDeg;
}

/// Nearest place of a lattice whose steps are a part of a height, two to its own power [km].
double on_height_lattice(double height_km, double parts_log2, double least_km) {
  const double step = std::max(least_km, std::exp2(std::floor(std::log2(height_km)) - parts_log2));
  return std::round(height_km / step) * step;
}

std::shared_ptr<const BodyScattering> node_of(double height_km, double sine, std::size_t body,
                                              const SkyModel* before) {
  if (before)
    for (const std::shared_ptr<const BodyScattering>& old : before->nodes[body])
      if (old && old->height_km == height_km && old->sine == sine) return old;
  return std::make_shared<const BodyScattering>(
      BodyScattering{height_km, sine, sky_scattering(world_atmosphere(), height_km, sine)});
}

SkyScattering between_nodes(const SkyScattering& low, const SkyScattering& high, float share) {
  SkyScattering out(low.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {glm::mix(low[i].rayleigh, high[i].rayleigh, share),
              glm::mix(low[i].mie, high[i].mie, share),
              glm::mix(low[i].multiple, high[i].multiple, share)};
  return out;
}

/// Sets what the air scatters of a body.
void set_scattering(SkyModel& model, std::size_t body, double eye_km, double body_sine,
                    const SkyModel* before) {
  constexpr double kPerDegree = 16.0, kPartsLog2 = 6.0, kLeastKm = 2e-3;
  const double height_km = std::max(kLeastKm, on_height_lattice(eye_km, kPartsLog2, kLeastKm));
  const double place = altitude_deg(body_sine) * kPerDegree, below = std::floor(place);
  std::array<std::shared_ptr<const BodyScattering>, 2>& nodes = model.nodes[body];
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = node_of(height_km, std::sin((below + static_cast<double>(i)) / kPerDegree * kDegree),
                       body, before);
  if (before && before->nodes[body] == nodes && before->scattering[body]->sine == body_sine) {
    model.scattering[body] = before->scattering[body];
    return;
  }
  model.scattering[body] = std::make_shared<const BodyScattering>(BodyScattering{
      height_km, body_sine,
      between_nodes(nodes[0]->table, nodes[1]->table, static_cast<float>(place - below))});
}

/// SkyScatter between two rows.
struct ScatterColumn {
  glm::dvec3 rayleigh, mie, multiple;
};

/// A body's table where directions of one height look it up.
class ScatterRow {
 public:
  /// @param place 0..1, see sky_row_place().
  ScatterRow(const SkyScattering& table, double place) : table_(table) {
    const double row = place * (shared::kSkyLutHeight - 1.0);
    first_ = std::min(static_cast<std::size_t>(row), std::size_t{shared::kSkyLutHeight - 2});
    share_ = row - static_cast<double>(first_);
  }
  ScatterColumn column(std::size_t x) const {
    const shared::SkyScatter &a = table_[first_ * shared::kSkyAzimuths + x],
                             &b = table_[(first_ + 1) * shared::kSkyAzimuths + x];
    const auto mix = [&](const glm::vec3& c, const glm::vec3& d) {
      return glm::mix(glm::dvec3(c), glm::dvec3(d), share_);
    };
    return {mix(a.rayleigh, b.rayleigh), mix(a.mie, b.mie), mix(a.multiple, b.multiple)};
  }

 private:
  const SkyScattering& table_;
  std::size_t first_ = 0;
  double share_ = 0.0;
};

/// What directions ask of a body.
class BodyInSky {
 public:
  explicit BodyInSky(const shared::SkyBody& body)
      : to_body_(body.to_body), light_(body.light), flat_(std::hypot(to_body_.x, to_body_.z)) {}
  /// @param column ScatterRow::column() of the direction's height.
  template <class Columns>
  glm::dvec3 radiance(const glm::dvec3& dir, const Columns& column) const {
    const double flats = std::sqrt(dir.x * dir.x + dir.z * dir.z) * flat_;
    const double cos_across = (dir.x * to_body_.x + dir.z * to_body_.z) / std::max(flats, 1e-9);
    const double place =
        std::acos(std::clamp(cos_across, -1.0, 1.0)) / kPi * (shared::kSkyAzimuths - 1.0);
    const auto i = std::min(static_cast<std::size_t>(place), std::size_t{shared::kSkyAzimuths - 2});
    const double cosine = std::clamp(glm::dot(dir, to_body_), -1.0, 1.0);
    const double rayleigh = rayleigh_phase(cosine), mie = mie_phase(cosine);
    const auto at = [&](const ScatterColumn& s) {
      return s.rayleigh * rayleigh + s.mie * mie + s.multiple;
    };
    return light_ * glm::mix(at(column(i)), at(column(i + 1)), place - static_cast<double>(i));
  }

 private:
  glm::dvec3 to_body_, light_;
  double flat_;
};

glm::dvec3 space_to(double height_km, double sine) {
  return sunlight_in_space() / kPi * world_atmosphere().transmittance(height_km, sine);
}

}  // namespace

SkyModel sky_model(const Celestial& sky, double height_km, const SkyModel* before,
                   std::shared_ptr<const PanoramaSky> panorama) {
  SkyModel model;
  model.panorama = std::move(panorama);
  shared::SkyConstants& c = model.constants;
  const double horizon_at = horizon_sine(height_km), horizon = std::asin(horizon_at);
  c.height_km = static_cast<float>(height_km);
  c.horizon = static_cast<float>(horizon);
  c.horizon_sine = static_cast<float>(horizon_at);
  c.sun.to_body = sky.to_sun;
  c.moon.to_body = sky.to_moon;
  if (!model.panorama && sky.sun_exists && lights_air(sky.to_sun.y, horizon)) {
    c.sun.light = sunlight_in_space();
    set_scattering(model, 0, height_km, sky.to_sun.y, before);
  }
  const double moon_share = sky.moon_exists ? moon_beside_sun(sky.to_sun.y) : 0.0;
  // As bright as on the ground, but not as blue: moonlit land shall stand out from its sky.
  const glm::dvec3 from_moon =
      luminance(moonlight(sky.moon_phase)) * moon_share * sunlight_in_space();
  if (!model.panorama && from_moon != glm::dvec3(0.0) && lights_air(sky.to_moon.y, horizon)) {
    c.moon.light = from_moon;
    set_scattering(model, 1, height_km, sky.to_moon.y, before);
  }
  // A linear law's mean over the disc is 1 - u / 3: the darkened disc sends the sun's whole
  // irradiance.
  const glm::dvec3 limb(shared::kLimbRed, shared::kLimbGreen, shared::kLimbBlue);
  const double sine = std::sin(static_cast<double>(shared::kDiscRadius));
  c.sun_disc = space_to(height_km, sky.to_sun.y) / (sine * sine * (1.0 - limb / 3.0));
  // By day the moon's ground is an eighth of white (its albedo); at night, as an eye would, it is
  // seen darker, or no display could show its face.
  const double night = 1.0 - smooth_step(-12.0, 2.0, altitude_deg(sky.to_sun.y));
  c.moon_disc = glm::mix(0.12, 0.013, night) * space_to(height_km, sky.to_moon.y);
  if (!sky.sun_exists) c.sun_disc = glm::vec3(0.0f);
  if (!sky.moon_exists) c.moon_disc = glm::vec3(0.0f);
  const std::array<glm::dvec3, 3> sun = light_axes(sky.to_sun), moon = light_axes(sky.to_moon);
  c.sun_right = sun[0] / sine;
  c.sun_up = sun[1] / sine;
  c.moon_right = moon[0] / sine;
  c.moon_up = moon[1] / sine;
  c.moon_lit = glm::dvec3(glm::dot(moon[0], sky.to_sun), glm::dot(moon[1], sky.to_sun),
                          -glm::dot(sky.to_moon, sky.to_sun));
  const glm::mat3 rows = glm::transpose(sky.sky_from_world);
  c.sky_x = rows[0];
  c.sky_y = rows[1];
  c.sky_z = rows[2];
  // A risen full moon drowns two thirds of the stars' light.
  const double moonlit = luminance(sky.moon_irradiance) / (kMoonToSun * kPi);
  c.stars = static_cast<float>((1.0 - smooth_step(-13.0, -5.0, altitude_deg(sky.to_sun.y))) *
                               (1.0 - 0.66 * std::min(1.0, moonlit)));
  if (model.panorama) c.stars = 0.0f;
  return model;
}

SkyScattering scattering_of_bodies(const SkyModel& sky) {
  constexpr std::size_t kEach = std::size_t{shared::kSkyLutHeight} * shared::kSkyAzimuths;
  SkyScattering all;
  all.reserve(shared::kBodyCount * kEach);
  for (const std::shared_ptr<const BodyScattering>& one : sky.scattering)
    if (one)
      all.insert(all.end(), one->table.begin(), one->table.end());
    else
      all.insert(all.end(), kEach, shared::SkyScatter{});
  return all;
}

double eye_height_km(double blocks_above_origin) {
  constexpr double kLowestKm = 1e-3, kHighestKm = 1000.0;
  const double height =
      std::clamp(blocks_above_origin * 1e-3 + kWorldAboveMistKm, kLowestKm, kHighestKm);
  return on_height_lattice(height, 7.0, kLowestKm);
}

double eye_height_km(const FrameInput& input) {
  return eye_height_km(static_cast<double>(input.camera.position[1] - input.anchor[1]) / 65536.0);
}

namespace {

/// Calls fn(BodyInSky, ScatterRow) for sun and moon as far as they are in the sky.
/// @param sine of the elevation of the directions that are asked about.
template <class Fn>
void for_each_body(const SkyModel& sky, double sine, const Fn& fn) {
  const double place = sky_row_place(std::asin(std::clamp(sine, -1.0, 1.0)),
                                     static_cast<double>(sky.constants.horizon));
  const std::array<const shared::SkyBody*, 2> bodies{&sky.constants.sun, &sky.constants.moon};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (sky.scattering[i]) fn(BodyInSky(*bodies[i]), ScatterRow(sky.scattering[i]->table, place));
}

}  // namespace

glm::dvec3 sky_radiance(glm::dvec3 dir, const SkyModel& sky) {
  if (sky.panorama) return sky.panorama->radiance(dir);
  glm::dvec3 radiance(0.0);
  for_each_body(sky, dir.y, [&](const BodyInSky& body, const ScatterRow& row) {
    radiance += body.radiance(dir, [&](std::size_t x) { return row.column(x); });
  });
  return radiance;
}

void sky_radiance(std::span<const glm::dvec3> dirs, const SkyModel& sky,
                  std::span<glm::dvec3> radiance) {
  std::ranges::fill(radiance, glm::dvec3(0.0));
  if (sky.panorama || dirs.empty()) {
    for (std::size_t i = 0; i < dirs.size(); ++i) radiance[i] = sky_radiance(dirs[i], sky);
    return;
  }
  for_each_body(sky, dirs.front().y, [&](const BodyInSky& body, const ScatterRow& row) {
    std::array<ScatterColumn, shared::kSkyAzimuths> columns;
    for (std::size_t x = 0; x < columns.size(); ++x) columns[x] = row.column(x);
    for (std::size_t k = 0; k < dirs.size(); ++k)
      radiance[k] +=
          body.radiance(dirs[k], [&](std::size_t x) -> const ScatterColumn& { return columns[x]; });
  });
}

float air_light(const Celestial& sky) {
  constexpr float kFullAt = 0.05f;
  const float sun = glm::dot(sky.sun_irradiance, glm::vec3(1.0f / 3.0f));
  const float moon =
      glm::dot(sky.moon_irradiance, glm::vec3(1.0f / 3.0f)) / static_cast<float>(kMoonToSun);
  return glm::smoothstep(0.0f, kFullAt, sky.sun_casts ? sun : moon);
}

}  // namespace skerry::render
