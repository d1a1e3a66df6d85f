#include "tools/skerry/report/sky_topic.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "engine/core/clock.h"
#include "engine/core/jobs.h"
#include "engine/render/air/atmosphere.h"
#include "engine/render/air/sky_scattering.h"
#include "engine/render/frame/celestial.h"
#include "tools/reference/air_paths.h"
#include "tools/reference/reference.h"

namespace skerry::tools {
namespace {

using render::Atmosphere;

constexpr double kPi = std::numbers::pi;
/// Half of the sky, which is as wide as the other one: from the sun's azimuth to the opposite one,
/// from 20 degrees below the horizon to the zenith.
constexpr std::uint32_t kWidth = 24, kHeight = 14;
constexpr double kLowestDeg = -20.0, kHighestDeg = 90.0;
constexpr int kPaths = 3000;  // a pixel and channel
constexpr int kOnceSteps = 400;
constexpr int kTimed = 5;

glm::dvec3 direction_of(std::uint32_t x, std::uint32_t y) {
  const double turn = kPi * (x + 0.5) / kWidth;
  const double elevation =
      (kHighestDeg + (kLowestDeg - kHighestDeg) * (y + 0.5) / kHeight) * kPi / 180.0;
  return {std::cos(elevation) * std::cos(turn), std::sin(elevation),
          std::cos(elevation) * std::sin(turn)};
}

/// The sun at azimuth 0 of such a picture.
glm::dvec3 to_sun(double sine) {
  return {std::sqrt(1.0 - sine * sine), sine, 0.0};
}

struct Truth {
  measure::Picture radiance;
  double standard_error = 0.0;  ///< over the mean radiance
};

Truth by_paths(double sun_sine, const std::function<void(double)>& progress) {
  Truth out{{kWidth, kHeight, std::vector<glm::vec3>(std::size_t{kWidth} * kHeight)}, 0.0};
  std::vector<double> errors(out.radiance.pixels.size());
  const glm::dvec3 sun = to_sun(sun_sine),
                   eye{0.0, render::kMistRadiusKm + render::kWorldAboveMistKm, 0.0};
  std::atomic<int> rows = 0;
  Jobs jobs;
  jobs.parallel_for(static_cast<int>(kHeight), [&](int row) {
    const auto y = static_cast<std::uint32_t>(row);
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const std::size_t at = std::size_t{y} * kWidth + x;
      const glm::dvec3 d = direction_of(x, y);
      glm::dvec3 light;
      for (int c = 0; c < 3; ++c) {
        const reference::Gas gas = reference::gas(c, render::kTurbidity, render::kMistAlbedo);
        const reference::Estimate more =
            reference::AirPaths(gas, sun, static_cast<unsigned>(3 * at) + static_cast<unsigned>(c))
                .more_than_once(eye, d, kPaths);
        light[c] = more.mean + reference::scattered_once(gas, eye, d, sun, kOnceSteps);
        errors[at] += more.error / 3.0;
      }
      out.radiance.pixels[at] = glm::vec3(light * render::sunlight_in_space());
    }
    progress(++rows / static_cast<double>(kHeight));
  });
  double light = 0.0, error = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const glm::dvec3 radiance = glm::dvec3(out.radiance.pixels[i]) / render::sunlight_in_space();
    light += (radiance.x + radiance.y + radiance.z) / 3.0;
    error += errors[i];
  }
  out.standard_error = error / light;
  return out;
}

measure::Picture by_tables(const Atmosphere& air, double sun_sine) {
  measure::Picture out{kWidth, kHeight, {}};
  const glm::dvec3 sun = to_sun(sun_sine);
  for (std::uint32_t y = 0; y < kHeight; ++y)
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const glm::dvec3 d = direction_of(x, y);
      const shared::SkyScatter s = render::sky_scattering_at(
          air, render::kWorldAboveMistKm, sun_sine, d.y, d.x / std::hypot(d.x, d.z));
      const double cosine = glm::dot(d, sun);
      out.pixels.emplace_back((glm::dvec3(s.rayleigh) * render::rayleigh_phase(cosine) +
                               glm::dvec3(s.mie) * render::mie_phase(cosine) +
                               glm::dvec3(s.multiple)) *
                              render::sunlight_in_space());
    }
  return out;
}

/// Of all tables: those of the atmosphere, and one of what an eye's air scatters.
double tables_ms(const render::AtmosphereSettings& settings, double sun_sine) {
  const Stopwatch watch;
  const Atmosphere air(settings);
  render::sky_scattering(air, render::kWorldAboveMistKm, sun_sine);
  return 1e3 * watch.seconds();
}

}  // namespace

SceneRows measure_sky(const Topic& topic, const std::string& name, const game::SceneOptions& scene,
                      const std::function<void(double, std::string_view)>& progress) {
  SceneRows out{name, game::shot_command(scene), kTimed, {}, {}, {}, 0.0, {}};
  const std::string what = fmt::format("{} in {}", topic.name, name);
  const double sine = render::celestial_at(scene.time_of_day_s, 0.0).to_sun.y;
  const Truth truth =
      by_paths(sine, [&](double share) { progress(0.7 * share, what + ": paths"); });
  Judged reference{truth.radiance, {}, 0.0, truth.standard_error};
  reference.ev = reference::metered_ev(truth.radiance, {}).value_or(0.0);
  const auto develop = [&](const measure::Picture& radiance) {
    return measure::Image{kWidth, kHeight, reference::develop(radiance, reference.ev)};
  };
  reference.shown = develop(truth.radiance);
  out.reference = reference.shown;
  out.reference_standard_error = truth.standard_error;
  std::vector<Shot> shots;
  std::vector<render::AtmosphereSettings> settings;
  for (const TopicPoint& point : topic.points) {
    settings.emplace_back().degree = point.sky_degree.value_or(render::kLightDegree);
    const measure::Picture radiance = by_tables(Atmosphere(settings.back()), sine);
    shots.push_back({develop(radiance), radiance, reference.ev});
  }
  std::vector<std::vector<double>> ms(topic.points.size());
  for (int round = 0; round < kTimed; ++round) {
    progress(0.7 + 0.3 * round / kTimed, what + ": times");
    for (std::size_t p = 0; p < ms.size(); ++p) ms[p].push_back(tables_ms(settings[p], sine));
  }
  finish_rows(topic, shots, ms, &reference, out);
  return out;
}

}  // namespace skerry::tools
