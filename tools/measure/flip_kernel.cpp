#include "tools/measure/flip_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/jobs.h"
#include "tools/measure/color.h"

namespace skerry::measure::flip_detail {
namespace {

constexpr double kQc = 0.7;  ///< exponent of the colour difference, in the paper's notation

/// L*a*b* with chroma scaled by lightness.
glm::dvec3 hunt_lab(const glm::dvec3& linear) {
  const glm::dvec3 lab = lab_from_linear(linear);
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

/// Between green and blue, the two colours that differ most.
double largest_difference() {
  const glm::dvec3 d = hunt_lab({0.0, 1.0, 0.0}) - hunt_lab({0.0, 0.0, 1.0});
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

void copy_rows(const glm::dmat3& from, double (&to)[3][3]) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) to[row][column] = from[column][row];
}

/// Whether two pictures are the same in all that a tile's errors depend on.
bool same_around(const Pair& pair, const Tile& tile, int margin) {
  const int width = static_cast<int>(pair.width);
  const int height = static_cast<int>(pair.height);
  const int left = std::max(tile.x - margin, 0);
  const int right = std::min(tile.x + tile.width + margin, width);
  for (int y = std::max(tile.y - margin, 0); y < std::min(tile.y + tile.height + margin, height);
       ++y) {
    const std::size_t at = static_cast<std::size_t>(y) * pair.width + left;
    if (std::memcmp(pair.sources[0].pixel(at), pair.sources[1].pixel(at),
                    static_cast<std::size_t>(right - left) * pair.sources[0].pixel_bytes()) != 0)
      return false;
  }
  return true;
}

/// This thread's, kept for the next tile and the next picture.
Scratch& scratch_of_thread(int margin) {
  thread_local Scratch scratch(margin);
  if (scratch.margin() != margin) scratch = Scratch(margin);
  return scratch;
}

}  // namespace

Constants::Constants(double pixels_per_degree)
    : filters(pixels_per_degree),
      margin(filters.radius()),
      blue_yellow_share{filters.blue_yellow.parts[0].share, filters.blue_yellow.parts[1].share},
      largest(std::pow(largest_difference(), kQc)) {
  copy_rows(measure::relative_from_linear(), relative_from_linear);
  copy_rows(measure::linear_from_relative(), linear_from_relative);
}

Scratch::Scratch(int margin)
    : margin_(margin),
      stride_(kTileWidth + 2 * margin + kStripWidth),
      middles_(static_cast<std::size_t>(kMiddles) * (kTileHeight + 2 * margin) * kMiddleStride),
      rows_(static_cast<std::size_t>(3) * stride_),
      seen_(static_cast<std::size_t>(2) * kSeens * kTileHeight * kTileWidth) {}

std::span<const Kernel* const> kernels() {
  static const std::vector<const Kernel*> all = [] {
    std::vector<const Kernel*> found;
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
      found.push_back(&kAvx512Kernel);
    if (__builtin_cpu_supports("avx2")) found.push_back(&kAvx2Kernel);
#endif
    found.push_back(&kPortableKernel);
    return found;
  }();
  return all;
}

Pair pair_of(const Picture& reference, const Picture& test) {
  Pair pair{reference.width, reference.height, {}};
  pair.sources[0].linear = reference.pixels.data();
  pair.sources[1].linear = test.pixels.data();
  return pair;
}

std::vector<float> errors_with(const Kernel& kernel, const Pair& pair, double pixels_per_degree) {
  const Constants constants(pixels_per_degree);
  const int width = static_cast<int>(pair.width);
  const int height = static_cast<int>(pair.height);
  std::vector<float> errors(std::size_t{pair.width} * pair.height);
  Jobs jobs;
  jobs.parallel_for((height + kTileHeight - 1) / kTileHeight, [&](int band) {
    Scratch& scratch = scratch_of_thread(constants.margin);
    for (int x = 0; x < width; x += kTileWidth) {
      const int y = band * kTileHeight;
      const Tile tile{x, y, std::min(kTileWidth, width - x), std::min(kTileHeight, height - y)};
      // Errors of equal pictures are 0 exactly, as they are here from the start.
      if (same_around(pair, tile, constants.margin)) continue;
      kernel.tile_errors(constants, pair, tile, scratch, errors.data());
    }
  });
  return errors;
}

}  // namespace skerry::measure::flip_detail
