// Marks of places on the compass and the map: told apart by their shapes, not by colour alone.
#pragma once
#include <imgui.h>

#include <cstdint>

namespace skerry::game::ui {

enum class PlaceKind : std::uint8_t {
  kHome,      ///< a house
  kGround,    ///< the ground that held the player last: a ring
  kWaypoint,  ///< a diamond
};

/// @param half of its width and height [pixels].
void draw_place_mark(ImDrawList& list, PlaceKind kind, ImVec2 middle, float half,
                     double strength = 1.0);

}  // namespace skerry::game::ui
