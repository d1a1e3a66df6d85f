#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <set>
#include <vector>

#include "world/stream/section_tree.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// At which level each section of the islands is drawn that are there at several (SectionTree).
class SectionCuts {
 public:
  /// A section that is resident, shown, without seams; far ones are left out.
  /// @param faces box about them in the lattice [blocks].
  void add(const world::SectionKey& key, const world::LatticeBox& faces);
  void remove(const world::SectionKey& key);
  void clear() { islands_.clear(); }

  /// What choose() goes by.
  struct View {
    /// Of an island: how near a section of each level may come [blocks].
    std::function<std::vector<double>(std::uint64_t island)> nearest_of = {};
    /// Of an island: the camera in the axes of its lattice [blocks].
    std::function<glm::dvec3(std::uint64_t island)> camera_in = {};
    /// Levels that wait to become resident, as a whole or in part.
    std::set<world::IslandLevel> coming = {};
    /// Hysteresis, and no more than one island a call because the camera has moved.
    bool keep = true;
  };
  /// @param seams at which faces another level is drawn, a bit each.
  using Show = std::function<void(const world::SectionKey& key, bool shown, std::uint8_t seams)>;
  /// Calls `show` for sections that are to be shown otherwise than before.
  void choose(const View& view, const Show& show);

 private:
  struct Island {
    world::SectionTree tree;
    glm::dvec3 camera{};  // of the last cut, in lattice axes [blocks]
    std::vector<double> nearest;
  };
  static void cut(std::uint64_t id, Island& island, const glm::dvec3& camera, const View& view,
                  const Show& show);

  std::map<std::uint64_t, Island> islands_;
};

}  // namespace skerry::game
