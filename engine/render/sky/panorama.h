// Panoramas: pictures of everything around a point, as a sky. docs/decisions/0053.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/core/result.h"

namespace skerry::render {

/// Largest panorama that is read, and what of its columns is kept.
inline constexpr std::uint32_t kMostPanoramaColumns = 16384, kKeptPanoramaColumns = 4096;
/// Texels count as at most this: radiance of a file, before it is scaled.
inline constexpr float kMostPanoramaRadiance = 1e6f;

/// An equirectangular picture, twice as wide as high: rows of equal elevation from the zenith down,
/// columns of equal azimuth, what is on the right on the right. Linear radiance, finite, >= 0.
struct Panorama {
  std::uint32_t columns = 0, rows = 0;
  std::vector<glm::vec3> texels;  ///< row by row
  std::uint64_t mended = 0;       ///< of the file: were negative, not finite or too bright

  const glm::vec3& at(std::uint32_t column, std::uint32_t row) const {
    return texels[std::size_t{row} * columns + column];
  }
};

/// Errors: it is not twice as wide as high; one line.
Result<void> check_panorama_shape(std::int64_t columns, std::int64_t rows);

/// Solid angle of a texel of a row [sr].
double panorama_solid_angle(std::uint32_t columns, std::uint32_t rows, std::uint32_t row);

/// Makes a panorama of rows as they are read: where there are more than `most_columns`, it is
/// smaller, and each texel the mean radiance over its solid angle, so that no light is lost.
class PanoramaMaker {
 public:
  /// Asserts that the picture is twice as wide as high and has at least a row.
  PanoramaMaker(std::uint32_t columns, std::uint32_t rows,
                std::uint32_t most_columns = kKeptPanoramaColumns);
  /// The next row from the top, `columns` texels. What is negative or not a number counts as 0,
  /// what is brighter than kMostPanoramaRadiance as that.
  void add_row(std::span<const glm::vec3> texels);
  /// What has been made. Asserts that all rows have been added.
  Panorama take();

 private:
  void fold(std::span<const glm::vec3> texels);

  std::uint32_t columns_, rows_, row_ = 0;
  std::vector<glm::vec3> clean_;   ///< the row, without what cannot be
  std::vector<glm::dvec3> sums_;   ///< the row, at the columns that are kept
  std::vector<glm::dvec3> means_;  ///< of what is kept, as far as rows have been added
  Panorama made_;
};

/// The same panorama, smaller; as it is if it has no more columns.
Panorama reduced(const Panorama& panorama, std::uint32_t most_columns);

/// Where a direction lies in a panorama: 0..1 from left to right and from top to bottom.
/// @param dir unit. @param yaw azimuth of the picture's middle [rad], 0 along +z, as of a camera.
glm::dvec2 panorama_place(glm::dvec3 dir, double yaw);
/// Radiance at a place, between the centres of texels: around the picture's sides, not over its
/// poles.
glm::dvec3 panorama_texel(const Panorama& panorama, glm::dvec2 place);

}  // namespace skerry::render
