// Panoramas: texels that no light has, many made few, their sides, and one texel that holds all
// light.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "engine/render/sky/panorama_sky.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/directions.h"

namespace skerry::tools::stability {
namespace {

using render::Panorama;
using render::PanoramaMaker;
using render::PanoramaSky;
using std::numbers::pi;

/// @param texel (column, row).
template <class Texel>
Panorama made(std::uint32_t columns, std::uint32_t most_columns, const Texel& texel) {
  const std::uint32_t rows = columns / 2;
  PanoramaMaker maker(columns, rows, most_columns);
  std::vector<glm::vec3> row(columns);
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) row[i] = texel(i, j);
    maker.add_row(row);
  }
  return maker.take();
}

/// Radiance times solid angle, of all texels.
glm::dvec3 light_of(const Panorama& panorama) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t j = 0; j < panorama.rows; ++j) {
    glm::dvec3 row(0.0);
    for (std::uint32_t i = 0; i < panorama.columns; ++i) row += glm::dvec3(panorama.at(i, j));
    sum += row * render::panorama_solid_angle(panorama.columns, panorama.rows, j);
  }
  return sum;
}

template <class Vec>
bool is_light(const Vec& c) {
  return std::isfinite(c.x + c.y + c.z) && std::min({c.x, c.y, c.z}) >= 0;
}

/// As a file may have them: every eighth texel is no radiance.
Result<Rows> wrong_texels() {
  constexpr float kWrong[]{
      std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
      -std::numeric_limits<float>::infinity(), -1.0f,
      std::numeric_limits<float>::max(),       -0.0f,
      std::numeric_limits<float>::denorm_min()};
  double wrong = 0.0, light = 0.0;
  for (const std::uint32_t columns : {2u, 64u, 200u})
    for (const std::uint32_t most : {64u, 4096u}) {
      const PanoramaSky sky(made(columns, most,
                                 [&](std::uint32_t i, std::uint32_t j) {
                                   const std::uint32_t n = i + 3 * j;
                                   return n % 8 != 0 ? glm::vec3(1.0f)
                                                     : glm::vec3(kWrong[n / 8 % 7], 1.0f,
                                                                 kWrong[n / 56 % 7]);
                                 }),
                            {});
      for (const glm::vec3& texel : sky.image().texels) wrong += is_light(texel) ? 0.0 : 1.0;
      for (const glm::dvec3& d : even_directions(500)) {
        wrong += is_light(sky.radiance(d)) && is_light(sky.smooth().at(d)) ? 0.0 : 1.0;
        light += sky.radiance(d).y;
      }
      wrong += is_light(sky.mean()) ? 0.0 : 1.0;
    }
  return Rows{{"texels and directions negative or no number, panoramas of NaN, +-Inf and 3e38", 0.0,
               if_shown(light > 1.0, wrong)}};
}

/// Each mean is rounded once, to a float.
Result<Rows> many_made_few() {
  std::mt19937 random(5);
  std::exponential_distribution<float> radiance(1.0f);
  double most = 0.0;
  for (const std::uint32_t columns : {66u, 250u, 1000u}) {
    const Panorama whole = made(columns, columns, [&](std::uint32_t i, std::uint32_t j) {
      return glm::vec3(radiance(random), i == 7 && j == 3 ? 1e6f : 0.0f, j == 0 ? 1.0f : 0.0f);
    });
    const glm::dvec3 light = light_of(whole);
    for (const std::uint32_t few : {2u, 24u, 64u}) {
      const glm::dvec3 kept = light_of(render::reduced(whole, few));
      for (int c = 0; c < 3; ++c)
        most = std::max(most, if_shown(light[c] > 0.0, std::abs(kept[c] / light[c] - 1.0)));
    }
  }
  return Rows{{"relative change of a panorama's light as it is made smaller", 0x1p-24, most}};
}

/// Between two texels' centres radiance changes by their difference at most.
Result<Rows> sides() {
  constexpr std::uint32_t kColumns = 64;
  constexpr double kStep = 1e-9;  // rad
  std::mt19937 random(6);
  std::uniform_real_distribution<float> radiance(0.0f, 1.0f);
  const Panorama panorama = made(kColumns, kColumns, [&](std::uint32_t, std::uint32_t) {
    return glm::vec3(radiance(random));
  });
  const PanoramaSky sky(panorama, {});
  double most = 0.0;
  for (int turn = -64; turn <= 64; ++turn)
    for (double elevation = -1.5; elevation < 1.55; elevation += 0.1) {
      const auto towards = [&](double azimuth) {
        return sky.radiance({std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                             std::cos(elevation) * std::cos(azimuth)});
      };
      const double azimuth = turn * pi / 64.0;
      most = std::max(most, std::abs(towards(azimuth + kStep).x - towards(azimuth - kStep).x));
    }
  return Rows{{"change of radiance by 2e-9 rad, around a panorama of 64 columns of light 0 to 1",
               2.0 * kStep * kColumns / (2.0 * pi), most}};
}

/// Of what is seen, between the centres of texels too.
double seen_light(const PanoramaSky& sky) {
  constexpr int kRows = 1024;
  double sum = 0.0;
  for (int j = 0; j < kRows; ++j) {
    double row = 0.0;
    for (int i = 0; i < 2 * kRows; ++i)
      row += render::panorama_texel(sky.image(), {(i + 0.5) / (2 * kRows), (j + 0.5) / kRows}).y;
    sum += row * render::panorama_solid_angle(2 * kRows, kRows, static_cast<std::uint32_t>(j));
  }
  return sum;
}

/// What faces are lit by, against what is seen: the same light, spread over 20 degrees. A piece of
/// 3 degrees stands for its middle, and between texels of a cube, 4.5 degrees apart, the kernel is
/// a line: either may change it by a quarter of the square of that angle over the kernel's.
Result<Rows> one_bright_texel() {
  constexpr int kDirections = 20000;
  double most = 0.0;
  for (const std::uint32_t row : {0u, 20u, 32u, 63u}) {
    const Panorama panorama = made(128, 128, [&](std::uint32_t i, std::uint32_t j) {
      return i == 100 && j == row ? glm::vec3(1e6f) : glm::vec3(0.0f);
    });
    const PanoramaSky sky(panorama, {});
    double spread = 0.0;
    for (const glm::dvec3& d : even_directions(kDirections))
      spread += static_cast<double>(sky.smooth().at(d).y) * (4.0 * pi / kDirections);
    const double light = seen_light(sky);
    most = std::max(most, if_shown(light > 0.0, std::abs(spread / light - 1.0)));
  }
  return Rows{{"relative change of the light of one texel of 1e6 that is spread over faces",
               0.25 * (3.0 * 3.0 + 4.5 * 4.5) / (20.0 * 20.0), most}};
}

constexpr Case kPanoramaCases[] = {{"panorama.texels", wrong_texels},
                                   {"panorama.smaller", many_made_few},
                                   {"panorama.sides", sides},
                                   {"panorama.bright", one_bright_texel}};

}  // namespace

std::span<const Case> panorama_cases() {
  return kPanoramaCases;
}

}  // namespace skerry::tools::stability
