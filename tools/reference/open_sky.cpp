#include "tools/reference/open_sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

namespace skerry::reference {
namespace {

constexpr double kPi = std::numbers::pi;

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The hash that places stars and shapes the Milky Way. Part of the model: every device has the
/// same stars.
std::uint32_t sky_hash(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t h = x * 1664525u + y * 1013904223u + z * 374761393u;
  h = (h ^ h >> 15) * 2246822519u;
  h = (h ^ h >> 13) * 3266489917u;
  return h ^ h >> 16;
}

/// Value noise of a cubic lattice, smoothed, 0..1.
double noise(glm::dvec3 p) {
  const glm::dvec3 cell = glm::floor(p), f = p - cell;
  const glm::dvec3 weight = f * f * (3.0 - 2.0 * f);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> d{corner & 1, corner >> 1 & 1, corner >> 2};
    double share = 1.0;
    std::array<std::uint32_t, 3> at;
    for (int a = 0; a < 3; ++a) {
      share *= d[a] != 0 ? weight[a] : 1.0 - weight[a];
      at[a] = static_cast<std::uint32_t>(static_cast<std::int32_t>(cell[a]) + d[a]);
    }
    sum += share * (sky_hash(at[0], at[1], at[2]) >> 8);
  }
  return sum / 16777215.0;
}

/// Star clouds along a great circle, with a rift of dust. @param d in the frame of the stars.
glm::dvec3 milky_way(glm::dvec3 d) {
  constexpr double kRadiance = 3e-4;
  const double latitude = glm::dot(d, glm::dvec3(0.200, 0.871, 0.449));
  const double cloud = 0.6 * noise(d * 5.0 + 20.0) + 0.4 * noise(d * 13.0 + 40.0);
  const double rift = 0.55 * std::exp(-260.0 * latitude * latitude) * noise(d * 9.0 + 60.0);
  const double band = std::exp(-28.0 * latitude * latitude) * (0.35 + 1.1 * cloud) * (1.0 - rift);
  return glm::dvec3(0.92, 0.97, 1.15) * (kRadiance * band);
}

/// Stars show from here up: none below the horizon.
double stars_seen(glm::dvec3 direction, const Sky& sky) {
  return static_cast<double>(sky.model.constants.stars) * smooth_step(-0.05, 0.20, direction.y);
}

/// Where a direction meets a disc, in its radii; nothing outside.
std::optional<glm::dvec2> on_disc(glm::dvec3 direction, const shared::SkyBody& body,
                                  glm::vec3 right, glm::vec3 up) {
  if (glm::dot(direction, glm::dvec3(body.to_body)) <= 0.0) return std::nullopt;
  const glm::dvec2 p{glm::dot(direction, glm::dvec3(right)), glm::dot(direction, glm::dvec3(up))};
  if (glm::dot(p, p) >= 1.0) return std::nullopt;
  return p;
}

/// How dark the moon's ground is: plains about where the real ones are, and one bright crater.
double moon_ground(glm::dvec2 p) {
  const auto plain = [p](double x, double y, double radius) {
    const glm::dvec2 d = (p - glm::dvec2(x, y)) / radius;
    const double w = std::max(0.0, 1.0 - glm::dot(d, d));
    return w * (2.0 - w);
  };
  const double dark = plain(-0.22, 0.52, 0.36) + plain(0.22, 0.45, 0.26) + plain(0.40, 0.16, 0.28) +
                      plain(-0.55, 0.10, 0.42) + plain(-0.20, -0.32, 0.30) +
                      plain(0.66, 0.30, 0.15) + plain(0.58, -0.08, 0.22);
  return 1.0 - 0.52 * std::min(1.0, dark) + 0.12 * plain(-0.10, -0.68, 0.12);
}

// --- Stars: each face of a cube is divided into kCells^2 cells of about equal solid angle.

constexpr int kCells = 64;
constexpr double kShare = 0.24;        // of a face's middle cells hold a star
constexpr double kBrightest = 6.0e-7;  // magnitude 0 [radiance * sr]
constexpr double kFaintest = 2.5e-3;   // magnitude 6.5 over magnitude 0
constexpr double kFootprintPixels = 1.6;

struct Star {
  glm::dvec2 place;  // on the face [cells]
  glm::dvec3 flux;
};

glm::dvec3 star_colour(double t) {
  const glm::dvec3 end = t < 0.5 ? glm::dvec3(1.50, 0.90, 0.46) : glm::dvec3(0.80, 0.97, 1.75);
  const glm::dvec3 c = glm::mix(glm::dvec3(1.0), end, std::abs(2.0 * t - 1.0));
  return c / glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

std::optional<Star> star_of_cell(std::uint32_t face, int u, int v) {
  if (u < 0 || v < 0 || u >= kCells || v >= kCells) return std::nullopt;
  const std::uint32_t h =
      sky_hash(face, static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(v));
  const auto from_middle = [](int c) { return std::pow((c + 0.5) * 2.0 / kCells - 1.0, 2.0); };
  const double su = from_middle(u), sv = from_middle(v);
  // The cell's solid angle over a middle one's, fitted.
  const double share = kShare * (1.0 - 0.411 * (su + sv) + 0.356 * su * sv);
  if (static_cast<double>(h >> 20) >= share * 4096.0) return std::nullopt;
  const std::uint32_t k = (h ^ h >> 15) * 747796405u;
  glm::dvec2 place{u + (k & 0xfffu) / 4096.0, v + (k >> 12 & 0xfffu) / 4096.0};
  place = glm::clamp(place, 0.5, kCells - 0.5);
  // Numbers grow 3.4-fold a magnitude, so flux over the faintest is u^-3/4 of an even u.
  const double even = ((h & 0xfffffu) + 128.0) / 1048576.0;
  const double flux = kBrightest * kFaintest * std::pow(even, -0.75);
  return Star{place, star_colour((k >> 24) / 255.0) * flux};
}

/// A direction's place on the cube, and what squared angle an offset of one cell makes there.
struct CubePlace {
  std::uint32_t face;
  glm::dvec2 at;      // [cells]
  glm::dvec3 metric;  // of (du^2, du dv, dv^2) [rad^2]
};

CubePlace cube_place(glm::dvec3 d) {
  const glm::dvec3 m = glm::abs(d);
  const std::uint32_t axis = m.x >= m.y && m.x >= m.z ? 0 : m.y >= m.z ? 1 : 2;
  const glm::dvec3 turned = axis == 0   ? d
                            : axis == 1 ? glm::dvec3(d.y, d.z, d.x)
                                        : glm::dvec3(d.z, d.x, d.y);
  const glm::dvec2 uv = glm::dvec2(turned.y, turned.z) / std::abs(turned.x);
  CubePlace place;
  place.face = axis * 2 + (turned.x < 0.0 ? 1 : 0);
  place.at = (uv * (1.25 - 0.25 * glm::abs(uv)) + 1.0) * (0.5 * kCells);
  const glm::dvec2 per_cell = (2.0 / kCells) / (1.25 - 0.5 * glm::abs(uv));
  // First fundamental form of the gnomonic projection.
  const double q = 1.0 / (1.0 + glm::dot(uv, uv));
  place.metric = q * q *
                 glm::dvec3((1.0 + uv.y * uv.y) * per_cell.x * per_cell.x,
                            -2.0 * uv.x * uv.y * per_cell.x * per_cell.y,
                            (1.0 + uv.x * uv.x) * per_cell.y * per_cell.y);
  return place;
}

/// As a camera in the middle of the picture sees it that looks at the picture's own middle.
glm::dvec3 panorama_behind(glm::dvec3 direction, const render::PanoramaSky& panorama) {
  const render::Panorama& image = panorama.image();
  const glm::dvec3 ahead{std::sin(panorama.yaw()), 0.0, std::cos(panorama.yaw())};
  const glm::dvec3 right = glm::cross(ahead, glm::dvec3(0.0, 1.0, 0.0));
  const double to_right = std::atan2(glm::dot(direction, right), glm::dot(direction, ahead)),
               from_zenith = std::acos(std::clamp(direction.y, -1.0, 1.0));
  const double columns = image.columns, rows = image.rows;
  const double x = (to_right / (2.0 * kPi) + 0.5) * columns - 0.5,
               y = std::clamp(from_zenith / kPi * rows - 0.5, 0.0, rows - 1.0);
  glm::dvec3 sum(0.0);
  for (int corner = 0; corner < 4; ++corner) {
    const double i = std::floor(x) + (corner & 1), j = std::floor(y) + (corner >> 1);
    const double weight = (1.0 - std::abs(x - i)) * (1.0 - std::abs(y - j));
    const double around = i - columns * std::floor(i / columns);
    sum += weight * glm::dvec3(image.at(static_cast<std::uint32_t>(around),
                                        static_cast<std::uint32_t>(std::min(j, rows - 1.0))));
  }
  return sum;
}

}  // namespace

glm::dvec3 sky_behind(glm::dvec3 direction, const Sky& sky) {
  if (sky.model.panorama) return panorama_behind(direction, *sky.model.panorama);
  glm::dvec3 radiance = render::sky_radiance(direction, sky.model);
  const double seen = stars_seen(direction, sky);
  if (seen > 0.0) radiance += milky_way(sky.sky_from_world * direction) * seen;
  return radiance;
}

glm::dvec3 disc_radiance(glm::dvec3 direction, const Sky& sky) {
  const shared::SkyConstants& c = sky.model.constants;
  glm::dvec3 radiance(0.0);
  if (const auto p = on_disc(direction, c.sun, c.sun_right, c.sun_up)) {
    const double mu = std::sqrt(1.0 - glm::dot(*p, *p));
    const glm::dvec3 limb(shared::kLimbRed, shared::kLimbGreen, shared::kLimbBlue);
    radiance += glm::dvec3(c.sun_disc) * (1.0 - limb * (1.0 - mu));
  }
  if (const auto p = on_disc(direction, c.moon, c.moon_right, c.moon_up)) {
    const double mu = std::sqrt(1.0 - glm::dot(*p, *p));
    const double lit = std::max(0.0, glm::dot(glm::dvec3(*p, mu), glm::dvec3(c.moon_lit)));
    radiance += glm::dvec3(c.moon_disc) * (moon_ground(*p) * 2.0 * lit / std::max(lit + mu, 1e-3));
  }
  // The mist hides what has set.
  const double above = direction.y - static_cast<double>(c.horizon_sine);
  return radiance *
         std::clamp(above * static_cast<double>(shared::kHorizonSharpness) + 0.5, 0.0, 1.0);
}

bool moon_hides_stars(glm::dvec3 direction, const Sky& sky) {
  const shared::SkyConstants& c = sky.model.constants;
  return on_disc(direction, c.moon, c.moon_right, c.moon_up).has_value();
}

glm::dvec3 star_radiance(glm::dvec3 direction, double pixel_angle, const Sky& sky) {
  const double seen = stars_seen(direction, sky);
  if (seen == 0.0) return glm::dvec3(0.0);
  const CubePlace place = cube_place(sky.sky_from_world * direction);
  // Half a cell is 0.37 of a middle one at its narrowest; a star reaches no further.
  const double radius = std::min(kFootprintPixels * pixel_angle, 0.37 * 2.0 / (1.25 * kCells));
  const int u0 = static_cast<int>(std::floor(place.at.x - 0.5)),
            v0 = static_cast<int>(std::floor(place.at.y - 0.5));
  glm::dvec3 sum(0.0);
  for (int i = 0; i < 4; ++i) {
    const std::optional<Star> star = star_of_cell(place.face, u0 + (i & 1), v0 + (i >> 1));
    if (!star) continue;
    const glm::dvec2 d = place.at - star->place;
    const double angle2 = glm::dot(place.metric, glm::dvec3(d.x * d.x, d.x * d.y, d.y * d.y));
    const double w = std::max(0.0, 1.0 - angle2 / (radius * radius));
    sum += star->flux * (3.0 * w * w / (kPi * radius * radius));
  }
  return sum * seen;
}

}  // namespace skerry::reference
