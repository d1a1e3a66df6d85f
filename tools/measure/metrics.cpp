#include "tools/measure/metrics.h"

#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "tools/measure/quantile.h"

namespace skerry::measure {
namespace {

/// Mean over pixels and channels of term(reference, test).
template <class Term>
double mean(const Picture& reference, const Picture& test, const Term& term) {
  SKERRY_ASSERT(reference.width == test.width && reference.height == test.height);
  SKERRY_ASSERT(!reference.pixels.empty() && reference.pixels.size() == test.pixels.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      sum += term(double{reference.pixels[i][c]}, double{test.pixels[i][c]});
  return sum / (3.0 * static_cast<double>(reference.pixels.size()));
}

double peak_of(const Picture& picture) {
  std::vector<float> channels;
  channels.reserve(picture.pixels.size() * 3);
  for (const glm::vec3& pixel : picture.pixels)
    for (int c = 0; c < 3; ++c)
      if (std::isfinite(pixel[c])) channels.push_back(pixel[c]);
  const double peak = channels.empty() ? 0.0 : quantile(channels, 0.999);
  return peak > 0.0 ? peak : 1.0;
}

}  // namespace

double rel_mse(const Picture& reference, const Picture& test) {
  return mean(reference, test,
              [](double r, double t) { return (t - r) * (t - r) / (r * r + 0.01); });
}

double psnr(const Picture& reference, const Picture& test) {
  const double mse = mean(reference, test, [](double r, double t) { return (t - r) * (t - r); });
  if (mse == 0.0) return std::numeric_limits<double>::infinity();
  const double peak = peak_of(reference);
  return 10.0 * std::log10(peak * peak / mse);
}

}  // namespace skerry::measure
