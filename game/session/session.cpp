#include "game/session/session.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/platform/files.h"
#include "game/session/session_state.h"
#include "game/worlds/open_world.h"
#include "game/worlds/vdb_world.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::WorldFile;

constexpr std::int32_t kFarthestVoxel = 1
                                        << 20;  // as far from its middle as an island may be built

bool may_write(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  return ::access(path.c_str(), W_OK) == 0 && ::access(folder.c_str(), W_OK) == 0;
}

/// From a place in the lattice to the nearest point of a voxel.
double distance_to(const world::IVec3& voxel, const glm::dvec3& place) {
  const glm::dvec3 low{voxel.x, voxel.y, voxel.z};
  return glm::distance(place, glm::clamp(place, low, low + 1.0));
}

}  // namespace

Session::State::State(std::shared_ptr<world::World> opened)
    : world(std::move(opened)),
      motion(*world, [this](std::uint64_t island) { return shape_for(island); }),
      saved_at(std::chrono::steady_clock::now()) {
  motion.report_to(&moves);
}

Session::State::~State() {
  leaving = true;
}

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}

Session::~Session() {
  // What cannot be saved now has been told before, or there is nobody left to tell.
  static_cast<void>(save());
}

Result<std::unique_ptr<Session>> Session::open(const SceneOptions& options) {
  if (!options.world || is_vdb(*options.world)) {
    Result<std::unique_ptr<world::World>> made = open_world(options);
    if (!made) return made.error();
    auto state = std::make_unique<State>(*std::move(made));
    state->time_s = options.settings.world_time_s;
    state->motion.start(state->time_s);
    return std::unique_ptr<Session>(new Session(std::move(state)));
  }
  const std::filesystem::path path = *options.world;
  const bool writable = may_write(path);
  auto file = WorldFile::open(path, writable ? WorldFile::Mode::kWrite : WorldFile::Mode::kRead);
  if (!file) return file.error();
  world::LoadedWorld loaded = world::load_world(**file);
  auto state = std::make_unique<State>(std::move(loaded.world));
  state->file = *std::move(file);
  state->read_only = !writable;
  state->load(loaded);
  return std::unique_ptr<Session>(new Session(std::move(state)));
}

Result<std::unique_ptr<Session>> Session::create(const std::filesystem::path& path,
                                                 const world::WorldInfo& info) {
  if (const auto made = platform::make_dirs(path.parent_path()); !made) return made.error();
  if (const auto made = WorldFile::create(path, info); !made) return made.error();
  SceneOptions options;
  options.world = path.string();
  return open(options);
}

std::shared_ptr<world::World> Session::world() const {
  return state_->world;
}
void Session::send(Request request) {
  state_->requests.put(std::move(request));
}

std::vector<Answer> Session::receive() {
  return state_->answers.take();
}

void Session::attend() {
  state_->handle_sent();
}

void Session::advance(double seconds) {
  State& s = *state_;
  s.handle_sent();
  s.time_s += seconds;
  s.edits_left = std::min(kEditBurst, s.edits_left + std::max(0.0, seconds) * kEditsPerSecond);
  s.take_in_pieces();
  s.motion.advance_to(s.time_s);
  s.tell_moves();
  if (s.joined && seconds != 0.0) s.answers.put(TimeIs{s.time_s});
  s.save_soon();
}

void Session::State::handle_sent() {
  for (const Request& request : requests.take()) handle(request);
}

void Session::State::handle(const Request& request) {
  struct Handler {
    State& s;
    void operator()(const Join& join) { s.join(join); }
    void operator()(const ChunkWanted& wanted) { s.tell_chunk({wanted.island, wanted.chunk}); }
    void operator()(const Edit& edit) { s.edit(edit); }
    void operator()(const PlayerMoved& moved) { s.play = moved.play; }
    void operator()(const Steer& steer) {
      const auto finite = [](double v) { return std::isfinite(v); };
      if (!finite(steer.thrust.x) || !finite(steer.thrust.y) || !finite(steer.thrust.z) ||
          !finite(steer.turn))
        return;
      // Only who stands on an island steers it; who fell off may let go.
      const bool lets_go = steer.thrust == glm::dvec3{} && steer.turn == 0.0;
      if (lets_go || (s.play && s.play->player.island == steer.island))
        s.motion.steer(steer.island, steer.thrust, steer.turn);
    }
  };
  std::visit(Handler{*this}, request);
}

