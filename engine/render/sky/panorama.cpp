#include "engine/render/sky/panorama.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <utility>

#include "engine/core/check.h"

namespace skerry::render {
namespace {

using std::numbers::pi;

/// Area on the unit sphere between two places from top to bottom, over 2 pi.
double between_parallels(double top, double bottom) {
  return std::cos(pi * top) - std::cos(pi * bottom);
}

/// Calls take(to, first, last) for each of `count` parts of 0..1 that a part first..last of it
/// shares.
template <class Take>
void each_shared(double first, double last, std::uint32_t count, const Take& take) {
  const auto from = static_cast<std::uint32_t>(first * count);
  for (std::uint32_t to = from; to < count && to < last * count; ++to) {
    const double low = std::max(first, static_cast<double>(to) / count),
                 high = std::min(last, (to + 1.0) / count);
    if (low < high) take(to, low, high);
  }
}

float mended(float value) {
  return value > 0.0f ? std::min(value, kMostPanoramaRadiance) : 0.0f;
}

}  // namespace

Result<void> check_panorama_shape(std::int64_t columns, std::int64_t rows) {
  if (columns == 2 * rows) return {};
  return Error{
      fmt::format("it is {}x{}, and a panorama is twice as wide as high; give an "
                  "equirectangular one",
                  columns, rows)};
}

double panorama_solid_angle(std::uint32_t columns, std::uint32_t rows, std::uint32_t row) {
  const double top = static_cast<double>(row) / rows, bottom = (row + 1.0) / rows;
  return 2.0 * pi / columns * between_parallels(top, bottom);
}

PanoramaMaker::PanoramaMaker(std::uint32_t columns, std::uint32_t rows, std::uint32_t most_columns)
    : columns_(columns), rows_(rows), clean_(columns) {
  SKERRY_ASSERT(rows > 0 && columns == 2 * rows && most_columns >= 2);
  made_.columns = std::min(columns, most_columns / 2 * 2);
  made_.rows = made_.columns / 2;
  if (made_.columns == columns) {
    made_.texels.reserve(std::size_t{columns} * rows);
    return;
  }
  sums_.resize(made_.columns);
}

void PanoramaMaker::add_row(std::span<const glm::vec3> texels) {
  SKERRY_ASSERT(texels.size() == columns_ && row_ < rows_);
  for (std::size_t i = 0; i < columns_; ++i) {
    clean_[i] = {mended(texels[i].x), mended(texels[i].y), mended(texels[i].z)};
    made_.mended += clean_[i] == texels[i] ? 0 : 1;
  }
  if (made_.columns == columns_)
    made_.texels.insert(made_.texels.end(), clean_.begin(), clean_.end());
  else
    fold(clean_);
  ++row_;
}

/// Adds a row to the means of what is kept.
void PanoramaMaker::fold(std::span<const glm::vec3> texels) {
  std::fill(sums_.begin(), sums_.end(), glm::dvec3(0.0));
  for (std::uint32_t i = 0; i < columns_; ++i)
    each_shared(static_cast<double>(i) / columns_, (i + 1.0) / columns_, made_.columns,
                [&](std::uint32_t to, double first, double last) {
                  sums_[to] += glm::dvec3(texels[i]) * ((last - first) * made_.columns);
                });
  each_shared(static_cast<double>(row_) / rows_, (row_ + 1.0) / rows_, made_.rows,
              [&](std::uint32_t to, double top, double bottom) {
                const double whole = between_parallels(static_cast<double>(to) / made_.rows,
                                                       (to + 1.0) / made_.rows);
                const double share = between_parallels(top, bottom) / whole;
                const std::size_t end = std::size_t{to + 1} * made_.columns;
                if (means_.size() < end) means_.resize(end, glm::dvec3(0.0));
                glm::dvec3* const mean = &means_[std::size_t{to} * made_.columns];
                for (std::uint32_t i = 0; i < made_.columns; ++i) mean[i] += sums_[i] * share;
              });
}

Panorama PanoramaMaker::take() {
  SKERRY_ASSERT(row_ == rows_);
  if (!means_.empty()) made_.texels.assign(means_.begin(), means_.end());
  return std::move(made_);
}

Panorama reduced(const Panorama& panorama, std::uint32_t most_columns) {
  if (panorama.columns <= most_columns) return panorama;
  PanoramaMaker maker(panorama.columns, panorama.rows, most_columns);
  for (std::size_t row = 0; row < panorama.rows; ++row)
    maker.add_row(std::span(panorama.texels).subspan(row * panorama.columns, panorama.columns));
  return maker.take();
}

glm::dvec2 panorama_place(glm::dvec3 dir, double yaw) {
  const double flat = std::hypot(dir.x, dir.z);
  const double azimuth = flat == 0.0 ? 0.0 : std::atan2(dir.x, dir.z);
  // Azimuths grow to the left.
  const double turns = 0.5 + (yaw - azimuth) / (2.0 * pi);
  return {turns - std::floor(turns), 0.5 - std::atan2(dir.y, flat) / pi};
}

glm::dvec3 panorama_texel(const Panorama& panorama, glm::dvec2 place) {
  const auto columns = static_cast<std::int64_t>(panorama.columns),
             rows = static_cast<std::int64_t>(panorama.rows);
  const double x = place.x * panorama.columns - 0.5, y = place.y * panorama.rows - 0.5;
  const double left = std::floor(x), above = std::floor(y);
  const auto texel = [&](std::int64_t i, std::int64_t j) {
    return glm::dvec3(
        panorama.at(static_cast<std::uint32_t>((i + columns) % columns),
                    static_cast<std::uint32_t>(std::clamp<std::int64_t>(j, 0, rows - 1))));
  };
  const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(above);
  return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), x - left),
                  glm::mix(texel(i, j + 1), texel(i + 1, j + 1), x - left), y - above);
}

}  // namespace skerry::render
