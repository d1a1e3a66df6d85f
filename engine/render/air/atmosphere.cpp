#include "engine/render/air/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <numbers>
#include <span>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/jobs.h"

namespace skerry::render {
namespace {

constexpr double kBottom = kMistRadiusKm, kTop = kAirRadiusKm;
const double kHorizonKm = std::sqrt(kTop * kTop - kBottom * kBottom);

/// Of a table by the sine of the body's elevation.
glm::dvec3 at_sine(const std::array<glm::dvec3, kMomentSines>& table, double sine) {
  const Between at = between_sines(sine);
  const auto first = static_cast<std::size_t>(at.first);
  return glm::mix(table[first], table[first + 1], at.share);
}

/// Distance to space of a ray that does not meet the ground. @param r from the sphere's middle.
double to_space(double r, double sine) {
  return -r * sine + std::sqrt(std::max(0.0, r * r * (sine * sine - 1.0) + kTop * kTop));
}

glm::dvec3 along_ray(const std::vector<glm::vec3>& table, double height_km, double sine) {
  const double r = kBottom + std::clamp(height_km, 0.0, kAirDepthKm);
  const double rho = std::sqrt(std::max(0.0, r * r - kBottom * kBottom));
  const double s = std::max(sine, -rho / r);  // the horizon's
  const double d = to_space(r, s);
  const double least = kTop - r, most = rho + kHorizonKm;
  constexpr int kWidth = Atmosphere::kTransmittanceSines;
  const Between x = between((d - least) / (most - least), kWidth),
                y = between(rho / kHorizonKm, Atmosphere::kTransmittanceHeights);
  const glm::vec3* row = table.data() + static_cast<std::ptrdiff_t>(y.first) * kWidth + x.first;
  return glm::mix(glm::mix(glm::dvec3(row[0]), glm::dvec3(row[1]), x.share),
                  glm::mix(glm::dvec3(row[kWidth]), glm::dvec3(row[kWidth + 1]), x.share), y.share);
}

/// Part of a disc of 0.53 degrees that stands above the horizon.
double risen_part(double height_km, double sine) {
  constexpr double kDiscSine = 0.004625;
  const double risen =
      std::clamp((sine - horizon_sine(height_km)) / (2.0 * kDiscSine) + 0.5, 0.0, 1.0);
  return risen * risen * (3.0 - 2.0 * risen);
}

}  // namespace

/// Fills the tables: what needs some of them while it makes the others.
class AtmosphereMaker {
 public:
  explicit AtmosphereMaker(Atmosphere& made) : made_(made) {}

  void make() {
    make_transmittance();
    make_moments();
  }

 private:
  static constexpr int kElevations = 8;  // each above and below the horizon
  static constexpr int kAzimuths = 6;    // of half a turn
  static constexpr int kPathSteps = 16;
  static constexpr int kOrders = 3;  // that are integrated

  /// Optical depths of a ray to space, by extinction and by dimming.
  struct Depths {
    glm::dvec3 extinction{0.0}, dimming{0.0};
  };

  Depths depths_upwards(double r, double sine) const {
    constexpr int kParts = 32;
    const double length = to_space(r, sine);
    Depths sum;
    for (int i = 0; i < kParts; ++i) {
      // Denser where the air is.
      const double s = (i + 0.5) / kParts, t = length * s * s;
      const double h = std::sqrt(r * r + t * t + 2.0 * r * sine * t) - kBottom;
      const AirSample here = made_.air_.at(h);
      sum.extinction += here.extinction * (2.0 * s * length / kParts);
      sum.dimming += here.dimming * (2.0 * s * length / kParts);
    }
    return sum;
  }

  /// Of a ray that does not meet the ground: down to the lowest place and up again.
  Depths depths(double r, double sine) const {
    if (sine >= 0.0) return depths_upwards(r, sine);
    const double lowest = std::max(kBottom, r * std::sqrt(1.0 - sine * sine));
    const Depths half = depths_upwards(lowest, 0.0), beyond = depths_upwards(r, -sine);
    return {glm::max(2.0 * half.extinction - beyond.extinction, 0.0),
            glm::max(2.0 * half.dimming - beyond.dimming, 0.0)};
  }

