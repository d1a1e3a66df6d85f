#include "tools/reference/clouds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>

namespace skerry::reference {
namespace {

constexpr double kPi = std::numbers::pi;
/// Distances at which the layer thins out and ends [blocks].
constexpr double kThinning = 12000.0, kEnd = 16000.0;
/// Of a march through the layer [blocks], and the most steps of one: far ways are marched in longer
/// ones.
constexpr double kStep = 2.0, kMostSteps = 1024.0;
/// Of a march through any stretch.
constexpr double kEndless = 65536.0;

double ramp(double low, double high, double x) {
  return std::clamp((x - low) / (high - low), 0.0, 1.0);
}

double lobe(double cosine, double g) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

/// Calls visit(t, length) for the steps of a way, until it says no.
/// @param offset 0..1: where in a step t is.
template <class Visit>
void march(std::span<const Stretch> stretches, double begin, double end, double offset,
           Visit&& visit) {
  for (const Stretch& stretch : stretches) {
    const double from = std::max(stretch.from, begin), length = std::min(stretch.to, end) - from;
    if (!(length > 0.0)) continue;
    const double steps = std::min(kEndless, std::ceil(length / stretch.step));
    const double step = length / steps;
    for (double i = 0.0; i < steps; ++i)
      if (!visit(from + (i + offset) * step, step)) return;
  }
}

/// Cuts ranges that overlap: each part has the shortest step of those that it is of.
std::vector<Stretch> cut(std::span<const Stretch> ranges) {
  std::vector<double> ends;
  for (const Stretch& range : ranges) ends.insert(ends.end(), {range.from, range.to});
  std::sort(ends.begin(), ends.end());
  std::vector<Stretch> out;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    Stretch part{ends[i - 1], ends[i], 0.0};
    for (const Stretch& range : ranges)
      if (range.from <= part.from && part.to <= range.to)
        part.step = part.step == 0.0 ? range.step : std::min(part.step, range.step);
    if (part.step > 0.0 && part.to > part.from) out.push_back(part);
  }
  return out;
}

}  // namespace

double CloudLayer::extinction_at(glm::dvec3 p) const {
  const double rise = p.y + eye.y, height = rise / thickness;
  if (height <= 0.0 || height >= 1.0) return 0.0;
  const CloudNoise& noise = CloudNoise::shared();
  const glm::dvec3 at(p.x + eye.x, rise, p.z + eye.z);
  const double weather = noise.at(glm::dvec3(at.x, 0.0, at.z) / 10240.0, 3);
  const double cover = std::clamp(coverage + 0.5 * (weather - 0.5), 0.0, 1.0);
  const double profile =
      ramp(0.0, 0.1, height) * (1.0 - ramp(0.2 + 0.3 * cover, 0.6 + 0.4 * cover, height));
  const double least = 0.62 - 0.42 * cover;
  const double body = ramp(least, least + 0.2, noise.at(at / 2048.0, 0)) - (1.0 - profile);
  if (body <= 0.0) return 0.0;
  const double detail = 1.0 - 0.6 * noise.at(at / 320.0, 1) - 0.4 * noise.at(at / 320.0, 2);
  return extinction * ramp(0.7 * detail, 1.0, body) *
         (1.0 - ramp(kThinning, kEnd, std::hypot(p.x, p.z)));
}

double CloudGrid::value_at(glm::dvec3 p) const {
  const glm::dvec3 at(index_from_world * glm::dvec4(p, 1.0));
  const glm::dvec3 corner = glm::floor(at), f = at - corner;
  const glm::ivec3 first = glm::ivec3(glm::clamp(corner, -1e9, 1e9)) - low;
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 place = first + glm::ivec3(i % 2, i / 2 % 2, i / 4);
    if (place.x < 0 || place.y < 0 || place.z < 0 || place.x >= size.x || place.y >= size.y ||
        place.z >= size.z)
      continue;
    const double weight =
        (i % 2 ? f.x : 1.0 - f.x) * (i / 2 % 2 ? f.y : 1.0 - f.y) * (i / 4 ? f.z : 1.0 - f.z);
    const std::size_t index =
        (static_cast<std::size_t>(place.z) * static_cast<std::size_t>(size.y) +
         static_cast<std::size_t>(place.y)) *
            static_cast<std::size_t>(size.x) +
        static_cast<std::size_t>(place.x);
    sum += weight * std::max(0.0, static_cast<double>(samples[index]));
  }
  return sum;
}