void Session::State::join(const Join& join) {
  // Nothing breaks between what is listed here and what is told from now on.
  const std::lock_guard lock(breaking);
  joined = true;
  voxels_told = !join.shares_world;
  introduced.clear();
  Joined told;
  told.play = saved;
  told.read_only = read_only;
  if (file) told.world = file->info();
  if (!file) told.world.desc = world->desc();
  const std::vector<std::uint64_t> islands = world->changed_islands();
  for (const std::uint64_t id : islands)
    for (const world::IVec3& chunk :
         world->is_added(id) ? world->chunks(id, 0) : world->edited_chunks(id))
      told.changed.push_back({id, chunk});
  answers.put(std::move(told));
  answers.put(TimeIs{time_s});
  for (const std::uint64_t id : islands) introduce(id);
  answers.put(IslandsMoved{motion.states()});
}

/// Names an island that is not as the seed makes it, once. With `breaking` held.
void Session::State::introduce(std::uint64_t island) {
  if (!introduced.insert(island).second) return;
  if (const std::optional<world::IslandSpec> spec = world->island(island))
    answers.put(IslandIs{*spec, world->is_added(island)});
}

void Session::State::tell_moves() {
  IslandsMoved told{std::exchange(moves, {})};
  if (!joined || told.moves.empty()) return;
  const std::lock_guard lock(breaking);
  for (const world::MovingIsland& move : told.moves) introduce(move.island);
  answers.put(std::move(told));
}

void Session::State::tell_chunk(const world::ChunkName& name) {
  const std::lock_guard lock(breaking);
  answers.put(ChunkChanges{name.island, name.chunk, changes_of(name)});
}

/// Of an island that no seed made, all its blocks.
world::ChunkEdits Session::State::changes_of(const world::ChunkName& name) {
  if (!world->is_added(name.island)) return world->edits(name.island, name.chunk);
  std::vector<BlockId> blocks(world::kChunkVoxels);
  world->chunk_now(name.island, name.chunk).unpack(blocks);
  world::ChunkEdits all;
  for (std::uint32_t i = 0; i < world::kChunkVoxels; ++i)
    if (blocks[i] != world::kAir) all.push_back({i, blocks[i]});
  return all;
}

EditVerdict Session::State::verdict(const Edit& edit, BlockId& was) {
  const world::IVec3& v = edit.voxel;
  if (edit.block >= world::block::kBuiltInCount) return EditVerdict::kNoSuchBlock;
  if (std::max({std::abs(std::int64_t{v.x}), std::abs(std::int64_t{v.y}),
                std::abs(std::int64_t{v.z})}) >= kFarthestVoxel)
    return EditVerdict::kTooFar;
  const std::optional<world::Pose> pose = world->pose(edit.island, time_s);
  if (!pose) return EditVerdict::kNoSuchIsland;
  if (!play) return EditVerdict::kTooFar;
  const glm::dvec3 eye =
      glm::conjugate(pose->rotation) * world::difference_blocks(play->eye.position, pose->origin);
  if (!(distance_to(v, eye) <= kSessionReach)) return EditVerdict::kTooFar;
  const std::optional<BlockId> there = world->block_at(edit.island, v);
  if (!there) return EditVerdict::kUnknown;
  was = *there;
  if (edit.block == world::kAir && was == world::kAir) return EditVerdict::kEmpty;
  if (world::is_solid(was) && world::is_solid(edit.block)) return EditVerdict::kOccupied;
  if (edits_left < 1.0) return EditVerdict::kTooFast;
  return EditVerdict::kDone;
}

void Session::State::edit(const Edit& edit) {
  EditAnswer answer{edit, EditVerdict::kDone, world::kAir};
  // While voxels go from one island to another, nobody can tell which of them this one is on.
  const std::lock_guard lock(breaking);
  answer.verdict = verdict(edit, answer.was);
  if (answer.verdict == EditVerdict::kDone) {
    edits_left -= 1.0;
    world->set_block(edit.island, edit.voxel, edit.block);
    ++edits_made;
    {
      const std::lock_guard unsaved_lock(unsaved_mutex);
      unsaved.chunks.insert({edit.island, world::chunk_of(edit.voxel)});
    }
    follow_edit(edit, answer.was);
  }
  answers.put(answer);
}

}  // namespace skerry::game
