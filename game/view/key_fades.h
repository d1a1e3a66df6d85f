#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <set>

#include "engine/render/frame/celestial.h"
#include "engine/render/frame/frame_input.h"
#include "world/light/bounce_light.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// Islands whose reflected light of sun and moon is followed from key directions: so many of the
/// nearest ones, not farther from the camera than that [blocks].
inline constexpr std::size_t kMostKeyed = 2;
inline constexpr double kKeyedWithin = 64.0;

/// To the brighter of sun and moon, about an island's axes. None: neither sends light.
/// @param rotation world from lattice.
std::optional<glm::vec3> key_direction(const render::Celestial& sky, const glm::dquat& rotation);

/// How much of the light of each key direction is shown on each island, while one fades into
/// another. The frame thread calls everything here.
class KeyFades {
 public:
  /// The renderer has the light of an island as it was followed from these directions.
  void show(const world::IslandLevel& row, const world::KeyDirections& keys);
  void remove(const world::IslandLevel& row) { islands_.erase(row); }
  void clear() { islands_.clear(); }
  /// A frame later: what fades is a step further. @param keyed whether an island is to show any.
  void advance(const std::function<bool(const world::IslandLevel&)>& keyed);
  /// Fades to what has been followed from exactly there. @return whether there is such.
  bool turn_to(const world::IslandLevel& row, const glm::vec3& direction);
  /// What fades has faded; other islands than these show none of it.
  void finish(const std::set<world::IslandLevel>& shown);

  /// The slot to put a direction into.
  std::size_t next(const world::IslandLevel& row) const;
  /// Whether that is done unseen.
  bool is_unseen(const world::IslandLevel& row, std::size_t slot) const;
  /// Whether any of it is shown.
  bool shows(const world::IslandLevel& row) const;
  /// The direction that is shown, or on its way; none: there is none.
  std::optional<glm::vec3> shown(const world::IslandLevel& row) const;
  std::array<render::KeyedBody, 2> of(const world::IslandLevel& row) const;

 private:
  struct Island {
    world::KeyDirections keys{};
    std::array<float, 2> weight{};
    std::size_t to = 0;  // slot whose weight grows to 1, if it has a direction
  };
  std::map<world::IslandLevel, Island> islands_;
};

}  // namespace skerry::game
