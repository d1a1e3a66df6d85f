#include "game/sound/room_keeper.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>

namespace skerry::game {
namespace {

constexpr int kHalf = SoundRoom::kEdge / 2;
constexpr double kMostOff = 8.0;  // blocks that the listener may be off the room's middle
constexpr double kStep = 0.1;     // seconds over which the speed of a contact is taken

/// An island's loaded voxels, a chunk at a time.
class Loaded {
 public:
  Loaded(world::World& world, std::uint64_t island) : world_(world), island_(island) {}
  world::BlockId at(world::IVec3 voxel) {
    const world::IVec3 chunk = world::chunk_of(voxel);
    if (!last_ || chunk != last_at_) {
      auto found = chunks_.find(chunk);
      if (found == chunks_.end()) {
        // chunk_now would generate one that is not loaded.
        const bool loaded = world_.block_at(island_, voxel).has_value();
        found = chunks_
                    .emplace(chunk,
                             loaded ? world_.chunk_now(island_, chunk) : world::Chunk(world::kAir))
                    .first;
      }
      last_ = &found->second;
      last_at_ = chunk;
    }
    const auto within = [](int v) {
      return static_cast<int>(world::floor_mod(v, world::kChunkEdge));
    };
    return last_->at(within(voxel.x), within(voxel.y), within(voxel.z));
  }

 private:
  world::World& world_;
  std::uint64_t island_;
  std::map<world::IVec3, world::Chunk> chunks_;
  const world::Chunk* last_ = nullptr;
  world::IVec3 last_at_;
};

template <class Body>
void for_cells(world::IVec3 low, world::IVec3 high, const Body& body) {
  for (int y = std::max(0, low.y); y < std::min(SoundRoom::kEdge, high.y); ++y)
    for (int x = std::max(0, low.x); x < std::min(SoundRoom::kEdge, high.x); ++x)
      for (int z = std::max(0, low.z); z < std::min(SoundRoom::kEdge, high.z); ++z)
        body(world::IVec3{x, y, z});
}

bool touches_solid(const SoundRoom& room, world::IVec3 c) {
  return room.is_solid(c) || room.is_solid({c.x + 1, c.y, c.z}) ||
         room.is_solid({c.x - 1, c.y, c.z}) || room.is_solid({c.x, c.y + 1, c.z}) ||
         room.is_solid({c.x, c.y - 1, c.z}) || room.is_solid({c.x, c.y, c.z + 1}) ||
         room.is_solid({c.x, c.y, c.z - 1});
}

glm::dvec3 in_lattice(const world::Pose& pose, world::WorldPos place) {
  return glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin);
}

}  // namespace

glm::dvec3 RoomKeeper::room_place(world::WorldPos place) const {
  return in_lattice(pose_, place) - glm::dvec3(corner_.x, corner_.y, corner_.z);
}

void RoomKeeper::follow(world::World& world, const Listener& listener, double seconds) {
  age_s_ += seconds;
  if (valid_ && island_ == listener.island && age_s_ < kRefreshSeconds) {
    if (island_)
      if (const auto pose = world.pose(*island_, listener.time_s)) pose_ = *pose;
    const glm::dvec3 off = glm::abs(room_place(listener.eye) - glm::dvec3(kHalf));
    if (std::max({off.x, off.y, off.z}) <= kMostOff) return;
  }
  read(world, listener);
}

void RoomKeeper::read(world::World& world, const Listener& listener) {
  valid_ = true;
  age_s_ = 0.0;
  island_ = listener.island;
  const auto pose = island_ ? world.pose(*island_, listener.time_s) : std::nullopt;
  pose_ = pose.value_or(world::Pose{listener.eye});
  const world::IVec3 middle = SoundRoom::cell_of(in_lattice(pose_, listener.eye));
  corner_ = {middle.x - kHalf, middle.y - kHalf, middle.z - kHalf};
  room_.clear();
  contacts_.clear();
  if (pose) read_own(world, *island_);
  for (const world::IslandSpec& spec : world.islands_near(listener.eye, kHalf, listener.time_s))
    if (spec.id != island_) read_other(world, spec.id, listener.time_s);
}

