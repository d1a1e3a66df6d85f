#include "world/stream/stream_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "world/generate/far_island.h"

namespace skerry::world {
namespace {

using Phase = StreamSlot::Phase;

// What lies outside a cone about the view direction waits as if it were this much further away.
constexpr double kOutOfViewFactor = 3.0;
constexpr double kViewConeCos = 0.5;
constexpr double kEditedCost = -2.0;
constexpr double kBeyondCost = 1e6;
// A block at the corner of a chunk shows in four. What is more, such as an island that was cut in
// two, comes from the workers.
constexpr int kEditedAFrame = 8;

bool costlier(const StreamTask& a, const StreamTask& b) {
  return a.cost > b.cost;
}

double distance_cost(const glm::dvec3& to, const glm::dvec3& forward, double radius) {
  const double distance = std::sqrt(glm::dot(to, to));
  const bool in_view = distance < radius || glm::dot(to, forward) > kViewConeCos * distance;
  const double near = std::max(0.0, distance - radius);
  return in_view ? near : kOutOfViewFactor * near;
}

// Leaves hide only each other: where a chunk has some, it shows some, unless it is full of them.
bool has_cutouts(const ChunkMesh& mesh) {
  return mesh.range_end[shared::kRangePlant - 1] != mesh.range_end[shared::kRangeCutout - 1];
}

/// Whether it shows a face of stained glass.
bool has_stained_glass(const ChunkMesh& mesh) {
  return std::any_of(
      mesh.quads.begin() + mesh.range_end[shared::kRangeTranslucent - 1], mesh.quads.end(),
      [](const shared::Quad& quad) {
        return is_stained_glass(static_cast<BlockId>(shared::surface_block(quad.material)));
      });
}

}  // namespace

StreamLevel Streamer::State::start_level(const IslandSpec& spec, int level, bool beyond) {
  StreamLevel started;
  started.level = started.voxel_log2 = level;
  started.serial = ++last_serial;
  if (started.far()) {
    started.voxel_log2 = far_voxel_log2(spec, level);
    started.planned = true;
    started.slots.try_emplace(IVec3{});
    started.unmade = 1;
    queue_chunk(spec.id, started, {}, false);
  } else {
    StreamTask task;
    task.island = spec.id;
    task.serial = started.serial;
    task.level = level;
    task.beyond = beyond;
    push_task(task);
  }
  return started;
}

StreamLevel* Streamer::State::find_level(std::uint64_t island, std::uint64_t serial) {
  const auto found = islands.find(island);
  if (found == islands.end()) return nullptr;
  StreamIsland& state = found->second;
  if (state.shown.serial == serial) return &state.shown;
  if (state.coming && state.coming->serial == serial) return &*state.coming;
  for (auto& [at, level] : state.beyond)
    if (level.serial == serial) return &level;
  return nullptr;
}

double Streamer::State::cost_of(const StreamTask& task) const {
  if (task.edited) return kEditedCost;
  const auto found = islands.find(task.island);
  if (found == islands.end()) return 0.0;
  const StreamIsland& island = found->second;
  if (task.far) return -1.0 / (1.0 + std::max(0.0, island.distance));  // before all that is finer
  const double last = task.beyond ? kBeyondCost : 0.0;
  if (!task.chunk) {
    return last + distance_cost(-island.camera, island.forward, island.spec.bounding_radius);
  }
  const double edge = static_cast<double>(kChunkEdge << task.level);
  const glm::dvec3 centre{(task.chunk->x + 0.5) * edge, (task.chunk->y + 0.5) * edge,
                          (task.chunk->z + 0.5) * edge};
  return last + distance_cost(centre - island.camera, island.forward, edge * 0.5);
}

void Streamer::State::push_task(const StreamTask& task) {
  tasks.push_back(task);
  tasks.back().cost = cost_of(task);
  std::push_heap(tasks.begin(), tasks.end(), costlier);
  ++to_submit;
}

void Streamer::State::score_tasks() {
  std::erase_if(tasks, [this](const StreamTask& t) { return !find_level(t.island, t.serial); });
  for (StreamTask& task : tasks) task.cost = cost_of(task);
  std::make_heap(tasks.begin(), tasks.end(), costlier);
}

void Streamer::State::queue_chunk(std::uint64_t island, const StreamLevel& level, IVec3 chunk,
                                  bool edited) {
  const StreamIsland& of = islands.at(island);
  const bool beyond = level.serial != of.shown.serial && level.serial != of.target().serial;
  push_task({island, level.serial, chunk, level.voxel_log2, level.far(), edited && level.level == 0,
             beyond});
}

// Makes a chunk once more, or for the first time.
void Streamer::State::remake(std::uint64_t island, StreamLevel& level, IVec3 chunk, bool edited) {
  if (!level.planned) {
    level.edited_early.push_back(chunk);
    return;
  }
  const auto [at, is_new] = level.slots.try_emplace(chunk);
  StreamSlot& slot = at->second;
  if (!is_new) {
    if (slot.phase == Phase::kQueued || slot.phase == Phase::kIdle) return;
    if (slot.phase == Phase::kRunning) {
      slot.stale = true;
      return;
    }
    if (slot.phase == Phase::kMade) --level.made;
  }
  slot.phase = Phase::kQueued;
  ++level.unmade;
  queue_chunk(island, level, chunk, edited);
}

void Streamer::State::submit_jobs() {
  std::size_t count = 0;
  {
    const std::lock_guard lock(mutex);
    count = std::exchange(to_submit, 0);
  }
  for (; count > 0; --count) {
    jobs.submit([state = shared_from_this()] { state->run_task(); });
  }
}

// The cheapest task that is still wanted. Chunks of a level that is about to be replaced are put
// aside: they are only wanted if the island changes its mind. A far section is shown meanwhile.
bool Streamer::State::take_task(StreamTask& task) {
  while (!tasks.empty()) {
    std::pop_heap(tasks.begin(), tasks.end(), costlier);
    task = tasks.back();
    tasks.pop_back();
    StreamLevel* level = find_level(task.island, task.serial);
    if (!level) continue;
    if (!task.chunk) return true;
    StreamSlot& slot = level->slots.at(*task.chunk);
    const StreamIsland& island = islands.at(task.island);
    if (island.coming && level == &island.shown && !slot.resident && !task.far) {
      slot.phase = Phase::kIdle;
      --level->unmade;
      continue;
    }
    slot.phase = Phase::kRunning;
    return true;
  }
  return false;
}

void Streamer::State::run_task() {
  std::unique_lock lock(mutex);
  StreamTask task;
  if (!stopping && look_ahead) {
    ++running;
    run_look(lock);
    --running;
  } else if (!stopping && take_task(task)) {
    ++running;
    running_edited += task.edited;
    run(task, lock);
    --running;
    running_edited -= task.edited;
  }
  const bool last_edited = task.edited && running_edited == 0;
  if (all_made() || last_edited || (stopping && running == 0)) idle.notify_all();
  lock.unlock();
  submit_jobs();
}

void Streamer::State::run_look(std::unique_lock<std::mutex>& lock) {
  const Look look = *std::exchange(look_ahead, std::nullopt);
  lock.unlock();
  std::vector<IslandSpec> specs = ask(look);
  lock.lock();
  answer = Answer{look, std::move(specs)};
}

void Streamer::State::make_edited() {
  std::unique_lock lock(mutex);
  StreamTask task;
  for (int i = 0; i < kEditedAFrame && !tasks.empty() && tasks.front().edited; ++i) {
    if (!take_task(task)) break;
    ++running;
    run(task, lock);
    --running;
  }
  // Those that a worker took first take it as long.
  idle.wait(lock, [this] { return running_edited == 0; });
}

// Does a task's work without the lock, then takes it again and notes the result.
void Streamer::State::run(const StreamTask& task, std::unique_lock<std::mutex>& lock) {
  if (!task.chunk) {
    lock.unlock();
    const std::vector<IVec3> chunks = world.chunks(task.island, task.level);
    lock.lock();
    note_planned(task, chunks);
  } else if (task.far) {
    const auto found = islands.find(task.island);
    const IslandSpec spec = found == islands.end() ? IslandSpec{} : found->second.spec;
    MadeChunk chunk;
    lock.unlock();
    if (spec.id == task.island) far_island(spec, task.level, chunk.mesh);
    lock.lock();
    note_made(task, std::move(chunk));
  } else {
    std::unique_ptr<StreamScratch> scratch;
    if (!spare.empty()) {
      scratch = std::move(spare.back());
      spare.pop_back();
    }
    lock.unlock();
    if (!scratch) scratch = std::make_unique<StreamScratch>();
    MadeChunk chunk;
    const std::span<BlockId> padded = scratch->voxels;
    const bool any = world.generate_padded(task.island, *task.chunk, task.level, padded);
    if (any) mesh_chunk(padded, scratch->mesh, chunk.mesh);
    find_emitters(chunk.mesh, chunk.emitters);
    if (any && makes == StreamOf::kMeshesAndOccupancy) {
      chunk.occupancy = occupancy_of(padded, BlockKind::kOpaque);
      if (has_cutouts(chunk.mesh)) chunk.leaves = occupancy_of(padded, BlockKind::kCutout);
      if (has_stained_glass(chunk.mesh)) chunk.stained = stained_voxels_of(padded);
    }
    if (task.level > 0) close_cutouts(chunk.mesh);
    if (any && makes == StreamOf::kMeshesAndOccupancy) chunk.seams = seam_faces(padded);
    if (task.level == 0) chunk.voxels = any ? chunk_from_padded(padded) : Chunk(kAir);
    lock.lock();
    spare.push_back(std::move(scratch));
    note_made(task, std::move(chunk));
  }
  // The island may have left meanwhile, and this task may have built its plan once more.
  if (plan_unused(task.island)) world.release_plan(task.island);
}

// Islands at level 0 keep their plan for edits; further away there are too many of them.
bool Streamer::State::plan_unused(std::uint64_t id) const {
  const auto found = islands.find(id);
  if (found == islands.end()) return true;
  const auto unused = [](const StreamLevel& level) {
    return level.level > 0 && level.planned && level.unmade == 0;
  };
  const StreamIsland& island = found->second;
  return unused(island.shown) && (!island.coming || unused(*island.coming)) &&
         std::all_of(island.beyond.begin(), island.beyond.end(),
                     [&](const auto& entry) { return unused(entry.second); });
}

void Streamer::State::note_planned(const StreamTask& task, const std::vector<IVec3>& chunks) {
  StreamLevel* level = find_level(task.island, task.serial);
  if (!level) return;
  level->planned = true;
  for (const IVec3& chunk : chunks) remake(task.island, *level, chunk, false);
  for (const IVec3& chunk : std::exchange(level->edited_early, {})) {
    remake(task.island, *level, chunk, false);
  }
}

void Streamer::State::note_made(const StreamTask& task, MadeChunk&& chunk) {
  StreamLevel* level = find_level(task.island, task.serial);
  if (!level) return;
  ++chunks_made;
  if (chunk.voxels) world.keep_chunk(task.island, *task.chunk, std::move(*chunk.voxels));
  StreamSlot& slot = level->slots.at(*task.chunk);
  if (std::exchange(slot.stale, false)) {
    slot.phase = Phase::kQueued;
    queue_chunk(task.island, *level, *task.chunk, true);
    return;
  }
  --level->unmade;
  slot.mesh = std::move(chunk.mesh);
  slot.emitters = std::move(chunk.emitters);
  slot.leaves = std::move(chunk.leaves);
  slot.seams = std::move(chunk.seams);
  slot.stained = std::move(chunk.stained);
  slot.occupancy = std::move(chunk.occupancy);
  const bool nothing_to_say = !slot.has_something() && !slot.resident;
  slot.phase = nothing_to_say ? Phase::kDone : Phase::kMade;
  if (!nothing_to_say) ++level->made;
}

}  // namespace skerry::world
