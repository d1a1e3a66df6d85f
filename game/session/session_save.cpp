// Loading and saving a session.
#include <algorithm>
#include <limits>
#include <utility>

#include "game/session/session_state.h"

namespace skerry::game {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kAutosavePeriod{5};
// A state is written between two frames; no frame takes longer.
constexpr double kMostAhead_s = 1.0;

}  // namespace

void Session::State::load(world::LoadedWorld& loaded) {
  plays = saved_plays(*file);
  journals = journals_written = std::make_shared<Journals>(saved_journals(*file));
  notices = file->damage();
  if (read_only)
    notices.push_back("this world may not be written: nothing of this play will be saved");
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  double played_s = kNever, islands_s = 0.0;
  for (const auto& [player, play] : plays) played_s = std::max(played_s, play.world_time_s);
  for (const world::MovingIsland& m : loaded.moving)
    islands_s = std::max(islands_s, static_cast<double>(m.state.tick) * world::kMotionTickSeconds);
  time_s = plays.empty() ? islands_s : played_s;
  islands_s = std::max(islands_s, time_s);
  // Islands go on at the tick they were saved at, a little ahead of the player's. One that is far
  // ahead is wrong about it: all would stand still till then.
  motion.start(islands_s - time_s < kMostAhead_s ? islands_s : time_s);
  for (const world::MovingIsland& m : loaded.moving) motion.add(m.island, m.state);
}

/// Hands what changed to the saver, unless that is busy or it is too soon.
void Session::State::save_soon() {
  if (!file || read_only || Clock::now() - saved_at < kAutosavePeriod) return;
  {
    const std::lock_guard lock(problem_mutex);
    if (!problem.empty()) tell_all(std::exchange(problem, {}));
  }
  if (save_under_way.exchange(true)) return;
  saved_at = Clock::now();
  saver.submit([this, now = snapshot()] {
    if (const Result<void> done = write(now); !done) {
      const std::lock_guard lock(problem_mutex);
      problem = done.error().message;
    }
    save_under_way = false;
  });
}

void Session::save_next() {
  state_->saved_at = Clock::now() - kAutosavePeriod;
}

/// What cannot be written counts as unsaved again.
Result<void> Session::State::write(const Snapshot& now) {
  Unsaved what;
  std::map<std::uint64_t, world::IslandRow> rows;
  std::vector<std::pair<world::ChunkName, world::ChunkEdits>> edits;
  std::vector<std::pair<world::ChunkName, world::Chunk>> chunks;
  {
    // No island breaks meanwhile: its voxels are saved where they came from or where they went.
    const std::lock_guard lock(saving);
    {
      const std::lock_guard unsaved_lock(unsaved_mutex);
      what = std::exchange(unsaved, {});
    }
    const std::vector<std::uint64_t> list = world->added_islands();
    const std::set<std::uint64_t> added(list.begin(), list.end());
    const auto want_row = [&](std::uint64_t id) {
      if (const std::optional<world::IslandSpec> spec = world->island(id))
        rows.try_emplace(id, world::IslandRow{*spec, added.contains(id), {}});
    };
    for (const world::MovingIsland& m : now.moving) {
      want_row(m.island);
      if (const auto row = rows.find(m.island); row != rows.end()) row->second.motion = m.state;
    }
    for (const std::uint64_t id : what.islands) want_row(id);
    for (const world::ChunkName& name : what.chunks) {
      want_row(name.island);
      if (added.contains(name.island)) {
        chunks.emplace_back(name, world->chunk_now(name.island, name.chunk));
      } else {
        edits.emplace_back(name, world->edits(name.island, name.chunk));
      }
    }
  }
  world::WorldFile::Transaction transaction = file->begin();
  for (const auto& [id, row] : rows) {
    if (what.islands.contains(id)) {
      transaction.put_new_island(row);
    } else {
      transaction.put_island(row);
    }
  }
  for (const auto& [name, list] : edits) transaction.put_edits(name.island, name.chunk, list);
  for (const auto& [name, chunk] : chunks) transaction.put_chunk(name.island, name.chunk, chunk);
  put_plays(transaction, now.plays);
  if (now.journals != journals_written) put_journals(transaction, *now.journals);
  Result<void> done = transaction.commit();
  if (done) {
    journals_written = now.journals;
  } else {
    const std::lock_guard lock(unsaved_mutex);
    unsaved.merge(what);
  }
  return done;
}

Result<void> Session::save() {
  State& s = *state_;
  const std::lock_guard lock(s.running);
  s.handle_sent();
  s.worker.wait();
  s.take_in_pieces();
  s.tell_moves();
  if (!s.file || s.read_only) return {};
  s.saver.wait();
  return s.write(s.snapshot());
}

}  // namespace skerry::game
