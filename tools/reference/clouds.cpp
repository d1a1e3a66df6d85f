#include "tools/reference/clouds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
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
/// Optical depth behind which nothing is seen: a disc's light is 1e5 of the sky's.
constexpr double kOpaque = 20.0;
/// Of a march through any stretch.
constexpr double kEndless = 65536.0;

double ramp(double low, double high, double x) {
  return std::clamp((x - low) / (high - low), 0.0, 1.0);
}

double lobe(double cosine, double g) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

/// Calls visit(t, length) for the steps of a way that may hold something, until it says no.
/// @param offset 0..1: where in a step t is.
template <class Visit>
void march(const Clouds& clouds, const CloudWay& way, double offset, Visit&& visit) {
  const auto& [origin, direction, begin, end] = way;
  const bool in_cells = clouds.layer && clouds.grids.empty();
  for (const Stretch& stretch : clouds.stretches(origin, direction)) {
    const double from = std::max(stretch.from, begin), length = std::min(stretch.to, end) - from;
    if (!(length > 0.0)) continue;
    const double steps = std::min(kEndless, std::ceil(length / stretch.step));
    const double step = length / steps;
    double cell_ends = from;
    bool empty = false;
    for (double i = 0.0; i < steps; ++i) {
      const double t = from + (i + offset) * step;
      if (in_cells && t >= cell_ends) {
        const CloudLayer::Cell cell = clouds.layer->cell_at(origin + direction * t, direction);
        cell_ends = t + cell.way;
        empty = cell.empty;
      }
      if (empty)
        i = std::max(i, std::floor((cell_ends - from) / step - offset));
      else if (!visit(t, step))
        return;
    }
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
  if (profile <= 0.0) return 0.0;
  const double least = 0.62 - 0.42 * cover;
  const double body = ramp(least, least + 0.2, noise.at(at / 2048.0, 0)) - (1.0 - profile);
  if (body <= 0.0) return 0.0;
  const double detail = 1.0 - glm::dot(noise.billows_at(at / 320.0), glm::dvec2(0.6, 0.4));
  return extinction * ramp(0.7 * detail, 1.0, body) *
         (1.0 - ramp(kThinning, kEnd, std::hypot(p.x, p.z)));
}

CloudLayer::Cell CloudLayer::cell_at(glm::dvec3 p, glm::dvec3 direction) const {
  constexpr double kEdge = 64.0;  // blocks: a cell of the shapes; a fifth of one of the weather's
  const glm::dvec3 at(p.x + eye.x, p.y + eye.y, p.z + eye.z), low = glm::floor(at / kEdge) * kEdge;
  Cell out{1e30, false};
  for (int axis = 0; axis < 3; ++axis)
    if (direction[axis] != 0.0)
      out.way = std::min(out.way, (low[axis] + (direction[axis] > 0.0 ? kEdge : 0.0) - at[axis]) /
                                      direction[axis]);
  const CloudNoise& noise = CloudNoise::shared();
  const glm::dvec3 middle = low + 0.5 * kEdge;
  // The weather is that at height 0, between the texels on either side.
  const double weather = noise.most_about(glm::dvec3(middle.x, 0.0, middle.z) / 10240.0, 3);
  const double cover = std::clamp(coverage + 0.5 * (weather - 0.5), 0.0, 1.0);
  const double profile = ramp(0.0, 0.1, (low.y + kEdge) / thickness) *
                         (1.0 - ramp(0.2 + 0.3 * cover, 0.6 + 0.4 * cover, low.y / thickness));
  const double least = 0.62 - 0.42 * cover;
  const double body =
      ramp(least, least + 0.2, noise.most_about(middle / 2048.0, 0)) - (1.0 - profile);
  out.empty = body <= 0.0;
  return out;
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
  march(*this, {origin, direction, 0.0, distance}, offset, [&](double t, double step) {
    sum += extinction_at(origin + direction * t) * step;
    return true;
  });
  return sum;
}

CloudMeeting meet_clouds(const Clouds& clouds, const CloudWay& way, double air, double offset) {
  CloudMeeting out;
  double depth = 0.0;
  march(clouds, way, offset, [&](double t, double step) {
    const glm::dvec3 p = way.origin + way.direction * t;
    const double tau = clouds.extinction_at(p) * step;
    out.emitted += clouds.emission_at(p) * (std::exp(-depth - air * t) * step *
                                            (tau > 1e-9 ? -std::expm1(-tau) / tau : 1.0));
    if (tau > 0.0) out.steps.push_back({t - offset * step, step, depth, tau});
    depth += tau;
    return depth < kOpaque;
  });
  out.clear = std::exp(-depth);
  return out;
}

double CloudMeeting::place(double share) const {
  const double wanted = -std::log1p(share * std::expm1(std::log(clear)));
  const auto after = std::upper_bound(
      steps.begin(), steps.end(), wanted,
      [](double depth, const Step& step) { return depth < step.before + step.through; });
  const Step& step = after == steps.end() ? steps.back() : *after;
  return step.from + step.length * std::clamp((wanted - step.before) / step.through, 0.0, 1.0);
}

double CloudMeeting::weight_at(double t) const {
  const auto after =
      std::upper_bound(steps.begin(), steps.end(), t,
                       [](double place, const Step& step) { return place < step.from; });
  if (after == steps.begin()) return 0.0;
  const Step& step = *std::prev(after);
  const double into = (t - step.from) / step.length;
  if (into > 1.0) return 0.0;
  return std::exp(-step.before - step.through * into) * step.through / step.length;
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
