// Reading all of a world file, around what is damaged.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "world/generate/generate.h"
#include "world/islands/stored_voxels.h"
#include "world/store/rows.h"
#include "world/store/schema.h"
#include "world/store/world_file_state.h"

namespace skerry::world {
namespace {

/// Runs through a table. @return whether some of it may be missing.
template <class Take>
bool scan(Database& database, std::string_view select, Take&& take) {
  int code = SQLITE_OK;
  std::optional<Statement> rows = database.prepare(select, code);
  while (rows && (code = rows->step()) == SQLITE_ROW) take(*rows);
  return code != SQLITE_DONE;
}

ChunkName name_of(const Statement& row) {
  const auto axis = [&](int column) {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(row.integer(column), std::numeric_limits<std::int32_t>::min(),
                                 std::numeric_limits<std::int32_t>::max()));
  };
  return {static_cast<std::uint64_t>(row.integer(0)), {axis(1), axis(2), axis(3)}};
}

/// Chunks further out than this hold no island's voxels: 2^20 blocks from its middle.
bool sound(const ChunkName& name) {
  constexpr std::int32_t kFarthest = (1 << 20) / kChunkEdge;
  const auto in = [](std::int32_t c) { return c >= -kFarthest && c < kFarthest; };
  return in(name.chunk.x) && in(name.chunk.y) && in(name.chunk.z);
}

/// Files from before there were versions are of the first.
bool made_by_this_generator(WorldFile& file) {
  std::uint32_t version = 1;
  if (const auto bytes = file.value("generator"); bytes && bytes->size() == sizeof version)
    std::memcpy(&version, bytes->data(), sizeof version);
  return version == kGeneratorVersion;
}

}  // namespace

void WorldFile::State::put_blob(std::optional<Error>& error, const ChunkName& name,
                                std::span<const std::byte> blob) {
  put(error, "INSERT OR REPLACE INTO chunk(island, x, y, z, data) VALUES(?1, ?2, ?3, ?4, ?5)",
      [&](Statement& statement) {
        bind_name(statement, name);
        statement.bind(5, blob);
      });
}

void WorldFile::State::report(std::string what) {
  if (std::find(damage.begin(), damage.end(), what) == damage.end())
    damage.push_back(std::move(what));
}

WorldFile::Contents WorldFile::read() {
  State& s = *state_;
  if (!s.recovered && is_damage(check_whole(*s.database))) s.recover();
  std::map<std::uint64_t, IslandRow> islands = s.read_islands();
  Contents contents;
  std::map<ChunkName, ChunkEdits> edits;
  std::map<ChunkName, Chunk> chunks;
  const auto take = [&](const Statement& row) {
    const ChunkName name = name_of(row);
    const auto island = islands.find(name.island);
    std::string why = sound(name) ? "" : "it lies too far out";
    if (island == islands.end()) why = "its island is gone";
    if (why.empty() && island->second.added) {
      Result<Chunk> chunk = decode_chunk(name, row.blob(4));
      if (chunk)
        chunks.try_emplace(name, *std::move(chunk));
      else
        why = chunk.error().message;
    } else if (why.empty()) {
      Result<ChunkEdits> decoded = decode_edits(name, row.blob(4));
      if (decoded)
        edits.try_emplace(name, *std::move(decoded));
      else
        why = decoded.error().message;
    }
    if (!why.empty())
      s.report(
          fmt::format("the world {} has lost what was done in chunk {},{},{} of island {:016x}: {}",
                      quoted(s.path), name.chunk.x, name.chunk.y, name.chunk.z, name.island, why));
  };
  if (scan(*s.database, "SELECT island, x, y, z, data FROM chunk", take)) s.lost("some chunks");
  for (auto& [id, row] : islands) contents.islands.push_back(row);
  for (auto& [name, list] : edits)
    contents.edits.push_back({name.island, name.chunk, std::move(list)});
  for (auto& [name, chunk] : chunks)
    contents.chunks.push_back({name.island, name.chunk, std::move(chunk)});
  return contents;
}

