// Islands that break, and shapes of islands that move: worked out beside the frame.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "game/session/session_state.h"

namespace skerry::game {
namespace {

// Beyond so many voxels a shape is made anew rather than updated voxel by voxel.
constexpr std::uint64_t kNamedVoxels = 4096;
// The air stops a piece after eight times that, in blocks (world::kAirDrag).
constexpr double kPartingSpeed = 0.4;  // blocks/s

std::vector<world::IVec3> voxels_of(const world::Fragment& fragment) {
  std::vector<world::IVec3> out;
  if (fragment.mass.blocks > kNamedVoxels) return out;
  for (const auto& [at, bits] : fragment.bricks) {
    for (int y = 0; y < world::BitBrick::kEdge; ++y) {
      for (std::uint64_t layer = bits.layers[y]; layer != 0; layer &= layer - 1) {
        const int bit = std::countr_zero(layer);
        out.push_back({at.x * 8 + bit / 8, at.y * 8 + y, at.z * 8 + bit % 8});
      }
    }
  }
  return out;
}

/// What parts a piece from what it broke off: away from the middle of the old island, so that it is
/// seen to be an island of its own. @param place in the old island's lattice.
glm::dvec3 parting(const world::Pose& pose, glm::dvec3 place) {
  const double far = std::sqrt(place.x * place.x + place.y * place.y + place.z * place.z);
  const glm::dvec3 away = far > 1.0 ? place / far : glm::dvec3(0.0, 1.0, 0.0);
  return kPartingSpeed * world::Turn::of(pose.rotation)(away);
}

}  // namespace

/// An edit was made: motion and the search for fragments follow it.
void Session::State::follow_edit(const Edit& edit, world::BlockId was) {
  const bool solid = world::is_solid(edit.block);
  if (solid == world::is_solid(was)) return;
  motion.edited(edit.island, {&edit.voxel, 1}, solid);
  if (const auto way = shapes.find(edit.island); way != shapes.end())
    way->second.edits[edit.voxel] = solid;
  worker.submit([this, edit, solid, at_s = time_s] { look_for_fragments(edit, solid, at_s); });
}

/// @param at_s the world's time; where the island is decides where its pieces are first seen.
void Session::State::look_for_fragments(const Edit& edit, bool solid, double at_s) {
  const std::uint64_t island = edit.island;
  const auto found = std::find_if(grids.begin(), grids.end(), [&](const KnownGrid& known) {
    return known.grid && known.island == island;
  });
  if (found == grids.end() && solid) return;  // what is not known breaks off nothing
  if (found == grids.end()) {
    grids.back() = {
        island, std::make_unique<world::SolidGrid>(world::SolidGrid::of_island(*world, island))};
    std::rotate(grids.begin(), grids.end() - 1, grids.end());
  } else {
    std::rotate(grids.begin(), found, found + 1);
  }
  world::SolidGrid& grid = *grids.front().grid;
  grid.set(edit.voxel, solid);
  if (solid) return;
  for (const world::Fragment& fragment : world::find_fragments(grid, {&edit.voxel, 1}).fragments) {
    const std::optional<world::BrokenOff> off = break_off(island, fragment, at_s);
    for (const auto& [at, bits] : fragment.bricks) grid.clear(at, bits);
    if (!off) continue;
    BrokenPiece piece;
    piece.island = off->island;
    piece.broken_off = island;
    piece.shift = off->shift;
    piece.mass = off->mass;
    piece.mass.centre += off->shift;
    piece.voxels = voxels_of(fragment);
    piece.shape = std::make_unique<world::Shape>(world::SolidGrid::of_island(*world, piece.island));
    pieces.put(std::move(piece));
  }
}

/// Copies the fragment while edits go on, and keeps them waiting only while it changes places.
std::optional<world::BrokenOff> Session::State::break_off(std::uint64_t island,
                                                          const world::Fragment& fragment,
                                                          double at_s) {
  const std::optional<world::Pose> pose = world->pose(island, at_s);
  if (!pose) return std::nullopt;
  std::uint64_t edits_then = edits_made;
  std::optional<world::LoosePiece> loose = world::copy_piece(*world, island, fragment);
  const std::scoped_lock lock(breaking, saving);
  if (edits_then != edits_made) loose = world::copy_piece(*world, island, fragment);
  if (!loose) return std::nullopt;
  world::BrokenOff off = world::break_off(*world, island, *loose, *pose);
  const std::lock_guard unsaved_lock(unsaved_mutex);
  unsaved.islands.insert(off.island);
  for (const world::IVec3& chunk : off.changed) unsaved.chunks.insert({island, chunk});
  for (const world::IVec3& chunk : world->chunks(off.island, 0))
    unsaved.chunks.insert({off.island, chunk});
  tell_break(island, *loose, off);
  return off;
}

/// With `breaking` held.
void Session::State::tell_break(std::uint64_t island, const world::LoosePiece& loose,
                                const world::BrokenOff& off) {
  std::vector<ChunkChanges> changes;
  for (const auto& [chunk, edits] : loose.taken) changes.push_back({island, chunk, edits});
  for (const world::IVec3& chunk : world->chunks(off.island, 0))
    changes.push_back({off.island, chunk, changes_of({off.island, chunk})});
  for (const std::shared_ptr<Client>& client : joined()) {
    client->introduced.insert(off.island);
    client->answers.put(IslandIs{*world->island(off.island), true, island, off.mass.blocks});
    if (!client->gets_voxels) continue;
    introduce(*client, island);
    for (const ChunkChanges& change : changes) client->answers.put(change);
  }
}

/// Session thread: pieces fly on as their voxels did, and a little apart.
void Session::State::take_in_pieces() {
  for (BrokenPiece& piece : pieces.take()) waiting_pieces.push_back(std::move(piece));
  for (BrokenPiece& piece : std::exchange(waiting_pieces, {})) {
    const auto was = motion.motion_at(piece.broken_off, piece.mass.centre);
    if (!was) {
      waiting_pieces.push_back(std::move(piece));
      continue;
    }
    world::MotionState state;
    state.pose = {world::moved(was->pose.origin, was->pose.rotation * piece.shift),
                  was->pose.rotation};
    state.velocity = was->velocity + parting(was->pose, piece.mass.centre);
    state.spin = was->spin;
    motion.add(piece.island, state, std::move(piece.shape));
    if (const auto way = shapes.find(piece.broken_off); way != shapes.end()) {
      for (const world::IVec3& voxel : piece.voxels) way->second.edits[voxel] = false;
      way->second.outdated |= piece.voxels.empty();
    }
    if (piece.voxels.empty()) {
      motion.reshape(piece.broken_off);
    } else {
      motion.edited(piece.broken_off, piece.voxels, false);
    }
  }
}

/// Shapes are made beside the frame. What was edited meanwhile is made up for; a shape that much
/// has broken off from is made again.
std::unique_ptr<world::Shape> Session::State::shape_for(std::uint64_t island) {
  if (const auto found = shapes.find(island); found != shapes.end()) {
    std::vector<std::unique_ptr<world::Shape>> made = found->second.box->take();
    if (made.empty()) return nullptr;
    const ShapeOnItsWay way = std::move(found->second);
    shapes.erase(found);
    if (!way.outdated) {
      for (const bool solid : {false, true}) {
        std::vector<world::IVec3> voxels;
        for (const auto& [voxel, is_solid] : way.edits)
          if (is_solid == solid) voxels.push_back(voxel);
        made.front()->edit(voxels, solid);
      }
      return std::move(made.front());
    }
  }
  ShapeOnItsWay& way = shapes[island];
  way.box = std::make_shared<Mailbox<std::unique_ptr<world::Shape>>>();
  shaper.submit([this, island, box = way.box] {
    if (leaving) return;
    box->put(std::make_unique<world::Shape>(world::SolidGrid::of_island(*world, island, &leaving)));
  });
  return nullptr;
}

}  // namespace skerry::game
