#include "game/sections/section_cuts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace skerry::game {

void SectionCuts::add(const world::SectionKey& key, const world::LatticeBox& faces) {
  if (!key.far) islands_[key.island].tree.add({key.level, key.chunk}, faces);
}

void SectionCuts::remove(const world::SectionKey& key) {
  if (key.far) return;
  const auto island = islands_.find(key.island);
  island->second.tree.remove({key.level, key.chunk});
  if (island->second.tree.empty()) islands_.erase(island);
}

void SectionCuts::cut(std::uint64_t id, Island& island, const glm::dvec3& camera, const View& view,
                      const Show& show) {
  island.camera = camera;
  island.nearest = view.nearest_of(id);
  for (const world::SectionTree::Change& change :
       island.tree.cut(camera, island.nearest, view.keep))
    show({id, change.section.chunk, change.section.level}, change.drawn, change.seams);
}

void SectionCuts::choose(const View& view, const Show& show) {
  constexpr double kLeastMove = 1.0;  // blocks, less than hysteresis
  struct Moved {
    std::uint64_t id = 0;
    Island* island = nullptr;
    glm::dvec3 camera{};
    double by = 0.0;  // blocks past the slack
  } most;
  auto coming = view.coming.begin();
  for (auto& [id, island] : islands_) {
    std::uint32_t levels = 0;
    while (coming != view.coming.end() && coming->island < id) ++coming;
    for (; coming != view.coming.end() && coming->island == id; ++coming)
      if (!coming->far) levels |= 1u << coming->level;
    island.tree.set_coming(levels);
    if (!island.tree.stale() && island.tree.slack() == std::numeric_limits<double>::infinity())
      continue;
    const glm::dvec3 camera = view.camera_in(id);
    if (island.tree.stale() || !view.keep) {
      cut(id, island, camera, view, show);
      continue;
    }
    const bool other = island.nearest != view.nearest_of(id);
    const double by =
        glm::length(camera - island.camera) - std::max(island.tree.slack(), kLeastMove);
    if (other || by > most.by)
      most = {id, &island, camera, other ? std::numeric_limits<double>::max() : by};
  }
  if (most.island) cut(most.id, *most.island, most.camera, view, show);
}

}  // namespace skerry::game
