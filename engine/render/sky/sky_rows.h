#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>

namespace skerry::render {

/// A smooth sky about the world's axes, by rows of equal heights on the unit sphere and azimuths:
/// each entry stands for as much of the sphere, and a turn about the vertical axis moves entries
/// along their rows.
class SkyRows {
 public:
  static constexpr int kRows = 16;      ///< row i is at height (2 i + 1) / kRows - 1
  static constexpr int kAzimuths = 64;  ///< azimuth k is at turn k / kAzimuths from +x towards +z

  /// Directions of a row (unit), by azimuth, or what is seen towards them.
  using Row = std::array<glm::dvec3, kAzimuths>;
  /// @param radiance by the directions of a row.
  explicit SkyRows(const std::function<Row(const Row&)>& radiance);
  /// Unit direction of an entry.
  static const glm::dvec3& direction(int row, int azimuth) {
    return directions(row)[static_cast<std::size_t>(azimuth)];
  }
  const glm::vec3& at(int row, int azimuth) const {
    return texels_[static_cast<std::size_t>(row * kAzimuths + azimuth)];
  }
  /// Between the four nearest entries. @param d unit.
  glm::vec3 towards(const glm::vec3& d) const;

 private:
  static const Row& directions(int row);
  std::array<glm::vec3, std::size_t{kRows} * kAzimuths> texels_;
};

}  // namespace skerry::render
