// What the map shows, and what is asked for on it.
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "game/ui/place_mark.h"

namespace skerry::game::ui {

inline constexpr double kMapRadii[] = {150.0, 300.0, 600.0, 1200.0, 2400.0};  ///< blocks
inline constexpr double kMostMapShift = 4800.0;  ///< blocks east or south, and west or north

/// Places in blocks east and south of the map's middle.
struct MapFacts {
  struct Place {
    PlaceKind kind = PlaceKind::kWaypoint;
    std::string name;  ///< of a waypoint
    glm::dvec2 at{};
    double up = 0.0;  ///< blocks above the player
  };
  struct Island {
    std::string name, description;
    glm::dvec2 at{};
    double radius = 0.0;  ///< blocks
    double up = 0.0;      ///< of its middle above the player's feet [blocks]
    glm::dvec2 drift{};   ///< blocks/s
  };
  std::vector<Place> places;  ///< waypoints last, in the journal's order
  std::vector<Island> islands;
  double radius = 0.0;  ///< blocks from the middle to an edge of the picture; 0: none is there yet
  glm::dvec2 view{};    ///< what is to be shown in the middle; the picture follows
  glm::dvec2 player{};
  double yaw_deg = 0.0;
  std::size_t to_come = 0;  ///< islands that the picture does not have yet
  bool full = false;        ///< no more waypoints can be kept
  /// Kinds of islands and biomes stood on, and how many there are.
  int kinds = 0, all_kinds = 0, biomes = 0, all_biomes = 0;
  std::optional<std::int64_t> highest, deepest;  ///< ground stood on [blocks]
};

/// Indices are those of MapFacts::places.
struct MapWishes {
  std::optional<std::size_t> travel, make_home, remove, rename;
  std::string name;  ///< for rename
  bool mark = false;
};

/// "NE" of a direction, "" of none.
std::string compass_point(glm::dvec2 to);

}  // namespace skerry::game::ui
