#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <mutex>
#include <span>

#include "engine/core/check.h"
#include "engine/core/clock.h"
#include "tools/reference/open_sky.h"
#include "tools/reference/reference.h"
#include "tools/reference/shade.h"

namespace skerry::reference {
namespace {

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

  /// Means of batches [first, first + count) of a pixel's samples.
  void add_batches(std::uint32_t x, std::uint32_t y, std::uint32_t first,
                   std::span<glm::dvec3> means) const {
    const glm::dvec2 corner(x, y);
    const glm::dvec3 middle = lens_.direction(corner + 0.5);
    const std::uint32_t pixel = y * scene_.view.width + x;
    const bool centred = settings_.filter == game::ReferenceFilter::kCentre;
    thread_local Trace trace;
    if (centred) tracer_.trace(glm::dvec3(0.0), middle, trace);
    glm::dvec3 stars(0.0);
    if (scene_.sky) stars = star_radiance(middle, lens_.pixel_angle(middle), *scene_.sky);

    const std::uint32_t batches = batches_of(settings_);
    for (std::uint32_t i = 0; i < means.size(); ++i) {
      const std::uint32_t b = first + i;
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
      means[i] = batch / static_cast<double>(count);
    }
  }

 private:
  const Scene& scene_;
  const ReferenceSettings& settings_;
  const Tracer& tracer_;
  Shader shader_;
  Lens lens_;
};

/// A pixel from the means of all its batches, in their order.
Pixel pixel_of(std::span<const glm::dvec3> means) {
  const auto batches = static_cast<double>(means.size());
  glm::dvec3 sum(0.0), squares(0.0);
  for (const glm::dvec3& mean : means) sum += mean;
  Pixel result;
  result.mean = sum / batches;
  if (means.size() < 2) return result;
  for (const glm::dvec3& mean : means) {
    const glm::dvec3 off = mean - result.mean;
    squares += off * off;
  }
  result.standard_error = glm::sqrt(squares / (batches * (batches - 1.0)));
  return result;
}

bool finite(glm::dvec3 c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

double mean_of(const std::vector<glm::vec3>& errors) {
  double sum = 0.0;
  for (const glm::vec3& e : errors) sum += static_cast<double>(e.x) + e.y + e.z;
  return sum / (3.0 * static_cast<double>(errors.size()));
}

/// Calls draw(x, y) for every pixel, on all threads.
void for_each_pixel(const View& view, int threads, const Progress& progress,
                    const std::function<void(std::uint32_t x, std::uint32_t y)>& draw) {
  const std::uint32_t tiles_x = (view.width + kTileEdge - 1) / kTileEdge,
                      tiles_y = (view.height + kTileEdge - 1) / kTileEdge;
  std::uint32_t done = 0;
  std::mutex reporting;
  Jobs jobs(threads);
  jobs.parallel_for(static_cast<int>(tiles_x * tiles_y), [&](int tile) {
    const std::uint32_t x0 = static_cast<std::uint32_t>(tile) % tiles_x * kTileEdge,
                        y0 = static_cast<std::uint32_t>(tile) / tiles_x * kTileEdge;
    for (std::uint32_t y = y0; y < std::min(view.height, y0 + kTileEdge); ++y)
      for (std::uint32_t x = x0; x < std::min(view.width, x0 + kTileEdge); ++x) draw(x, y);
    const std::lock_guard lock(reporting);
    ++done;
    if (progress) progress(static_cast<double>(done) / (tiles_x * tiles_y));
  });
}

/// A picture that pixels are put into, from any thread.
class Plate {
 public:
  Plate(std::uint32_t width, std::uint32_t height, bool knows_error) {
    out_.radiance = {width, height, std::vector<glm::vec3>(std::size_t{width} * height)};
    if (knows_error) out_.standard_error.resize(out_.radiance.pixels.size());
  }
  void put(std::size_t at, Pixel pixel) {
    if (!finite(pixel.mean)) {
      ++non_finite_;
      pixel = {};
    }
    out_.radiance.pixels[at] = pixel.mean;
    if (!out_.standard_error.empty()) out_.standard_error[at] = pixel.standard_error;
  }
  ReferencePicture take() {
    if (!out_.standard_error.empty()) out_.mean_error = mean_of(out_.standard_error);
    out_.non_finite_pixels = non_finite_;
    return std::move(out_);
  }

 private:
  ReferencePicture out_;
  std::atomic<std::uint32_t> non_finite_ = 0;
};

}  // namespace

std::uint32_t batches_of(const ReferenceSettings& settings) {
  return std::min(kBatches, settings.samples);
}

ReferencePicture render(const Scene& scene, const ReferenceSettings& settings,
                        const Progress& progress) {
  SKERRY_ASSERT(settings.samples >= 1 && settings.samples <= 65536);
  const Stopwatch watch;
  const Tracer tracer(scene.islands);
  const PixelEstimator estimator(scene, settings, tracer);
  const std::uint32_t batches = batches_of(settings), width = scene.view.width;
  Plate plate(width, scene.view.height, batches > 1);
  for_each_pixel(scene.view, settings.threads, progress, [&](std::uint32_t x, std::uint32_t y) {
    glm::dvec3 means[kBatches];
    estimator.add_batches(x, y, 0, {means, batches});
    plate.put(std::size_t{y} * width + x, pixel_of({means, batches}));
  });
  ReferencePicture out = plate.take();
  out.islands = scene.islands.size();
  for (const Island& island : scene.islands) out.chunks += island.voxels->chunks_made();
  out.seconds = watch.seconds();
  return out;
}

ReferenceBatches render_batches(const Scene& scene, const ReferenceSettings& settings,
                                std::uint32_t first, std::uint32_t count,
                                const Progress& progress) {
  SKERRY_ASSERT(settings.samples >= 1 && settings.samples <= 65536);
  SKERRY_ASSERT(count >= 1 && first + count <= batches_of(settings));
  const Stopwatch watch;
  const Tracer tracer(scene.islands);
  const PixelEstimator estimator(scene, settings, tracer);
  ReferenceBatches out{scene.view.width, scene.view.height, first, count, {}, 0.0};
  const std::size_t pixels = std::size_t{out.width} * out.height;
  out.means.resize(pixels * count);
  for_each_pixel(scene.view, settings.threads, progress, [&](std::uint32_t x, std::uint32_t y) {
    glm::dvec3 means[kBatches];
    estimator.add_batches(x, y, first, {means, count});
    for (std::uint32_t b = 0; b < count; ++b)
      out.means[pixels * b + std::size_t{y} * out.width + x] = means[b];
  });
  out.seconds = watch.seconds();
  return out;
}

ReferencePicture merge_batches(std::span<const ReferenceBatches> parts) {
  std::vector<const ReferenceBatches*> ordered;
  for (const ReferenceBatches& part : parts) ordered.push_back(&part);
  std::ranges::sort(ordered, {}, &ReferenceBatches::first);
  SKERRY_ASSERT(!ordered.empty());
  const std::uint32_t width = ordered.front()->width, height = ordered.front()->height;
  const std::size_t pixels = std::size_t{width} * height;
  std::vector<const glm::dvec3*> batches;
  double seconds = 0.0;
  for (const ReferenceBatches* part : ordered) {
    SKERRY_ASSERT(part->width == width && part->height == height);
    SKERRY_ASSERT(part->first == batches.size() && part->means.size() == pixels * part->count);
    for (std::uint32_t b = 0; b < part->count; ++b)
      batches.push_back(part->means.data() + pixels * b);
    seconds += part->seconds;
  }
  SKERRY_ASSERT(batches.size() <= kBatches);
  Plate plate(width, height, batches.size() > 1);
  for (std::size_t i = 0; i < pixels; ++i) {
    glm::dvec3 means[kBatches];
    for (std::size_t b = 0; b < batches.size(); ++b) means[b] = batches[b][i];
    plate.put(i, pixel_of({means, batches.size()}));
  }
  ReferencePicture out = plate.take();
  out.seconds = seconds;
  return out;
}

}  // namespace skerry::reference