void RoomKeeper::read_own(world::World& world, std::uint64_t island) {
  const std::optional<world::IslandSpec> spec = world.island(island);
  if (!spec) return;
  Loaded voxels(world, island);
  const auto cell = [this](world::IVec3 v) {
    return world::IVec3{v.x - corner_.x, v.y - corner_.y, v.z - corner_.z};
  };
  for_cells(cell(spec->box_min), cell(spec->box_max), [&](world::IVec3 at) {
    if (const world::BlockId block = voxels.at(lattice(at)); block != world::kAir)
      room_.set(at, block);
  });
}

void RoomKeeper::read_other(world::World& world, std::uint64_t island, double time_s) {
  const auto spec = world.island(island);
  const auto pose = world.pose(island, time_s);
  if (!spec || !pose) return;
  Loaded voxels(world, island);
  // From the room's cells to the other lattice, all at once.
  const glm::dquat turn = glm::conjugate(pose->rotation) * pose_.rotation;
  const glm::dvec3 shift = in_lattice(*pose, pose_.origin);
  const glm::dvec3 corner(corner_.x, corner_.y, corner_.z);
  glm::dvec3 contact{};
  int touching = 0;
  std::vector<std::pair<world::IVec3, world::BlockId>> found;
  for_cells({0, 0, 0}, {SoundRoom::kEdge, SoundRoom::kEdge, SoundRoom::kEdge},
            [&](world::IVec3 at) {
              const world::IVec3 v =
                  SoundRoom::cell_of(turn * (SoundRoom::middle_of(at) + corner) + shift);
              if (v.x < spec->box_min.x || v.x >= spec->box_max.x || v.y < spec->box_min.y ||
                  v.y >= spec->box_max.y || v.z < spec->box_min.z || v.z >= spec->box_max.z)
                return;
              const world::BlockId block = voxels.at(v);
              if (block == world::kAir) return;
              found.emplace_back(at, block);
              if (medium_of(block) != SoundMedium::kSolid || !touches_solid(room_, at)) return;
              contact += SoundRoom::middle_of(at);
              ++touching;
            });
  for (const auto& [at, block] : found)
    if (!room_.is_solid(at)) room_.set(at, block);
  if (touching > 0) note_contact(world, island, contact / double(touching), time_s);
}

/// How fast one island's voxels pass the other's there, by where both were a moment ago.
void RoomKeeper::note_contact(world::World& world, std::uint64_t other, const glm::dvec3& at,
                              double time_s) {
  IslandContact contact{at};
  const auto own_before = island_ ? world.pose(*island_, time_s - kStep) : std::nullopt;
  const auto before = world.pose(other, time_s - kStep), now = world.pose(other, time_s);
  if (own_before && before && now) {
    const glm::dvec3 lattice = at + glm::dvec3(corner_.x, corner_.y, corner_.z);
    const world::WorldPos place = world::moved(pose_.origin, pose_.rotation * lattice);
    const world::WorldPos own = world::moved(own_before->origin, own_before->rotation * lattice);
    const world::WorldPos others =
        world::moved(before->origin, before->rotation * in_lattice(*now, place));
    contact.speed = glm::length(world::difference_blocks(own, others)) / kStep;
  }
  contacts_.push_back(contact);
}

void RoomKeeper::change(const VoxelChange& change) {
  if (!valid_ || island_ != change.island) {
    age_s_ = kRefreshSeconds;  // of another island: read anew
    return;
  }
  const world::IVec3 cell{change.voxel.x - corner_.x, change.voxel.y - corner_.y,
                          change.voxel.z - corner_.z};
  if (SoundRoom::inside(cell)) room_.set(cell, change.block);
}

}  // namespace skerry::game
