#include "engine/render/air/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <numbers>

namespace skerry::render {
namespace {

constexpr double kBottom = kMistRadiusKm, kTop = kAirRadiusKm;
const double kHorizonKm = std::sqrt(kTop * kTop - kBottom * kBottom);

// Moments of the phase functions, degrees 0 to 2: of molecules; of aerosol, without kForward.
constexpr std::array<float, 3> kMolecules{1.0f, 0.0f, 0.1f};
constexpr float moment(double whole) {
  return static_cast<float>((whole - kForward) / (1.0 - kForward));
}
constexpr std::array<float, 3> kAerosol{1.0f, moment(0.8436364), moment(0.7096623)};

constexpr std::size_t kTerms = std::tuple_size_v<LightMoments>;
constexpr std::array<std::size_t, kTerms> kDegree{0, 1, 1, 2, 2, 2};

/// A place between the entries of a row of `count`.
struct Between {
  int first;
  double share;
};

Between between(double place, int count) {
  const double at = std::clamp(place, 0.0, 1.0) * (count - 1);
  const int first = std::min(static_cast<int>(at), count - 2);
  return {first, at - first};
}

/// Finer about the horizon, where light changes fastest. What is lower than kLowestSine lights no
/// air at all.
constexpr double kLowestSine = 0.35;
double place_of_sine(double sine) {
  return sine < 0.0 ? 0.5 - 0.5 * std::sqrt(-sine / kLowestSine) : 0.5 + 0.5 * std::sqrt(sine);
}
double sine_of_place(double place) {
  const double root = 2.0 * place - 1.0;
  return root < 0.0 ? -kLowestSine * root * root : root * root;
}

/// Of a table by the sine of the body's elevation.
glm::dvec3 at_sine(const std::array<glm::dvec3, Atmosphere::kMomentSines>& table, double sine) {
  const Between at = between(place_of_sine(sine), Atmosphere::kMomentSines);
  const auto first = static_cast<std::size_t>(at.first);
  return glm::mix(table[first], table[first + 1], at.share);
}

/// Finer towards the ground.
double place_of_height(double height) {
  return std::sqrt(std::max(0.0, height) / kAirDepthKm);
}
double height_of_place(double place) {
  return place * place * kAirDepthKm;
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

/// The harmonics of LightMoments in a direction. @param towards its horizontal part along the
/// body's.
std::array<float, kTerms> light_harmonics(double sine, double towards) {
  const auto z = static_cast<float>(sine), x = static_cast<float>(towards);
  const float flat2 = std::max(0.0f, 1.0f - z * z);
  return {0.2820948f,         0.4886025f * z,
          0.4886025f * x,     0.3153916f * (3.0f * z * z - 1.0f),
          1.0925484f * x * z, 0.5462742f * (2.0f * x * x - flat2)};
}

/// A direction's horizontal part along a body's. @param cosine of the angle between the two.
double towards_body(double view_sine, double body_sine, double cosine) {
  const double flat = std::sqrt(std::max(0.0, 1.0 - body_sine * body_sine));
  const double most = std::sqrt(std::max(0.0, 1.0 - view_sine * view_sine));
  if (flat < 1e-6) return 0.0;
  return std::clamp((cosine - view_sine * body_sine) / flat, -most, most);
}

glm::dvec3 again(const std::vector<LightMoments>& moments, const AirStep& step, double sine,
                 double cosine) {
  constexpr int kWidth = Atmosphere::kMomentSines;
  const Between x = between(place_of_sine(sine), kWidth),
                y = between(place_of_height(step.height), Atmosphere::kMomentHeights);
  const LightMoments* row =
      moments.data() + static_cast<std::ptrdiff_t>(y.first) * kWidth + x.first;
  const auto x1 = static_cast<float>(x.share), y1 = static_cast<float>(y.share);
  const float w00 = (1.0f - x1) * (1.0f - y1), w01 = x1 * (1.0f - y1), w10 = (1.0f - x1) * y1,
              w11 = x1 * y1;
  const std::array<float, kTerms> basis =
      light_harmonics(step.view_sine, towards_body(step.view_sine, sine, cosine));
  glm::vec3 molecules(0.0f), aerosol(0.0f);
  for (std::size_t i = 0; i < kTerms; ++i) {
    const glm::vec3 light =
        (row[0][i] * w00 + row[1][i] * w01 + row[kWidth][i] * w10 + row[kWidth + 1][i] * w11) *
        basis[i];
    molecules += light * kMolecules[kDegree[i]];
    aerosol += light * kAerosol[kDegree[i]];
  }
  return step.rayleigh * glm::dvec3(molecules) + step.mie * (1.0 - kForward) * glm::dvec3(aerosol);
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
  static constexpr int kElevations = 6;  // each above and below the horizon
  static constexpr int kAzimuths = 5;    // of half a turn
  static constexpr int kPathSteps = 16;
  static constexpr int kOrders = 3;  // that are integrated
  static constexpr int kSines = Atmosphere::kMomentSines, kHeights = Atmosphere::kMomentHeights;

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
    // Gauss and Legendre, 6 points of [-1, 1].
    constexpr std::array<double, 3> kAt{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
    constexpr std::array<double, 3> kWeight{0.4679139345726910, 0.3607615730481386,
                                            0.1713244923791704};
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

  static double node_height(int j) { return height_of_place(j / (kHeights - 1.0)); }
  static double node_sine(int i) { return sine_of_place(i / (kSines - 1.0)); }

  /// Aerosol's phase function without kForward, to the second degree.
  static double smooth_phase(double c) {
    return (1.0 + 3.0 * kAerosol[1] * c + 2.5 * kAerosol[2] * (3.0 * c * c - 1.0)) /
           (4.0 * std::numbers::pi);
  }

  /// One order of scattering, as the next one needs it.
  struct Order {
    Atmosphere::Moments moments;     // empty: light that comes straight from the body
    Atmosphere::OnGround on_ground;  // what it sends to the ground
  };

  /// Radiance along a path of what `last` scatters.
  glm::dvec3 scattered(const AirPath& path, double cos_azimuth, double body_sine,
                       const Order& last) const {
    const double body_flat = std::sqrt(1.0 - body_sine * body_sine) * cos_azimuth;
    const double cosine = path.sine * body_sine + path.flat * body_flat;
    glm::dvec3 sum(0.0);
    for (const AirStep& step : path.steps) {
      const double sine = step.body_sine(path, body_sine, body_flat);
      if (last.moments.empty())
        sum += (step.rayleigh * rayleigh_phase(cosine) +
                step.mie * ((1.0 - kForward) * smooth_phase(cosine))) *
               made_.scattering_light(step.height, sine);
      else
        sum += again(last.moments, step, sine, cosine);
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
    for (int i = 0; i < kSines; ++i)
      order.on_ground[static_cast<std::size_t>(i)] =
          std::max(0.0, node_sine(i)) * made_.scattering_light(0.0, node_sine(i));
    return order;
  }

  Order next(const Order& last) const {
    Order order;
    for (int j = 0; j < kHeights; ++j) {
      const auto views = directions(node_height(j));
      std::vector<AirPath> paths;
      for (const Direction& view : views)
        paths.push_back(air_path(made_.air_, node_height(j), view.sine, kPathSteps));
      for (int i = 0; i < kSines; ++i) {
        LightMoments moments{};
        glm::dvec3 down(0.0);
        for (std::size_t k = 0; k < views.size(); ++k)
          for (int a = 0; a < kAzimuths; ++a) {
            const double across = std::cos(std::numbers::pi * (a + 0.5) / kAzimuths);
            const glm::dvec3 light =
                views[k].weight / kAzimuths * scattered(paths[k], across, node_sine(i), last);
            const std::array<float, kTerms> basis =
                light_harmonics(views[k].sine, paths[k].flat * across);
            for (std::size_t t = 0; t < kTerms; ++t) moments[t] += glm::vec3(light) * basis[t];
            if (j == 0) down += light * std::max(0.0, views[k].sine);
          }
        order.moments.push_back(moments);
        if (j == 0) order.on_ground[static_cast<std::size_t>(i)] = down;
      }
    }
    return order;
  }

  void make_moments() {
    Order last = straight();
    made_.moments_.assign(static_cast<std::size_t>(kSines) * kHeights, {});
    for (int n = 1; n <= kOrders; ++n) {
      Order now = next(last);
      for (std::size_t at = 0; at < now.moments.size(); ++at) {
        // The last order stands for all that follow: a geometric series of its own ratio.
        glm::vec3 tail(1.0f);
        if (n == kOrders)
          for (int c = 0; c < 3; ++c) {
            const float before = last.moments[at][0][c], here = now.moments[at][0][c];
            const float ratio = before > 0.0f ? std::clamp(here / before, 0.0f, 0.9f) : 0.0f;
            tail[c] = 1.0f / (1.0f - ratio);
          }
        for (std::size_t t = 0; t < kTerms; ++t) made_.moments_[at][t] += now.moments[at][t] * tail;
      }
      for (std::size_t i = 0; i < now.on_ground.size(); ++i)
        made_.sky_on_ground_[i] += now.on_ground[i];
      last = std::move(now);
    }
  }

  Atmosphere& made_;
};

Atmosphere::Atmosphere(const AtmosphereSettings& settings)
    : settings_(settings), air_(settings.turbidity) {
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

glm::dvec3 Atmosphere::scattered_again(const AirStep& step, double sine, double cosine) const {
  return again(moments_, step, sine, cosine);
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