  void make_transmittance() {
    constexpr int kWidth = Atmosphere::kTransmittanceSines;
    for (int j = 0; j < Atmosphere::kTransmittanceHeights; ++j)
      for (int i = 0; i < kWidth; ++i) {
        const double rho = kHorizonKm * j / (Atmosphere::kTransmittanceHeights - 1.0);
        const double r = std::sqrt(rho * rho + kBottom * kBottom);
        const double least = kTop - r, most = rho + kHorizonKm;
        const double d = least + (most - least) * i / (kWidth - 1.0);
        const double sine =
            d == 0.0 ? 1.0 : (kHorizonKm * kHorizonKm - rho * rho - d * d) / (2.0 * r * d);
        const Depths all = depths(r, std::clamp(sine, -1.0, 1.0));
        made_.transmittance_.emplace_back(glm::exp(-all.extinction));
        made_.dimming_.emplace_back(glm::exp(-all.dimming));
      }
  }

  struct Direction {
    double sine, weight;  // solid angle
  };

  static std::array<Direction, 2 * kElevations> directions(double height) {
    // Gauss and Legendre, 8 points of [-1, 1].
    constexpr std::array<double, 4> kAt{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                        0.9602898564975363};
    constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};
    static_assert(kElevations == 2 * kAt.size());
    std::array<Direction, 2 * kElevations> out{};
    const double horizon = horizon_sine(height);
    std::size_t n = 0;
    for (const auto& [low, high] : {std::pair{-1.0, horizon}, std::pair{horizon, 1.0}})
      for (std::size_t i = 0; i < kAt.size(); ++i)
        for (const double side : {-1.0, 1.0})
          out[n++] = {0.5 * (low + high) + 0.5 * (high - low) * side * kAt[i],
                      std::numbers::pi * (high - low) * kWeight[i]};
    return out;
  }

  /// One order of scattering, as the next one needs it.
  struct Order {
    MomentTable moments;             // empty: light that comes straight from the body
    Atmosphere::OnGround on_ground;  // what it sends to the ground
  };

  /// A path, and what `last` makes its steps send; of light straight from the body, nothing.
  struct LitPath {
    AirPath path;
    std::vector<StepLight> again;
  };

  LitPath lit_path(double height, double sine, const Order& last) const {
    LitPath out{air_path(made_.air_, height, sine, kPathSteps), {}};
    if (last.moments.empty()) return out;
    for (const AirStep& step : out.path.steps)
      out.again.push_back({last.moments, step, made_.settings_.degree});
    return out;
  }

