#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tools/reference/reference.h"

namespace skerry::reference {

std::optional<double> metered_ev(const measure::Picture& radiance,
                                 const render::MeterSettings& settings) {
  constexpr double kPassedOverDark = 0.4, kPassedOverBright = 0.05, kFollowed = 0.7;
  const double kDarkest = std::ldexp(1.0, -16);
  const double day = std::log2(0.25);
  std::vector<double> light;  // of pixels that are not all but black
  for (const glm::dvec3 c : radiance.pixels) {
    const double y = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    if (y >= kDarkest) light.push_back(y);
  }
  if (light.empty()) return std::nullopt;
  std::sort(light.begin(), light.end());
  const double count = static_cast<double>(light.size());
  const auto first = static_cast<std::size_t>(count * kPassedOverDark),
             last = light.size() - static_cast<std::size_t>(count * kPassedOverBright);
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += std::log2(light[i]);
  const double seen = sum / static_cast<double>(last - first);
  const double ev = day - std::log2(double{settings.key}) + kFollowed * (seen - day);
  return std::max(std::min(ev, double{settings.max_ev}), double{settings.min_ev});
}

}  // namespace skerry::reference