double Clouds::extinction_at(glm::dvec3 p) const {
  double sum = layer ? layer->extinction_at(p) : 0.0;
  for (const CloudGrid& grid : grids)
    if (grid.extinction != 0.0) sum += grid.extinction * grid.value_at(p);
  return sum;
}

glm::dvec3 Clouds::emission_at(glm::dvec3 p) const {
  glm::dvec3 sum(0.0);
  for (const CloudGrid& grid : grids)
    if (grid.emission != glm::dvec3(0.0)) sum += grid.emission * grid.value_at(p);
  return sum;
}

std::vector<Stretch> Clouds::stretches(glm::dvec3 origin, glm::dvec3 direction) const {
  std::vector<Stretch> ranges;
  if (layer) {
    const double rise = std::abs(direction.y) < 1e-9 ? 1e-9 : direction.y;
    const double a = (-layer->eye.y - origin.y) / rise;
    const double b = (layer->thickness - layer->eye.y - origin.y) / rise;
    // Beyond its end there is no layer, whatever the direction.
    const double from = std::max(std::min(a, b), 0.0);
    const double to = std::min(std::max(a, b), 2.0 * kEnd);
    if (to > from) ranges.push_back({from, to, std::max(kStep, (to - from) / kMostSteps)});
  }
  for (const CloudGrid& grid : grids) {
    const glm::dvec3 at(grid.index_from_world * glm::dvec4(origin, 1.0));
    const glm::dvec3 along = glm::dmat3(grid.index_from_world) * direction;
    double from = 0.0, to = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
      const double speed = std::abs(along[axis]) < 1e-30 ? 1e-30 : along[axis];
      const double a = (grid.low[axis] - 1 - at[axis]) / speed;
      const double b = (grid.low[axis] + grid.size[axis] - at[axis]) / speed;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    if (to > from) ranges.push_back({from, to, grid.step});
  }
  return cut(ranges);
}

double Clouds::depth(glm::dvec3 origin, glm::dvec3 direction, double offset,
                     double distance) const {
  double sum = 0.0;
  march(stretches(origin, direction), 0.0, distance, offset, [&](double t, double step) {
    sum += extinction_at(origin + direction * t) * step;
    return true;
  });
  return sum;
}

CloudMeeting meet_clouds(const Clouds& clouds, glm::dvec3 direction, double begin, double end,
                         double air, glm::dvec2 pair) {
  CloudMeeting out;
  std::vector<glm::dvec3> steps;  // where, length, optical depth up to its end
  double depth = 0.0;
  const std::vector<Stretch> stretches = clouds.stretches(glm::dvec3(0.0), direction);
  march(stretches, begin, end, pair.x, [&](double t, double step) {
    const glm::dvec3 p = direction * t;
    const double tau = clouds.extinction_at(p) * step;
    out.emitted += clouds.emission_at(p) * (std::exp(-depth - air * t) * step *
                                            (tau > 1e-9 ? -std::expm1(-tau) / tau : 1.0));
    depth += tau;
    steps.emplace_back(t - pair.x * step, step, depth);
    return depth < 40.0;
  });
  out.clear = std::exp(-depth);
  if (steps.empty() || depth == 0.0) return out;
  const double wanted = -std::log1p(pair.y * std::expm1(-depth));
  double before = 0.0;
  for (const glm::dvec3& step : steps) {
    if (step.z >= wanted && step.z > before) {
      out.at = step.x + step.y * (wanted - before) / (step.z - before);
      break;
    }
    before = step.z;
    out.at = step.x;
  }
  return out;
}

double scattered_share(double cosine, double depth) {
  // Light, optical depth and one-sidedness of what is scattered once, and of three terms more.
  constexpr double kTerms[4][3] = {
      {1.0, 1.0, 1.0}, {1.5, 0.9, 0.0}, {0.36, 0.063, 0.45}, {0.05, 0.14, 0.7}};
  double sum = 0.0;
  for (const auto& [light, share, narrow] : kTerms)
    sum += light * std::exp(-share * depth) *
           (0.7 * lobe(cosine, 0.75 * narrow) + 0.3 * lobe(cosine, -0.35 * narrow));
  return kCloudAlbedo * sum;
}

double sky_share(double depth) {
  return kCloudAlbedo * std::exp(-0.063 * depth);
}

}  // namespace skerry::reference
