#include "world/store/world_file.h"

#include <fmt/format.h>

#include <utility>

#include "engine/core/check.h"
#include "world/store/chunk_blob.h"
#include "world/store/rows.h"
#include "world/store/schema.h"
#include "world/store/world_file_state.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;

}  // namespace

bool WorldInfo::operator==(const WorldInfo& o) const {
  return name == o.name && seed_text == o.seed_text && desc.seed == o.desc.seed &&
         desc.offset_blocks == o.desc.offset_blocks && desc.island_limit == o.desc.island_limit &&
         desc.generated == o.desc.generated;
}

WorldFile::WorldFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
WorldFile::~WorldFile() = default;
const fs::path& WorldFile::path() const {
  return state_->path;
}
const WorldInfo& WorldFile::info() const {
  return state_->info;
}
WorldFile::Mode WorldFile::mode() const {
  return state_->mode;
}
const std::vector<std::string>& WorldFile::damage() const {
  return state_->damage;
}

void WorldFile::note_damage(std::string line) {
  state_->report(std::move(line));
}

std::optional<std::vector<std::byte>> WorldFile::value(std::string_view name) {
  return state_->value(name);
}

std::optional<std::vector<std::byte>> WorldFile::State::value(std::string_view name) {
  // Through all rows, which are few: an index that is damaged may deny that there is such a name.
  int code = SQLITE_OK;
  std::optional<Statement> select =
      database->prepare("SELECT name, data FROM value NOT INDEXED", code);
  bool lost = false;
  while (select && (code = select->step()) == SQLITE_ROW) {
    const auto bytes = unsealed("value", name_key(select->text(0)), select->blob(1));
    if (bytes && select->text(0) == name)
      return std::vector<std::byte>(bytes->begin(), bytes->end());
    lost = lost || !bytes;
  }
  select.reset();
  if (is_damage(code) && recover()) return value(name);
  if (auto spare = version >= 3 ? read_spare(*database, name_key(name)) : std::nullopt) {
    report(fmt::format("the world {} is damaged: its '{}' was read from a second copy",
                       quoted(path), name));
    return spare;
  }
  if (lost || code != SQLITE_DONE)
    report(fmt::format("the world {} has lost one of its values, perhaps its '{}': it is damaged",
                       quoted(path), name));
  return std::nullopt;
}

WorldFile::Transaction WorldFile::begin() {
  SKERRY_ASSERT(state_->mode == Mode::kWrite && !state_->in_transaction);
  return Transaction(*this);
}

WorldFile::Transaction::Transaction(WorldFile& file) : file_(&file) {
  State& s = *file.state_;
  s.in_transaction = true;
  if (const int code = s.database->run("BEGIN IMMEDIATE"); code != SQLITE_OK)
    error_ = file_error("save", s.path, code);
}

WorldFile::Transaction::Transaction(Transaction&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), error_(std::move(other.error_)) {}

WorldFile::Transaction::~Transaction() {
  if (!file_) return;
  file_->state_->database->run("ROLLBACK");
  file_->state_->in_transaction = false;
}

void WorldFile::Transaction::put_island(const IslandRow& island) {
  State& s = *file_->state_;
  const auto id = static_cast<std::int64_t>(island.spec.id);
  s.put(error_, "INSERT OR REPLACE INTO island(id, added, spec) VALUES(?1, ?2, ?3)",
        [&](Statement& statement) {
          statement.bind(1, id).bind(2, std::int64_t{island.added});
          statement.bind(3, sealed(island.added ? "added" : "island", island.spec.id,
                                   encode_spec(island.spec)));
        });
  s.put(error_, "INSERT OR REPLACE INTO spare(id, data) VALUES(?1, ?2)", [&](Statement& statement) {
    statement.bind(1, id).bind(2, sealed("spare", island.spec.id, encode_spare(island)));
  });
  if (!island.motion) return;
  s.put(error_, "INSERT OR REPLACE INTO motion(island, data) VALUES(?1, ?2)",
        [&](Statement& statement) {
          statement.bind(1, id).bind(
              2, sealed("motion", island.spec.id, encode_motion(*island.motion)));
        });
}

void WorldFile::Transaction::put_new_island(const IslandRow& island) {
  for (const std::string_view sql :
       {"DELETE FROM chunk WHERE island = ?1", "DELETE FROM motion WHERE island = ?1"})
    file_->state_->put(error_, sql, [&](Statement& statement) {
      statement.bind(1, static_cast<std::int64_t>(island.spec.id));
    });
  put_island(island);
}

void WorldFile::Transaction::put_edits(std::uint64_t island, IVec3 chunk,
                                       std::span<const VoxelEdit> edits) {
  if (!edits.empty())
    return file_->state_->put_blob(error_, {island, chunk}, encode_edits({island, chunk}, edits));
  file_->state_->put(error_, "DELETE FROM chunk WHERE island = ?1 AND x = ?2 AND y = ?3 AND z = ?4",
                     [&](Statement& statement) {
                       bind_name(statement, {island, chunk});
                     });
}

void WorldFile::Transaction::put_chunk(std::uint64_t island, IVec3 chunk, const Chunk& voxels) {
  file_->state_->put_blob(error_, {island, chunk}, encode_chunk({island, chunk}, voxels));
}

void WorldFile::Transaction::put_value(std::string_view name, std::span<const std::byte> bytes) {
  SKERRY_ASSERT(bytes.size() <= kMaxValueBytes);
  if (error_) return;
  State& s = *file_->state_;
  if (const int code = write_value(*s.database, name, bytes); code != SQLITE_OK)
    error_ = file_error("save", s.path, code);
}

Result<void> WorldFile::Transaction::commit() {
  State& s = *file_->state_;
  if (!error_) {
    int code = s.database->run("COMMIT");
    const bool committed = code == SQLITE_OK;
    if (committed) code = settle(*s.database);
    if (code != SQLITE_OK) error_ = file_error("save", s.path, code);
    if (committed) return end();
  }
  s.database->run("ROLLBACK");
  return end();
}

/// @return the first error of all.
Result<void> WorldFile::Transaction::end() {
  std::exchange(file_, nullptr)->state_->in_transaction = false;
  return error_ ? Result<void>(*error_) : Result<void>();
}

}  // namespace skerry::world
