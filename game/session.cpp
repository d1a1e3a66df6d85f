#include "game/session.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/platform/files.h"
#include "game/open_world.h"
#include "game/session_state.h"
#include "game/vdb_world.h"

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
      saved_at(std::chrono::steady_clock::now()) {}

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
const std::optional<SavedPlay>& Session::saved_play() const {
  return state_->saved;
}
bool Session::read_only() const {
  return state_->read_only;
}

void Session::send(Request request) {
  state_->requests.put(std::move(request));
}

std::vector<Answer> Session::receive() {
  return state_->answers.take();
}

EditAnswer Session::request(const Edit& edit) {
  state_->handle_sent();
  return state_->edit(edit);
}

void Session::advance(double world_time_s) {
  State& s = *state_;
  const double passed = std::clamp(world_time_s - s.time_s, 0.0, 1.0);
  s.time_s = world_time_s;
  s.edits_left = std::min(kEditBurst, s.edits_left + passed * kEditsPerSecond);
  s.handle_sent();
  s.take_in_pieces();
  s.motion.advance_to(world_time_s);
  s.save_soon();
}

void Session::rest() {
  advance(state_->time_s);
}

void Session::State::handle_sent() {
  for (const Request& request : requests.take()) handle(request);
}

void Session::State::handle(const Request& request) {
  struct Handler {
    State& s;
    void operator()(const Join&) {
      Joined joined;
      joined.play = s.saved;
      joined.read_only = s.read_only;
      if (s.file) joined.world = s.file->info();
      if (!s.file) joined.world.desc = s.world->desc();
      s.answers.put(joined);
      s.answers.put(TimeIs{s.time_s});
      for (const world::MovingIsland& m : s.motion.states())
        s.answers.put(IslandMoved{m.island, m.state});
    }
    void operator()(const ChunkWanted& wanted) {
      s.answers.put(
          ChunkChanges{wanted.island, wanted.chunk, s.world->edits(wanted.island, wanted.chunk)});
    }
    void operator()(const Edit& edit) { s.answers.put(s.edit(edit)); }
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

EditAnswer Session::State::edit(const Edit& edit) {
  EditAnswer answer{edit, EditVerdict::kDone, world::kAir};
  // While voxels go from one island to another, nobody can tell which of them this one is on.
  const std::lock_guard lock(breaking);
  answer.verdict = verdict(edit, answer.was);
  if (answer.verdict != EditVerdict::kDone) return answer;
  edits_left -= 1.0;
  world->set_block(edit.island, edit.voxel, edit.block);
  ++edits_made;
  {
    const std::lock_guard unsaved_lock(unsaved_mutex);
    unsaved.chunks.insert({edit.island, world::chunk_of(edit.voxel)});
  }
  follow_edit(edit, answer.was);
  return answer;
}

}  // namespace skerry::game