void WorldFile::State::lost(std::string_view what) {
  report(fmt::format("the world {} has lost {}: it is damaged", quoted(path), what));
}

/// All islands, from their spares where their rows are damaged, and how they move.
std::map<std::uint64_t, IslandRow> WorldFile::State::read_islands() {
  std::map<std::uint64_t, IslandRow> islands;
  std::set<std::uint64_t> damaged;
  if (scan(*database, "SELECT id, added, spec FROM island", [&](Statement& row) {
        const auto id = static_cast<std::uint64_t>(row.integer(0));
        const bool added = row.integer(1) != 0;
        const auto bytes = unsealed(added ? "added" : "island", id, row.blob(2));
        const std::optional<IslandSpec> spec = bytes ? decode_spec(id, *bytes) : std::nullopt;
        if (spec) islands.try_emplace(id, IslandRow{*spec, added, std::nullopt});
        if (!spec) damaged.insert(id);
      }))
    lost("some islands");
  if (version >= 3)
    scan(*database, "SELECT id, data FROM spare", [&](Statement& row) {
      const auto id = static_cast<std::uint64_t>(row.integer(0));
      const auto bytes = unsealed("spare", id, row.blob(1));
      const std::optional<IslandRow> spare = bytes ? decode_spare(id, *bytes) : std::nullopt;
      if (!spare || !islands.try_emplace(id, *spare).second) return;
      damaged.erase(id);
      report(fmt::format("the world {} is damaged: island {:016x} was read from a second copy",
                         quoted(path), id));
    });
  for (const std::uint64_t id : damaged) lost(fmt::format("island {:016x}", id));
  if (version >= 2 && scan(*database, "SELECT island, data FROM motion", [&](Statement& row) {
        const auto id = static_cast<std::uint64_t>(row.integer(0));
        const auto bytes = unsealed("motion", id, row.blob(1));
        const std::optional<MotionState> motion = bytes ? decode_motion(*bytes) : std::nullopt;
        if (!motion) lost(fmt::format("the place of island {:016x}", id));
        if (const auto island = islands.find(id); island != islands.end())
          island->second.motion = motion;
      }))
    lost("some islands' places");
  return islands;
}

LoadedWorld load_world(WorldFile& file) {
  WorldFile::Contents contents = file.read();
  LoadedWorld loaded;
  loaded.world = std::make_unique<World>(file.info().desc);
  World& world = *loaded.world;
  if (file.info().desc.generated && !made_by_this_generator(file))
    file.note_damage(
        fmt::format("the world {} was made by another version of Skerry's generator: what was "
                    "built may hang in "
                    "the air or lie in rock",
                    quoted(file.path())));
  std::map<std::uint64_t, std::map<IVec3, Chunk>> voxels;
  for (WorldFile::Contents::Whole& whole : contents.chunks)
    voxels[whole.island].emplace(whole.chunk, std::move(whole.voxels));
  for (const IslandRow& row : contents.islands) {
    const std::uint64_t id = row.spec.id;
    if (row.added) {
      const auto stored = std::make_shared<const StoredVoxels>(std::move(voxels[id]));
      if (stored->stored().empty()) continue;  // all of it was dug away, or reported as lost
      world.add_island(fitted(row.spec, *stored), stored);
    } else if (!world.meet(id, row.spec.origin)) {
      file.note_damage(
          fmt::format("the world {} names island {:016x}, which its seed does not make",
                      quoted(file.path()), id));
      continue;
    }
    if (!row.motion) continue;
    world.move_island(id, row.motion->tick, row.motion->pose);
    loaded.moving.push_back({id, *row.motion});
  }
  for (const WorldFile::Contents::Edits& edits : contents.edits)
    world.set_blocks(edits.island, edits.chunk, edits.edits);
  world.take_edits();  // no client has the world yet
  return loaded;
}

}  // namespace skerry::world