  /// Radiance along a path of what `last` scatters.
  glm::dvec3 scattered(LitPath& lit, double cos_azimuth, double body_sine,
                       const Order& last) const {
    const AirPath& path = lit.path;
    const double body_flat = std::sqrt(1.0 - body_sine * body_sine) * cos_azimuth;
    const double cosine = path.sine * body_sine + path.flat * body_flat;
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < path.steps.size(); ++i) {
      const AirStep& step = path.steps[i];
      const double sine = step.body_sine(path, body_sine, body_flat);
      if (lit.again.empty())
        sum += (step.rayleigh * rayleigh_phase(cosine) +
                step.mie * ((1.0 - kForward) * smooth_mie_phase(cosine, made_.settings_.degree))) *
               made_.scattering_light(step.height, sine);
      else
        sum += lit.again[i].at(sine, cosine);
    }
    if (path.meets_ground) {
      const double sine = path.ground_body_sine(body_sine, body_flat);
      sum += path.end * made_.settings_.ground_albedo / std::numbers::pi *
             at_sine(last.on_ground, sine);
    }
    return sum;
  }

  Order straight() const {
    Order order;
    for (int i = 0; i < kMomentSines; ++i)
      order.on_ground[static_cast<std::size_t>(i)] =
          std::max(0.0, moment_sine(i)) * made_.scattering_light(0.0, moment_sine(i));
    return order;
  }

  /// What one direction of view adds to the moments of all places of the body.
  void add_view(const Direction& view, double height, const Order& last,
                std::span<LightMoments> moments, std::span<glm::dvec3> down) const {
    LitPath path = lit_path(height, view.sine, last);
    const std::array<float, kLightTerms> elevation = elevation_harmonics(view.sine);
    for (std::size_t i = 0; i < moments.size(); ++i) {
      std::array<glm::vec4, kLightDegrees> rounds{};
      for (int a = 0; a < kAzimuths; ++a) {
        const double across = std::cos(std::numbers::pi * (a + 0.5) / kAzimuths);
        const glm::dvec3 light = view.weight / kAzimuths *
                                 scattered(path, across, moment_sine(static_cast<int>(i)), last);
        const std::array<float, kLightDegrees> azimuth =
            azimuth_harmonics(view.sine, path.path.flat * across);
        for (std::size_t m = 0; m < kLightDegrees; ++m)
          rounds[m] += glm::vec4(light, 0.0) * azimuth[m];
        down[i] += light * std::max(0.0, view.sine);
      }
      for (std::size_t l = 0; l < kLightDegrees; ++l)
        for (std::size_t m = 0; m <= l; ++m)
          moments[i][light_term(l, m)] += rounds[m] * elevation[light_term(l, m)];
    }
  }

  Order next(const Order& last) {
    Order order;
    order.moments.resize(static_cast<std::size_t>(kMomentSines) * kMomentHeights);
    // Heights do not depend on each other.
    jobs_.parallel_for(kMomentHeights, [&](int j) {
      Atmosphere::OnGround down{};
      const auto moments = std::span(order.moments)
                               .subspan(static_cast<std::size_t>(j) * kMomentSines, kMomentSines);
      for (const Direction& view : directions(moment_height(j)))
        add_view(view, moment_height(j), last, moments, down);
      if (j == 0) order.on_ground = down;
    });
    return order;
  }

  void make_moments() {
    Order last = straight();
    made_.moments_.assign(static_cast<std::size_t>(kMomentSines) * kMomentHeights, {});
    for (int n = 1; n <= kOrders; ++n) {
      Order now = next(last);
      for (std::size_t at = 0; at < now.moments.size(); ++at) {
        // The last order stands for all that follow: a geometric series of its own ratio.
        glm::vec4 tail(1.0f);
        if (n == kOrders)
          for (int c = 0; c < 3; ++c) {
            const float before = last.moments[at][0][c], here = now.moments[at][0][c];
            const float ratio = before > 0.0f ? std::clamp(here / before, 0.0f, 0.9f) : 0.0f;
            tail[c] = 1.0f / (1.0f - ratio);
          }
        for (std::size_t t = 0; t < kLightTerms; ++t)
          made_.moments_[at][t] += now.moments[at][t] * tail;
      }
      for (std::size_t i = 0; i < now.on_ground.size(); ++i)
        made_.sky_on_ground_[i] += now.on_ground[i];
      last = std::move(now);
    }
  }

  Atmosphere& made_;
  Jobs jobs_;
};

Atmosphere::Atmosphere(const AtmosphereSettings& settings)
    : settings_(settings), air_(settings.turbidity) {
  SKERRY_ASSERT(settings.degree >= 0 && settings.degree <= kLightDegree);
  AtmosphereMaker(*this).make();
}

glm::dvec3 Atmosphere::transmittance(double height_km, double sine) const {
  return along_ray(transmittance_, height_km, sine);
}

glm::dvec3 Atmosphere::direct_light(double height_km, double sine) const {
  const double part = risen_part(height_km, sine);
  return part == 0.0 ? glm::dvec3(0.0) : part * transmittance(height_km, sine);
}

glm::dvec3 Atmosphere::scattering_light(double height_km, double sine) const {
  const double part = risen_part(height_km, sine);
  return part == 0.0 ? glm::dvec3(0.0) : part * along_ray(dimming_, height_km, sine);
}

glm::dvec3 Atmosphere::ground(double sine) const {
  return settings_.ground_albedo / std::numbers::pi *
         (at_sine(sky_on_ground_, sine) + std::max(0.0, sine) * scattering_light(0.0, sine));
}

const Atmosphere& world_atmosphere() {
  static const Atmosphere atmosphere;
  return atmosphere;
}

}  // namespace skerry::render
