#include "engine/render/sky/panorama_sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

namespace skerry::render {
namespace {

using std::numbers::pi;

Panorama clipped(Panorama panorama, const PanoramaPlacement& placement) {
  for (glm::vec3& texel : panorama.texels)
    texel = glm::min(texel, placement.peak) * placement.scale;
  return panorama;
}

/// A piece of the sky, as a light at its middle.
struct Piece {
  glm::dvec3 direction;
  glm::dvec3 light;  ///< radiance times solid angle
  double solid_angle;
};

/// The panorama in pieces of some 3 degrees, of what is seen between the centres of its texels.
std::vector<Piece> pieces_of(const Panorama& image, double yaw) {
  constexpr std::uint32_t kColumns = 128, kRows = 64;
  constexpr int kStrata = 8;  // places of a piece that are looked at, each way
  const Panorama coarse = reduced(image, kColumns * kStrata / 2);
  std::vector<Piece> pieces;
  for (std::uint32_t row = 0; row < kRows; ++row)
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      glm::dvec3 sum(0.0);
      double weights = 0.0;
      for (int i = 0; i < kStrata * kStrata; ++i) {
        const glm::dvec2 place{(column + (i % kStrata + 0.5) / kStrata) / kColumns,
                               (row + (i / kStrata + 0.5) / kStrata) / kRows};
        const double weight = std::sin(pi * place.y);
        sum += panorama_texel(coarse, place) * weight;
        weights += weight;
      }
      const double solid_angle = panorama_solid_angle(kColumns, kRows, row);
      const double azimuth = yaw - ((column + 0.5) / kColumns - 0.5) * 2.0 * pi,
                   elevation = pi * (0.5 - (row + 0.5) / kRows), flat = std::cos(elevation);
      pieces.push_back({{flat * std::sin(azimuth), std::sin(elevation), flat * std::cos(azimuth)},
                        sum * (solid_angle / weights),
                        solid_angle});
    }
  return pieces;
}

/// Mean of the pieces about a direction: a biweight kernel.
glm::dvec3 mean_about(const std::vector<Piece>& pieces, glm::dvec3 direction) {
  constexpr double kRim = 0.9396926207859084;  // cosine of 20 degrees
  glm::dvec3 light(0.0);
  double weights = 0.0;
  for (const Piece& piece : pieces) {
    const double inside = std::max(0.0, glm::dot(piece.direction, direction) - kRim);
    light += piece.light * (inside * inside);
    weights += piece.solid_angle * inside * inside;
  }
  return light / weights;
}

}  // namespace

PanoramaSky::PanoramaSky(Panorama panorama, const PanoramaPlacement& placement)
    : image_(clipped(std::move(panorama), placement)), yaw_(placement.yaw_deg * (pi / 180.0)) {
  const std::vector<Piece> pieces = pieces_of(image_, yaw_);
  for (const Piece& piece : pieces) mean_ += piece.light / (4.0 * pi);
  smooth_ = std::make_unique<const SkyCube>(
      [&](glm::dvec3 direction) { return mean_about(pieces, direction); });
}

}  // namespace skerry::render
