#pragma once
#include <glm/vec2.hpp>
#include <memory>
#include <span>

#include "game/map/island_chart.h"
#include "game/ui/pictures.h"

namespace skerry::game {

/// An island on a map.
struct MapLand {
  std::shared_ptr<const IslandChart> chart;
  glm::dvec2 at{};           ///< of its lattice's origin: blocks east and south of the map's middle
  double up = 0.0;           ///< likewise, above it
  double heading_rad = 0.0;  ///< about +y, as world::Pose has it
};

/// A map with north up. Higher land is lighter, slopes are shaded as if lit from the north-west,
/// shores are dark; what is higher covers what is lower, and what is no land is clear.
/// @param radius blocks from the middle to an edge. @param edge pixels.
ui::Rgba draw_map(std::span<const MapLand> lands, double radius, int edge);

}  // namespace skerry::game
