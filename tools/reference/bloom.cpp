#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/reference/reference.h"

namespace skerry::reference {
namespace {

/// A level of the pyramid; black beyond its edges.
struct Level {
  int width = 0, height = 0;
  std::vector<glm::dvec3> texels;
  Level(int w, int h) : width(w), height(h), texels(static_cast<std::size_t>(w) * h) {}
  glm::dvec3 at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return glm::dvec3(0.0);
    return texels[static_cast<std::size_t>(y) * width + x];
  }
};

/// Mean of the 2x2 texels of which (x, y) is the upper left: a bilinear tap at their corner.
glm::dvec3 tap(const Level& level, int x, int y) {
  return 0.25 * (level.at(x, y) + level.at(x + 1, y) + level.at(x, y + 1) + level.at(x + 1, y + 1));
}

/// One texel of the next level: the 13 taps as Jimenez draws them, in five groups of four.
glm::dvec3 shrunk(const Level& fine, int x, int y, bool calm) {
  const auto group = [&](int dx, int dy) {
    return 0.25 * (tap(fine, x + dx, y + dy) + tap(fine, x + dx + 2, y + dy) +
                   tap(fine, x + dx, y + dy + 2) + tap(fine, x + dx + 2, y + dy + 2));
  };
  const std::pair<double, glm::dvec3> groups[] = {{0.5, group(-1, -1)},
                                                  {0.125, group(-2, -2)},
                                                  {0.125, group(0, -2)},
                                                  {0.125, group(-2, 0)},
                                                  {0.125, group(0, 0)}};
  glm::dvec3 plain(0.0), sum(0.0);
  double weights = 0.0;
  for (const auto& [share, mean] : groups) {
    const double weight = share / (1.0 + 0.2126 * mean.x + 0.7152 * mean.y + 0.0722 * mean.z);
    plain += share * mean;
    sum += weight * mean;
    weights += weight;
  }
  return calm ? glm::min(plain, sum / weights) : plain;
}

/// A coarser level at a finer one's texel: 3x3 bilinear taps with weights 1 2 1.
glm::dvec3 spread(const Level& coarse, int x, int y) {
  const auto bilinear = [&](double u, double v) {
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    const double a = u - i, b = v - j;
    return (1 - b) * ((1 - a) * coarse.at(i, j) + a * coarse.at(i + 1, j)) +
           b * ((1 - a) * coarse.at(i, j + 1) + a * coarse.at(i + 1, j + 1));
  };
  glm::dvec3 sum(0.0);
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      sum += (2.0 - std::abs(dx)) * (2.0 - std::abs(dy)) / 16.0 *
             bilinear((x + 0.5) / 2.0 - 0.5 + dx, (y + 0.5) / 2.0 - 0.5 + dy);
  return sum;
}

/// @param levels so many more, and what they give at this one.
Level pyramid(const Level& from, int levels, bool first) {
  Level here((from.width + 1) / 2, (from.height + 1) / 2);
  for (int y = 0; y < here.height; ++y)
    for (int x = 0; x < here.width; ++x)
      here.texels[static_cast<std::size_t>(y) * here.width + x] = shrunk(from, 2 * x, 2 * y, first);
  if (levels == 1 || (here.width == 1 && here.height == 1)) return here;
  constexpr double kShare = 0.7;
  const Level coarse = pyramid(here, levels - 1, false);
  for (int y = 0; y < here.height; ++y)
    for (int x = 0; x < here.width; ++x) {
      glm::dvec3& texel = here.texels[static_cast<std::size_t>(y) * here.width + x];
      texel = (1.0 - kShare) * texel + kShare * spread(coarse, x, y);
    }
  return here;
}

}  // namespace

glm::dvec3 too_bright(glm::dvec3 exposed, double threshold) {
  constexpr double kMostTaken = 32.0;
  const glm::dvec3 c = glm::min(exposed, glm::dvec3(kMostTaken));
  const double brightest = std::max({c.x, c.y, c.z}), knee = 0.5 * threshold;
  if (brightest <= threshold - knee || brightest <= 0.0) return glm::dvec3(0.0);
  const double into = std::min(brightest - threshold + knee, 2.0 * knee);
  const double soft = knee > 0.0 ? into * into / (4.0 * knee) : 0.0;
  return c * (std::max(brightest - threshold, soft) / brightest);
}

measure::Picture glow(const measure::Picture& radiance, double ev,
                      const render::BloomSettings& settings) {
  const auto width = static_cast<int>(radiance.width), height = static_cast<int>(radiance.height);
  Level taken(width, height);
  for (std::size_t i = 0; i < taken.texels.size(); ++i)
    taken.texels[i] =
        too_bright(glm::dvec3(radiance.pixels[i]) * std::exp2(-ev), double{settings.threshold});
  const Level half = pyramid(taken, settings.levels, true);
  measure::Picture out{radiance.width, radiance.height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out.pixels.emplace_back(double{settings.intensity} * spread(half, x, y));
  return out;
}

}  // namespace skerry::reference
