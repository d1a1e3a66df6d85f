#include "world/stream/stream.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "engine/core/check.h"
#include "world/generate/far_island.h"
#include "world/stream/stream_state.h"

namespace skerry::world {
namespace {

using Phase = StreamSlot::Phase;

// How far past a limit an island must be before it changes, as a share of the distance.
constexpr double kHysteresis = 1.05;

// The level an island keeps or takes, given the one it has.
int level_with_hysteresis(const IslandSpec& spec, int level, double distance, double detail) {
  const int nearer = island_level(spec, distance / kHysteresis, detail);
  const int further = island_level(spec, distance * kHysteresis, detail);
  return nearer <= level && level <= further ? level : island_level(spec, distance, detail);
}

// The first of the levels past the last one of VoxelSource at which an island is as at `level`.
int one_section_level(const IslandSpec& spec, int level) {
  while (level > kLevelCount && far_voxel_log2(spec, level - 1) == far_voxel_log2(spec, level))
    --level;
  return level;
}

// The chunks at a level whose meshes changed voxels show in: their own, and where they touch the
// border, the neighbours', but not those across an edge.
std::vector<IVec3> chunks_showing(const EditedBox& box, int level) {
  const auto coarse = [level](std::int32_t v) {
    return static_cast<std::int32_t>(floor_div(v, std::int64_t{1} << level));
  };
  const IVec3 low{coarse(box.min.x), coarse(box.min.y), coarse(box.min.z)};
  const IVec3 high{coarse(box.max.x), coarse(box.max.y), coarse(box.max.z)};
  const IVec3 first = chunk_of(low), last = chunk_of(high);
  const IVec3 before = chunk_of({low.x - 1, low.y - 1, low.z - 1});
  const IVec3 after = chunk_of({high.x + 1, high.y + 1, high.z + 1});
  std::vector<IVec3> chunks;
  for (std::int32_t y = before.y; y <= after.y; ++y) {
    for (std::int32_t x = before.x; x <= after.x; ++x) {
      for (std::int32_t z = before.z; z <= after.z; ++z) {
        const int outside =
            (x < first.x || x > last.x) + (y < first.y || y > last.y) + (z < first.z || z > last.z);
        if (outside <= 1) chunks.push_back({x, y, z});
      }
    }
  }
  return chunks;
}

}  // namespace

int island_level(const IslandSpec& spec, double distance_blocks, double detail_distance_blocks) {
  constexpr int kLast = kLevelCount + kFarLevelCount - 1;
  int level = 0;
  for (int next = 1; next <= kLast; ++next)
    if (distance_blocks >= level_from(spec, next, detail_distance_blocks)) level = next;
  return level;
}

double level_from(const IslandSpec& spec, int level, double detail_distance_blocks) {
  // The bounding sphere of an islet, whose outline is 12 blocks about, has 52: room for trees.
  constexpr double kLarge = 85.0, kMostLonger = 2.0;
  const double limit = std::ldexp(detail_distance_blocks, level - 1);
  if (level >= kLevelCount) return limit;
  const double share = kLarge / spec.bounding_radius;
  return limit * std::clamp(share * share, 1.0, kMostLonger);
}

Streamer::Streamer(World& world, Jobs& jobs, StreamOf made)
    : state_(std::make_shared<State>(world, jobs, made)) {}

Streamer::~Streamer() {
  std::unique_lock lock(state_->mutex);
  state_->stopping = true;
  state_->tasks.clear();
  state_->look_ahead.reset();
  state_->idle.wait(lock, [this] { return state_->running == 0; });
}

void Streamer::update(const StreamView& view, const StreamSettings& settings) {
  State& s = *state_;
  std::vector<std::uint64_t> voxels_unused, gone;
  const IslandPoses poses = s.world.poses(view.time_s);
  const bool is_new = s.look_around(view, settings, poses);
  const std::vector<EditedBox> edits = s.world.take_edits();
  {
    const std::lock_guard lock(s.mutex);
    if (is_new) s.drop_left(gone);
    s.place_islands(view, settings, poses, voxels_unused, gone);
    for (const EditedBox& edit : edits) s.apply_edit(edit);
    s.score_tasks();
  }
  for (const std::uint64_t id : voxels_unused) s.world.release_voxels(id);
  for (const std::uint64_t id : gone) {
    s.world.release_voxels(id);
    s.world.release_plan(id);
  }
  s.make_edited();
  s.submit_jobs();
}

bool Streamer::State::Look::holds_for(const Look& now) const {
  return reach == now.reach && revision == now.revision &&
         glm::length(difference_blocks(now.centre, centre)) <= slack;
}

bool Streamer::State::Look::wears_out(const Look& now) const {
  return glm::length(difference_blocks(now.centre, centre)) > 0.5 * slack;
}

std::vector<IslandSpec> Streamer::State::ask(const Look& look) const {
  return world.islands_near(look.centre, look.reach + look.slack, look.time_s);
}

// What a worker was asked ahead, if it has been found and holds now.
bool Streamer::State::take_answer(const Look& now, std::vector<IslandSpec>& specs) {
  const std::lock_guard lock(mutex);
  if (!answer) return false;
  Answer found = *std::exchange(answer, std::nullopt);
  around.asked_ahead = false;
  if (!found.look.holds_for(now)) return false;
  around.look = found.look;
  specs = std::move(found.specs);
  return true;
}

// All islands that can matter. The plan of a large view takes milliseconds, so that a worker looks
// for the next answer while the last one holds. What is in never depends on which answer it is.
// @return whether it is new.
bool Streamer::State::look_around(const StreamView& view, const StreamSettings& settings,
                                  const IslandPoses& poses) {
  // From one end of its drift to the other.
  const double reach = settings.view_distance_blocks * kHysteresis + 2.0 * kMaxIslandDriftBlocks;
  const Look now{view.camera, view.time_s, reach,
                 std::max(64.0, settings.view_distance_blocks / 32.0), world.revision()};
  const bool same_world = around.look.revision == now.revision;
  std::vector<IslandSpec> specs;
  if (!take_answer(now, specs)) {
    if (around.look.holds_for(now)) {
      if (!around.look.wears_out(now) || std::exchange(around.asked_ahead, true)) return false;
      const std::lock_guard lock(mutex);
      look_ahead = now;
      ++to_submit;
      return false;
    }
    specs = ask(now);
    around.look = now;
    ++around.asked;
  }
  around.left_out = {};
  for (std::size_t i = kMaxStreamedIslands; i < specs.size(); ++i) {
    const double distance = near_of(specs[i], view, poses).distance;
    if (distance > settings.view_distance_blocks) continue;
    double& nearest = around.left_out.from_blocks;
    nearest = around.left_out.islands++ == 0 ? distance : std::min(nearest, distance);
  }
  if (specs.size() > kMaxStreamedIslands) specs.resize(kMaxStreamedIslands);
  replace_candidates(specs, same_world);
  around.fastest = 0.0;
  for (const IslandSpec& spec : specs) {
    // Its bob is twice as quick as its way around.
    const double speed =
        2.0 * glm::length(spec.drift_amplitude) * 2.0 * std::numbers::pi / spec.drift_period_s;
    if (!poses.is_off_course(spec.id)) around.fastest = std::max(around.fastest, speed);
  }
  return true;
}

// Most have been there before: they are looked at when they are due, and not all in this frame.
void Streamer::State::replace_candidates(std::span<const IslandSpec> specs, bool same_world) {
  std::unordered_map<std::uint64_t, Candidate*> before;
  before.reserve(around.islands.size());
  for (Candidate& candidate : around.islands) before.emplace(candidate.spec.id, &candidate);
  std::vector<Candidate> now;
  now.reserve(specs.size());
  for (const IslandSpec& spec : specs) {
    now.push_back({.spec = spec});
    const auto found = before.find(spec.id);
    if (found == before.end()) continue;
    Candidate& old = *found->second;
    now.back().island = std::exchange(old.island, nullptr);
    if (same_world && old.spec.bounding_radius == spec.bounding_radius) now.back().due = old.due;
  }
  for (const Candidate& candidate : around.islands)
    if (candidate.island) around.left.push_back(candidate.island);
  around.islands = std::move(now);
}

Streamer::State::Near Streamer::State::near_of(const IslandSpec& spec, const StreamView& view,
                                               const IslandPoses& poses) {
  Near near{&spec, poses.of(spec), 0.0};
  near.distance =
      glm::length(difference_blocks(near.pose.origin, view.camera)) - spec.bounding_radius;
  return near;
}

namespace {

void remove_level(std::uint64_t island, const StreamLevel& level,
                  std::vector<SectionKey>& removed) {
  for (const auto& [chunk, slot] : level.slots)
    if (slot.resident) removed.push_back(level.key(island, chunk));
}

}  // namespace

void Streamer::State::drop_island(StreamIsland& island, std::vector<std::uint64_t>& gone) {
  const std::uint64_t id = island.spec.id;
  remove_level(id, island.shown, removed);
  for (const auto& [at, level] : island.beyond) remove_level(id, level, removed);
  gone.push_back(id);
  islands.erase(id);
}

// Those that are in and not around any more.
void Streamer::State::drop_left(std::vector<std::uint64_t>& gone) {
  for (StreamIsland* island : std::exchange(around.left, {})) drop_island(*island, gone);
}

namespace {

// How far past the limit of a level an island must end to have it beside the level of its near end,
// as a share of the distance: less of it is not worth another level.
constexpr double kFarEndBeyond = 1.25;

/// Blocks by which the distance of an island may change without a change of what is wanted of it.
double slack_of(const IslandSpec& spec, double distance, const StreamSettings& settings) {
  double slack = std::min(std::abs(distance - settings.view_distance_blocks),
                          std::abs(distance - settings.view_distance_blocks * kHysteresis));
  const auto stay_clear = [&slack](double of, double limit) {
    for (const double at : {limit / kHysteresis, limit, limit * kHysteresis})
      slack = std::min(slack, std::abs(of - at));
  };
  for (int level = 1; level < kLevelCount + kFarLevelCount; ++level)
    stay_clear(distance, level_from(spec, level, settings.detail_distance_blocks));
  for (int level = 1; settings.far_ends && level < kLevelCount; ++level)
    stay_clear(distance + 2.0 * spec.bounding_radius,
               level_from(spec, level, settings.detail_distance_blocks) * kFarEndBeyond);
  constexpr double kRounding = 0.01;
  return slack - kRounding;
}

}  // namespace

// Looks at the islands for which something may have changed: thousands are in view, and few of
// them come near a limit in a frame.
void Streamer::State::place_islands(const StreamView& view, const StreamSettings& settings,
                                    const IslandPoses& poses,
                                    std::vector<std::uint64_t>& voxels_unused,
                                    std::vector<std::uint64_t>& gone) {
  around.travelled += glm::length(difference_blocks(view.camera, around.view.camera)) +
                      around.fastest * std::abs(view.time_s - around.view.time_s);
  const bool all = settings.view_distance_blocks != around.settings.view_distance_blocks ||
                   settings.detail_distance_blocks != around.settings.detail_distance_blocks ||
                   settings.far_ends != around.settings.far_ends;
  around.view = view;
  around.settings = settings;
  const double limit = settings.view_distance_blocks * kHysteresis;
  for (Candidate& candidate : around.islands) {
    const bool busy = candidate.island && candidate.island->busy();
    if (!all && !busy && around.travelled < candidate.due) continue;
    const Near near = near_of(candidate.spec, view, poses);
    const bool steered = poses.is_off_course(candidate.spec.id);
    candidate.due =
        steered ? 0.0 : around.travelled + slack_of(candidate.spec, near.distance, settings);
    if (near.distance <= limit)
      place_island(candidate, near, view, settings, voxels_unused);
    else if (candidate.island)
      drop_island(*std::exchange(candidate.island, nullptr), gone);
  }
}

// The level that stands for one that its distance gives an island: only what is as its seed makes
// it has far levels, and no more of them than its size has uses for.
int Streamer::State::level_of(const IslandSpec& spec, int level) const {
  if (level < kLevelCount) return level;
  if (!world.is_as_generated(spec.id)) return kLevelCount - 1;
  return one_section_level(spec, level);
}

void Streamer::State::place_island(Candidate& candidate, const Near& near, const StreamView& view,
                                   const StreamSettings& settings,
                                   std::vector<std::uint64_t>& voxels_unused) {
  const IslandSpec& spec = *near.spec;
  const bool is_new = !candidate.island;
  if (is_new) {
    if (!(near.distance <= settings.view_distance_blocks)) return;
    candidate.island = &islands.try_emplace(spec.id).first->second;
    candidate.island->spec = spec;
  }
  StreamIsland& island = *candidate.island;
  const glm::dquat lattice_from_world = glm::conjugate(near.pose.rotation);
  island.distance = near.distance;
  island.camera = lattice_from_world * difference_blocks(view.camera, near.pose.origin);
  island.forward = lattice_from_world * view.forward;
  if (is_new) {
    const int level =
        level_of(spec, island_level(spec, near.distance, settings.detail_distance_blocks));
    // Unless the camera is among its rocks, the island is there as a whole at first.
    const bool coarse_first =
        level < kLevelCount && near.distance > 0.0 && world.is_as_generated(spec.id);
    if (coarse_first) island.shown = start_level(spec, kLevelCount);
    (coarse_first ? island.coming.emplace() : island.shown) = start_level(spec, level);
    change_far_end(island, settings);
    return;
  }
  const int had = island.target().level;
  const int wanted =
      level_with_hysteresis(spec, had, near.distance, settings.detail_distance_blocks);
  const bool same =
      wanted == had || (wanted >= kLevelCount && one_section_level(spec, wanted) == had);
  const int level = same ? had : level_of(spec, wanted);
  if (level != had) {
    change_level(island, level);
    if (had == 0 && island.shown.level != 0) voxels_unused.push_back(spec.id);
  }
  change_far_end(island, settings);
}

// Starts the levels that the far end of an island wants, and drops those that it does not.
void Streamer::State::change_far_end(StreamIsland& island, const StreamSettings& settings) {
  const double end = (island.distance + 2.0 * island.spec.bounding_radius) / kFarEndBeyond;
  const bool none = !settings.far_ends || island.target().far();
  const int had = island.far_end;
  island.far_end =
      none ? 0
           : std::min(kLevelCount - 1, level_with_hysteresis(island.spec, had, end,
                                                             settings.detail_distance_blocks));
  for (auto entry = island.beyond.begin(); entry != island.beyond.end();) {
    const bool wanted = island.wants_beyond(entry->first);
    if (!wanted) remove_level(island.spec.id, entry->second, removed);
    entry = wanted ? std::next(entry) : island.beyond.erase(entry);
  }
  for (int level = island.target().level + 1; level <= island.far_end; ++level)
    if (level != island.shown.level && !island.beyond.contains(level))
      island.beyond.emplace(level, start_level(island.spec, level, true));
}

void Streamer::State::change_level(StreamIsland& island, int level) {
  island.coming.reset();
  if (level == island.shown.level) {
    for (auto& [chunk, slot] : island.shown.slots) {
      if (slot.phase != Phase::kIdle) continue;
      slot.phase = Phase::kQueued;
      ++island.shown.unmade;
      queue_chunk(island.spec.id, island.shown, chunk, false);
    }
    return;
  }
  // It may be there for the far end.
  auto known = island.beyond.extract(level);
  StreamLevel started = known ? std::move(known.mapped()) : start_level(island.spec, level);
  if (island.shown.any_resident()) {
    island.coming = std::move(started);
  } else {
    island.shown = std::move(started);
  }
}

void Streamer::State::apply_edit(const EditedBox& edit) {
  const auto found = islands.find(edit.island);
  if (found == islands.end()) return;
  StreamIsland& island = found->second;
  if (island.target().far()) change_level(island, kLevelCount - 1);  // it is no longer as it was
  if (!island.shown.far()) {
    for (const IVec3& chunk : chunks_showing(edit, island.shown.level)) {
      remake(edit.island, island.shown, chunk, true);
    }
  }
  for (auto& [at, level] : island.beyond)
    for (const IVec3& chunk : chunks_showing(edit, at)) remake(edit.island, level, chunk, true);
  if (!island.coming) return;
  for (const IVec3& chunk : chunks_showing(edit, island.coming->level)) {
    remake(edit.island, *island.coming, chunk, true);
  }
}

namespace {

// Moves one made chunk into an update. @return its quads.
std::size_t hand_out(const SectionKey& key, StreamSlot& slot, StreamUpdate& update) {
  const std::size_t quads = slot.mesh.quads.size();
  if (slot.resident) update.removed.push_back(key);
  slot.resident = slot.has_something();
  slot.phase = Phase::kDone;
  if (slot.resident)
    update.ready.push_back({key, std::exchange(slot.mesh, {}), std::exchange(slot.leaves, {}),
                            std::exchange(slot.occupancy, {}), std::exchange(slot.emitters, {}),
                            std::exchange(slot.seams, {}), std::exchange(slot.stained, {})});
  return quads;
}

// Hands out the levels of far ends of which all is made. @return quads.
std::size_t hand_out_beyond(StreamIsland& island, StreamUpdate& update) {
  std::size_t quads = 0;
  for (auto& [at, level] : island.beyond) {
    if (!level.all_made() || level.made == 0) continue;
    for (auto& [chunk, slot] : level.slots) {
      if (slot.phase != Phase::kMade) continue;
      quads += hand_out(level.key(island.spec.id, chunk), slot, update);
      --level.made;
    }
  }
  return quads;
}

// They stand beside the blocks of the island, not beside its far section.
bool has_beyond(const StreamIsland& island) {
  return !island.shown.far() &&
         std::any_of(island.beyond.begin(), island.beyond.end(), [](const auto& entry) {
           return entry.second.all_made() && entry.second.made > 0;
         });
}

}  // namespace

StreamUpdate Streamer::poll(std::size_t max_quads) {
  State& s = *state_;
  StreamUpdate update;
  std::vector<std::uint64_t> voxels_unused;
  {
    const std::lock_guard lock(s.mutex);
    update.removed = std::exchange(s.removed, {});
    std::vector<StreamIsland*> waiting;
    for (auto& [id, island] : s.islands) {
      if (island.swappable() || ((!island.coming || island.shown.far()) && island.shown.made > 0) ||
          has_beyond(island))
        waiting.push_back(&island);
    }
    std::sort(waiting.begin(), waiting.end(), [](const StreamIsland* a, const StreamIsland* b) {
      return std::tie(a->distance, a->spec.id) < std::tie(b->distance, b->spec.id);
    });
    std::size_t quads = 0;
    for (StreamIsland* island : waiting) {
      if (quads >= max_quads) break;
      const std::uint64_t id = island->spec.id;
      // What takes the place of nothing may come in parts.
      const bool swap = island->swappable() && island->shown.any_resident();
      if (island->swappable()) {
        StreamLevel before = std::exchange(island->shown, std::move(*island->coming));
        island->coming.reset();
        if (before.level == 0) voxels_unused.push_back(id);
        if (island->wants_beyond(before.level) && before.all_made())
          island->beyond.emplace(before.level, std::move(before));
        else
          remove_level(id, before, update.removed);
      }
      for (auto& [chunk, slot] : island->shown.slots) {
        if (slot.phase != Phase::kMade) continue;
        if (quads >= max_quads && !swap) break;
        quads += hand_out(island->shown.key(id, chunk), slot, update);
        --island->shown.made;
      }
      if (has_beyond(*island)) quads += hand_out_beyond(*island, update);
    }
  }
  for (const std::uint64_t id : voxels_unused) s.world.release_voxels(id);
  return update;
}

const Streamer::LeftOut& Streamer::left_out() const {
  return state_->around.left_out;
}

bool Streamer::complete() const {
  const State& s = *state_;
  const std::lock_guard lock(s.mutex);
  if (!s.all_made() || !s.removed.empty()) return false;
  return std::none_of(s.islands.begin(), s.islands.end(),
                      [](const auto& entry) { return entry.second.busy(); });
}

bool Streamer::settled(std::uint64_t island) const {
  const State& s = *state_;
  const std::lock_guard lock(s.mutex);
  const auto found = s.islands.find(island);
  return found != s.islands.end() && !found->second.busy();
}

void Streamer::wait_until_complete() {
  std::unique_lock lock(state_->mutex);
  state_->idle.wait(lock, [this] { return state_->all_made(); });
}

Streamer::Stats Streamer::stats() const {
  const State& s = *state_;
  const std::lock_guard lock(s.mutex);
  Stats stats;
  stats.islands = s.islands.size();
  stats.tasks_left = s.tasks.size() + static_cast<std::size_t>(s.running);
  stats.chunks_made = s.chunks_made;
  stats.times_asked = s.around.asked;
  for (const auto& [id, island] : s.islands) {
    const StreamLevel& shown = island.shown;
    for (const auto& [chunk, slot] : shown.slots) stats.sections += slot.resident;
    for (const auto& [at, level] : island.beyond)
      for (const auto& [chunk, slot] : level.slots) stats.sections += slot.resident;
    const bool is_empty = shown.planned && shown.unmade == 0 && shown.made == 0;
    stats.unshown += !is_empty && !shown.any_resident();
  }
  return stats;
}

}  // namespace skerry::world
