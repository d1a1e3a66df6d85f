#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>

#include "engine/core/check.h"
#include "engine/core/clock.h"
#include "tools/reference/open_sky.h"
#include "tools/reference/reference.h"
#include "tools/reference/shade.h"

namespace skerry::reference {
namespace {

constexpr std::uint32_t kBatches = 8;  // independent estimates of each pixel
constexpr std::uint32_t kTileEdge = 16;

/// A pixel's estimate.
struct Pixel {
  glm::dvec3 mean{0.0}, standard_error{0.0};
};

/// Directions through the picture.
class Lens {
 public:
  explicit Lens(const View& view) : view_(view) {}
  /// @param place in pixels from the top left.
  glm::dvec3 direction(glm::dvec2 place) const {
    const double x = (2.0 * place.x / view_.width - 1.0) * tan_half_x(),
                 y = (2.0 * place.y / view_.height - 1.0) * view_.tan_half_y;
    return glm::normalize(view_.forward + view_.right * x - view_.up * y);
  }
  /// Mean angle of a pixel [rad]: off the axis it covers the cube of the cosine of the middle one's
  /// sky.
  double pixel_angle(glm::dvec3 direction) const {
    const double cosine = std::max(0.1, glm::dot(direction, view_.forward));
    return 2.0 / view_.height * view_.tan_half_y * std::pow(cosine, 1.5);
  }

 private:
  double tan_half_x() const { return view_.tan_half_y * view_.width / view_.height; }
  const View& view_;
};

class PixelEstimator {
 public:
  PixelEstimator(const Scene& scene, const ReferenceSettings& settings, const Tracer& tracer)
      : scene_(scene),
        settings_(settings),
        tracer_(tracer),
        shader_(scene, tracer),
        lens_(scene.view) {}

  Pixel estimate(std::uint32_t x, std::uint32_t y) const {
    const glm::dvec2 corner(x, y);
    const glm::dvec3 middle = lens_.direction(corner + 0.5);
    const std::uint32_t pixel = y * scene_.view.width + x;
    const bool centred = settings_.filter == game::ReferenceFilter::kCentre;
    thread_local Trace trace;
    if (centred) tracer_.trace(glm::dvec3(0.0), middle, trace);
    glm::dvec3 stars(0.0);
    if (scene_.sky) stars = star_radiance(middle, lens_.pixel_angle(middle), *scene_.sky);

    const std::uint32_t batches = std::min(kBatches, settings_.samples);
    glm::dvec3 means[kBatches], sum(0.0);
    for (std::uint32_t b = 0; b < batches; ++b) {
      const std::uint32_t count =
          settings_.samples / batches + (b < settings_.samples % batches ? 1 : 0);
      glm::dvec3 batch(0.0);
      for (std::uint32_t s = 0; s < count; ++s) {
        Sampler sampler(pixel, b, s);
        const glm::dvec3 fine = lens_.direction(corner + sampler.next());
        if (!centred) tracer_.trace(glm::dvec3(0.0), fine, trace);
        const Seen seen = shader_.look(trace, centred ? middle : fine, fine, sampler);
        batch += seen.radiance + seen.open * stars;
      }
      means[b] = batch / static_cast<double>(count);
      sum += means[b];
    }
    Pixel result;
    result.mean = sum / static_cast<double>(batches);
    if (batches < 2) return result;
    glm::dvec3 squares(0.0);
    for (std::uint32_t b = 0; b < batches; ++b) {
      const glm::dvec3 off = means[b] - result.mean;
      squares += off * off;
    }
    result.standard_error = glm::sqrt(squares / (batches * (batches - 1.0)));
    return result;
  }

 private:
  const Scene& scene_;
  const ReferenceSettings& settings_;
  const Tracer& tracer_;
  Shader shader_;
  Lens lens_;
};

bool finite(glm::dvec3 c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

double mean_of(const std::vector<glm::vec3>& errors) {
  double sum = 0.0;
  for (const glm::vec3& e : errors) sum += static_cast<double>(e.x) + e.y + e.z;
  return sum / (3.0 * static_cast<double>(errors.size()));
}

}  // namespace

ReferencePicture render(const Scene& scene, const ReferenceSettings& settings,
                        const Progress& progress) {
  SKERRY_ASSERT(settings.samples >= 1 && settings.samples <= 65536);
  const Stopwatch watch;
  const Tracer tracer(scene.islands);
  const PixelEstimator estimator(scene, settings, tracer);
  const std::uint32_t width = scene.view.width, height = scene.view.height;
  ReferencePicture out;
  out.radiance = {width, height, std::vector<glm::vec3>(std::size_t{width} * height)};
  const bool know_error = settings.samples > 1;
  if (know_error) out.standard_error.resize(out.radiance.pixels.size());

  const std::uint32_t tiles_x = (width + kTileEdge - 1) / kTileEdge,
                      tiles_y = (height + kTileEdge - 1) / kTileEdge;
  std::atomic<std::uint32_t> non_finite = 0;
  std::uint32_t done = 0;
  std::mutex reporting;
  Jobs jobs(settings.threads);
  jobs.parallel_for(static_cast<int>(tiles_x * tiles_y), [&](int tile) {
    const std::uint32_t x0 = static_cast<std::uint32_t>(tile) % tiles_x * kTileEdge,
                        y0 = static_cast<std::uint32_t>(tile) / tiles_x * kTileEdge;
    for (std::uint32_t y = y0; y < std::min(height, y0 + kTileEdge); ++y) {
      for (std::uint32_t x = x0; x < std::min(width, x0 + kTileEdge); ++x) {
        Pixel pixel = estimator.estimate(x, y);
        if (!finite(pixel.mean)) {
          ++non_finite;
          pixel = {};
        }
        const std::size_t at = std::size_t{y} * width + x;
        out.radiance.pixels[at] = pixel.mean;
        if (know_error) out.standard_error[at] = pixel.standard_error;
      }
    }
    const std::lock_guard lock(reporting);
    ++done;
    if (progress) progress(static_cast<double>(done) / (tiles_x * tiles_y));
  });
  if (know_error) out.mean_error = mean_of(out.standard_error);
  out.non_finite_pixels = non_finite;
  out.islands = scene.islands.size();
  for (const Island& island : scene.islands) out.chunks += island.voxels->chunks_made();
  out.seconds = watch.seconds();
  return out;
}

}  // namespace skerry::reference
