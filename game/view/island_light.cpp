#include "game/view/island_light.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <span>
#include <utility>

#include "engine/core/clock.h"
#include "game/view/materials.h"

namespace skerry::game {

namespace {

/// Has a thread do a part of a look, and counts what it computes.
template <class Fn>
void submit(WorkerThreads& threads, std::shared_ptr<std::atomic<double>> work, Fn part) {
  threads.submit([work = std::move(work), part = std::move(part)] {
    const double begin = thread_seconds();
    part();
    work->fetch_add(thread_seconds() - begin);
  });
}

}  // namespace

/// One look at an island. Made by the frame thread, worked on in the background, read when `done`.
struct IslandLight::Search {
  world::LightChunks chunks;
  std::shared_ptr<std::atomic<double>> work;
  std::uint64_t version = 0;
  bool sky = false;
  std::span<const world::FaceAlbedo> albedo;      // empty: bounces are not looked for
  std::shared_ptr<const Reaches> reaches_before;  // none: of no chunks
  std::shared_ptr<const Reaches> reaches;
  std::atomic<bool> reach_done = false;
  bool reach_taken = false;
  std::unique_ptr<world::SkyTransfer> transfer;  // of an earlier look, to be brought up to date
  bool keep = false;                             // for the next one
  world::KeyDirections keys{};
  std::optional<std::size_t> rekeyed;                 // slot that the earlier look had otherwise
  Seams seams;                                        // of the island as the look begins
  Skies known;                                        // alike
  std::map<world::IVec3, Closed> closings;            // alike; then of what is found
  std::atomic<int> parts_left = world::kOctants + 1;  // octants, and lamps; then of a step
  Skies found;  // with `seams` closed; what is as `known` has it is the same object
  world::LightCache* cache = nullptr;
  Skies to_cache;  // what the transfer has found; none if it came from the cache
  std::atomic<bool> done = false;
};

namespace {

/// With guesses for the faces that close the chunk, where they are not dark.
world::ChunkSky closed(const world::ChunkSky& before, std::span<const shared::Quad> seams) {
  return world::with_faces(before, world::lit_faces(before, seams));
}

/// Of a look at the sky.
world::LightCache::Kind kind_of(std::span<const world::FaceAlbedo> albedo) {
  return albedo.empty() ? world::LightCache::Kind::kSky : world::LightCache::Kind::kBounces;
}

template <class Map>
typename Map::mapped_type at_or_none(const Map& map, world::IVec3 at) {
  const auto found = map.find(at);
  return found == map.end() ? nullptr : found->second;
}

// Nearest islands of which enough is kept for edits. A giant takes some 100 MB.
constexpr std::size_t kKept = 2;
constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();
constexpr int kSpare = 16;        // blocks about an island that has outgrown what is kept of it
constexpr int kCallsToWait = 64;  // start() with nothing new, before it asks who is near
// Calls of poll() in which a thread may begin a guess: where frames keep all processors busy, none
// may for long.
constexpr int kCallsForGuess = 8;
constexpr int kGuessesACall = 1;  // that poll() makes itself: up to half a millisecond
}  // namespace

IslandLight::IslandLight(WorkerThreads& threads, Finds finds, world::LightCache* cache)
    : threads_(threads), finds_(finds), cache_(cache) {}

void IslandLight::add(const world::SectionKey& key, world::LightChunk chunk) {
  Island& island = islands_[key.row()];
  island.chunks[key.chunk] = std::make_shared<const world::LightChunk>(std::move(chunk));
  ++island.version;
  island.guess(key.chunk);
}

void IslandLight::close(const world::SectionKey& key, std::vector<shared::Quad> seams) {
  Island& island = islands_[key.row()];
  if (seams.empty()) {  // what is known of faces that are not drawn does no harm
    island.seams.erase(key.chunk);
    return;
  }
  const auto& closing = island.seams[key.chunk] =
      std::make_shared<const std::vector<shared::Quad>>(std::move(seams));
  auto guess = std::make_shared<Guess>();
  if (const auto pending = at_or_none(island.guesses, key.chunk)) {
    guess->chunk = pending->chunk;
    guess->base = pending->base;
  } else {
    guess->base = at_or_none(island.known, key.chunk);
  }
  guess->seams = closing;
  if (guess->base) ask_guess(island, key.chunk, std::move(guess));
}

world::ChunkSky IslandLight::Guess::made() const {
  if (!chunk) return closed(*base, *seams);
  world::ChunkSky out = world::inherit_faces(*base, chunk->quads);
  return seams ? closed(out, *seams) : out;
}

/// In place of one that is on its way.
void IslandLight::ask_guess(Island& island, world::IVec3 at, std::shared_ptr<Guess> guess) {
  island.guesses[at] = guess;
  threads_.submit_first([guess = std::move(guess), work = work_] {
    if (!guess->take()) return;
    const double begin = thread_seconds();
    guess->sky = std::make_shared<const world::ChunkSky>(guess->made());
    work->fetch_add(thread_seconds() - begin);
    guess->done = true;
  });
}

/// An edit's, which is seen in the same frame.
void IslandLight::Island::guess(world::IVec3 at) {
  Guess now;
  const auto pending = at_or_none(guesses, at);
  now.base = pending ? pending->base : at_or_none(known, at);
  if (!now.base) return;
  now.chunk = chunks.at(at);
  now.seams = at_or_none(seams, at);
  guesses.erase(at);
  known[at] = std::make_shared<const world::ChunkSky>(now.made());
  guessed.insert(at);
}

void IslandLight::remove(const world::SectionKey& key) {
  const auto found = islands_.find(key.row());
  if (found == islands_.end()) return;
  found->second.seams.erase(key.chunk);
  if (found->second.chunks.erase(key.chunk) == 0) return;
  ++found->second.version;
}

template <class T>
void IslandLight::discard(T unused) {
  threads_.submit([held = std::make_shared<T>(std::move(unused))] {});
}

void IslandLight::end_island(const world::IslandLevel& row) {
  if (auto island = islands_.extract(row)) discard(std::move(island.mapped()));
}

void IslandLight::run(WorkerThreads& threads, std::shared_ptr<Search> search) {
  submit(threads, search->work, [search] {
    static const Reaches kNone;
    const Reaches& before = search->reaches_before ? *search->reaches_before : kNone;
    search->reaches = std::make_shared<const Reaches>(
        Reaches{search->chunks, world::reaches_after(search->chunks, before.of, before.found)});
    search->reach_done = true;
  });
  if (search->sky)
    look_at_sky(threads, search);
  else
    search->done = true;
}

void IslandLight::run_or_take(WorkerThreads& threads, std::shared_ptr<Search> search) {
  submit(threads, search->work, [&threads, search] {
    const auto light = search->cache->find(search->chunks, kind_of(search->albedo), search->keys);
    if (!light) return run(threads, search);
    search->reaches = std::make_shared<const Reaches>(Reaches{search->chunks, light->reaches});
    search->reach_done = true;
    end_look(*search, light->skies);
  });
}

// Octants are looked along in jobs of their own, so that one large island keeps all workers busy.
void IslandLight::look_at_sky(WorkerThreads& threads, std::shared_ptr<Search> search) {
  submit(threads, search->work, [&threads, search] {
    const bool edited = search->transfer != nullptr;
    if (edited && search->transfer->edit(search->chunks)) {
      if (!search->rekeyed || !search->transfer->has_bounces())
        return end_look(*search, search->transfer->faces());
      search->transfer->set_key(*search->rekeyed, *search->keys[*search->rekeyed]);
      return follow_key(threads, search, 0);
    }
    search->transfer = std::make_unique<world::SkyTransfer>(search->chunks, search->albedo,
                                                            world::BounceLight::kBounces,
                                                            edited ? kSpare : 0, search->keys);
    for (int part = 0; part <= world::kOctants; ++part)
      submit(threads, search->work, [&threads, search, part] {
        if (part < world::kOctants)
          search->transfer->look(part);
        else
          search->transfer->spread_lamps();
        if (search->parts_left.fetch_sub(1) == 1) follow_bounces(threads, search, 0);
      });
  });
}

// A step needs all of the step before it.
void IslandLight::follow_bounces(WorkerThreads& threads, std::shared_ptr<Search> search, int step) {
  if (!search->transfer->has_bounces() || step == world::BounceLight::kSteps) {
    const Skies& skies = search->transfer->make_faces();
    if (search->cache) search->to_cache = skies;
    return end_look(*search, skies);
  }
  search->parts_left = world::BounceLight::kParts;
  for (int part = 0; part < world::BounceLight::kParts; ++part)
    submit(threads, search->work, [&threads, search, step, part] {
      search->transfer->follow_bounces(step, part);
      if (search->parts_left.fetch_sub(1) == 1) follow_bounces(threads, search, step + 1);
    });
}

void IslandLight::follow_key(WorkerThreads& threads, std::shared_ptr<Search> search, int step) {
  if (step == search->transfer->bounce_steps())
    return end_look(*search, search->transfer->take_key(*search->rekeyed));
  search->parts_left = world::BounceLight::kParts;
  for (int part = 0; part < world::BounceLight::kParts; ++part)
    submit(threads, search->work, [&threads, search, step, part] {
      search->transfer->follow_key(*search->rekeyed, step, part);
      if (search->parts_left.fetch_sub(1) == 1) follow_key(threads, search, step + 1);
    });
}

void IslandLight::end_look(Search& search, Skies skies) {
  search.found = std::move(skies);
  const std::map<world::IVec3, Closed> closed_before = std::exchange(search.closings, {});
  for (auto& [at, sky] : search.found) {
    if (const auto seams = at_or_none(search.seams, at)) {
      const auto before = closed_before.find(at);
      const bool same = before != closed_before.end() && before->second.found == sky &&
                        before->second.seams == seams;
      Closed& now = search.closings[at];
      now = same
                ? before->second
                : Closed{sky, std::make_shared<const world::ChunkSky>(closed(*sky, *seams)), seams};
      sky = now.sky;
    }
    const auto before = at_or_none(search.known, at);
    if (before && (before == sky || *before == *sky)) sky = before;
  }
  if (!search.keep) {
    search.transfer.reset();
    search.closings.clear();  // the next look finds other objects
  }
  search.done = true;
}

struct IslandLight::Rank {
  double distance = 0.0;
  world::IslandLevel row;
  Island* island = nullptr;
  bool keyed = false;  // see Near
  std::optional<Key> key{};
  std::size_t place = kNowhere;  // among islands in full detail, of which alone enough can be kept
  bool is_near() const { return place < kKept; }
  /// Whether to follow light from where it has not been followed yet.
  bool rekeys() const {
    return is_near() && key &&
           std::ranges::find(island->keys, key->direction) == island->keys.end();
  }
};

/// Islands, the nearest first; those without a distance last.
std::vector<IslandLight::Rank> IslandLight::by_distance(const NearIslands& islands) {
  std::vector<Rank> out;
  for (auto& [row, island] : islands_) {
    const auto found = islands.find(row);
    if (found == islands.end())
      out.push_back({std::numeric_limits<double>::infinity(), row, &island});
    else
      out.push_back({found->second.distance, row, &island, found->second.keyed, found->second.key});
  }
  std::ranges::sort(out, {}, [](const Rank& rank) { return std::pair(rank.distance, rank.row); });
  std::size_t place = 0;
  for (Rank& rank : out)
    if (rank.row.level == 0) rank.place = place++;
  return out;
}

/// @param now see start(); else an edit is not to wait for a key.
void IslandLight::begin(const Rank& rank, bool now) {
  Island& island = *rank.island;
  island.search = std::make_shared<Search>();
  if (!rank.keyed) island.keys = {};
  const bool edited = island.kept && island.asked != island.version;
  if (rank.rekeys() && (!edited || now)) {
    if (cache_) island.keys = {};  // all is found anew, whatever has been asked for before
    const std::size_t slot = cache_ ? 0 : rank.key->slot;
    island.search->rekeyed = slot;
    island.keys[slot] = rank.key->direction;
  }
  island.search->keys = island.keys;
  island.search->chunks = island.chunks;
  island.search->work = work_;
  island.search->version = island.asked = island.version;
  island.search->sky = finds_ != Finds::kReach;
  island.search->keep = rank.is_near() && !cache_ && island.search->sky;
  island.search->transfer = std::move(island.kept);
  island.search->reaches_before = island.reaches;
  island.search->seams = island.seams;
  island.search->known = island.known;
  island.search->closings = std::move(island.closings);
  if (finds_ == Finds::kBounces) island.search->albedo = albedo_table();
  if (island.search->sky) island.search->cache = cache_;
  if (island.search->cache)
    run_or_take(threads_, island.search);
  else
    run(threads_, island.search);
}

void IslandLight::start(const world::Streamer& streamer,
                        const std::function<NearIslands()>& islands, bool now) {
  const bool is_new = std::ranges::any_of(islands_, [](const auto& one) {
    return !one.second.search && one.second.asked != one.second.version;
  });
  if (!is_new && !now && ++calls_with_nothing_new_ < kCallsToWait) return;
  calls_with_nothing_new_ = 0;
  const std::vector<Rank> ranks = by_distance(islands());
  bool busy = false;
  for (const Rank& rank : ranks) {
    Island& island = *rank.island;
    if (rank.place > kKept && island.kept) discard(std::move(island.kept));
    busy |= island.search || island.asked != island.version;
    const bool rekeys = rank.rekeys() && (island.kept || now);
    if (island.search || (island.asked == island.version && !rekeys) ||
        !streamer.settled(rank.row.island))
      continue;
    begin(rank, now);
  }
  // When there is nothing else to do, the nearest one is looked at once more for edits to come, and
  // others for what they are asked to have.
  if (busy || cache_ || finds_ == Finds::kReach) return;
  for (const Rank& rank : ranks) {
    const Island& island = *rank.island;
    if (!rank.is_near() || (rank.place != 0 && !rank.rekeys())) continue;
    if (island.search || island.kept || !streamer.settled(rank.row.island)) continue;
    return begin(rank, now);
  }
}

bool IslandLight::settled() const {
  return std::ranges::all_of(islands_, [](const auto& one) {
    return !one.second.search && one.second.asked == one.second.version &&
           one.second.guesses.empty();
  });
}

bool IslandLight::searching() const {
  return std::ranges::any_of(islands_,
                             [](const auto& one) { return one.second.search != nullptr; });
}

bool IslandLight::guesses() const {
  return std::ranges::any_of(islands_, [](const auto& one) { return !one.second.guesses.empty(); });
}

/// @param most that may be made here; then what is left of them.
void IslandLight::take_guesses(Island& island, int& most) {
  for (auto entry = island.guesses.begin(); entry != island.guesses.end();) {
    Guess& guess = *entry->second;
    if (++guess.calls > kCallsForGuess && most > 0 && guess.take()) {
      guess.sky = std::make_shared<const world::ChunkSky>(guess.made());
      guess.done = true;
      --most;
    }
    if (!guess.done) {
      ++entry;
      continue;
    }
    island.known[entry->first] = guess.sky;
    island.guessed.insert(entry->first);
    entry = island.guesses.erase(entry);
  }
}

IslandLight::Found IslandLight::guessed_of(const world::IslandLevel& row, Island& island) {
  Found found{row, {}, island.said_keys};
  for (const auto& [at, sky] : island.known)
    found.chunks.push_back({at, sky, island.guessed.contains(at)});
  island.guessed.clear();
  return found;
}

std::vector<IslandLight::FoundReach> IslandLight::poll_reach() {
  std::vector<FoundReach> out;
  for (auto& [row, island] : islands_) {
    if (!island.search || !island.search->reach_done || island.search->reach_taken) continue;
    island.search->reach_taken = true;
    island.reaches = island.search->reaches;
    if (island.search->version != island.version) continue;
    for (const auto& [at, reaches] : island.search->reaches->found) {
      FoundReach& found = out.emplace_back(FoundReach{{row.island, at, row.level}, {}});
      for (const world::LampReach::Found& reach : reaches) found.reach.push_back(reach.lit);
    }
  }
  return out;
}

/// What a look has found, but of chunks that have changed since or are closed otherwise: these keep
/// what was known of them until there is a guess.
IslandLight::Found IslandLight::found_of(const world::IslandLevel& row, Island& island,
                                         Search& search) {
  Found found{row, {}, search.keys};
  Skies skies;
  island.guesses.clear();
  for (auto& [at, sky] : search.found) {
    const auto now = at_or_none(island.chunks, at);
    const auto closing = at_or_none(island.seams, at);
    const auto known = at_or_none(island.known, at);
    const bool edited = now && now != search.chunks[at];
    // It keeps what was known from the keys before; another look follows.
    if (edited) found.keys = island.said_keys;
    if (edited || (closing && closing != at_or_none(search.seams, at))) {
      auto guess = std::make_shared<Guess>();
      if (edited) guess->chunk = now;
      guess->base = sky;
      guess->seams = closing;
      ask_guess(island, at, std::move(guess));
      if (known) sky = known;
    }
    const bool same = !island.guessed.contains(at) && known == sky;
    skies[at] = sky;
    found.chunks.push_back({at, std::move(sky), !same});
  }
  island.said_keys = found.keys;
  island.guessed.clear();
  discard(std::exchange(island.known, std::move(skies)));
  island.closings = std::move(search.closings);
  return found;
}

std::vector<IslandLight::Found> IslandLight::poll() {
  std::vector<Found> out;
  int most_guesses = kGuessesACall;
  for (auto& [row, island] : islands_) {
    take_guesses(island, most_guesses);
    if (!island.search || !island.search->done || !island.search->reach_taken) {
      if (!island.guessed.empty()) out.push_back(guessed_of(row, island));
      continue;
    }
    std::shared_ptr<Search> search = std::exchange(island.search, nullptr);
    if (search->keep) island.kept = std::move(search->transfer);
    if (!search->to_cache.empty())
      cache_->keep(search->chunks, kind_of(search->albedo), search->keys,
                   {search->reaches->found, std::move(search->to_cache)});
    if (finds_ != Finds::kReach) out.push_back(found_of(row, island, *search));
    discard(std::move(search));
  }
  return out;
}

}  // namespace skerry::game
