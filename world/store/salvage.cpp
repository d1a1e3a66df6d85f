#include "world/store/salvage.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "world/store/chunk_blob.h"
#include "world/store/pages.h"
#include "world/store/rows.h"
#include "world/store/schema.h"

namespace skerry::world {
namespace {

using Kind = Field::Kind;
using Blob = std::vector<std::byte>;

/// Rows of one table. Two that differ under one key: the page of one has lost its last version, and
/// the row has moved since. What a later commit wrote counts. Of one age, one was there before the
/// other, and nothing decides which: none is left.
template <class Key>
class Found {
 public:
  void add(const Key& key, std::span<const std::byte> bytes, std::uint64_t age) {
    const auto [at, is_new] = rows_.try_emplace(key);
    Row& row = at->second;
    if (is_new || age > row.age) {
      row = {Blob(bytes.begin(), bytes.end()), age};
    } else if (age == row.age && row.bytes && !std::ranges::equal(*row.bytes, bytes)) {
      row.bytes.reset();
    }
  }
  /// Calls with each row that is beyond doubt. @return how many are not.
  template <class Take>
  std::size_t each(Take&& take) const {
    std::size_t doubts = 0;
    for (const auto& [key, row] : rows_) {
      if (row.bytes) take(key, *row.bytes);
      doubts += !row.bytes;
    }
    return doubts;
  }

 private:
  struct Row {
    std::optional<Blob> bytes;
    std::uint64_t age = 0;
  };
  std::map<Key, Row> rows_;
};

/// Everything found, by table. Islands by whether they were added, too.
struct Rows {
  Found<std::string> values;
  Found<std::pair<std::int64_t, bool>> islands;
  Found<std::int64_t> motions, spares;
  Found<ChunkName> chunks;
  std::uint64_t age = 0;  ///< of the current page

  void take(std::int64_t rowid, std::span<const Field> row);

 private:
  void take_of_table(std::int64_t rowid, std::span<const Field> row);
};

bool is(std::span<const Field> row, std::initializer_list<Kind> kinds) {
  return std::ranges::equal(row, kinds, {}, &Field::kind);
}

std::optional<std::int32_t> axis(const Field& field) {
  if (field.integer < std::numeric_limits<std::int32_t>::min() ||
      field.integer > std::numeric_limits<std::int32_t>::max())
    return std::nullopt;
  return static_cast<std::int32_t>(field.integer);
}

void Rows::take(std::int64_t rowid, std::span<const Field> row) {
  constexpr Kind kInt = Kind::kInteger;
  if (!is(row, {kInt, kInt, kInt, kInt, Kind::kBlob})) return take_of_table(rowid, row);
  const auto x = axis(row[1]), y = axis(row[2]), z = axis(row[3]);
  if (!x || !y || !z) return;
  const ChunkName name{static_cast<std::uint64_t>(row[0].integer), {*x, *y, *z}};
  if (decode_edits(name, row[4].bytes) || decode_chunk(name, row[4].bytes))
    chunks.add(name, row[4].bytes, age);
}

void Rows::take_of_table(std::int64_t rowid, std::span<const Field> row) {
  const auto id = static_cast<std::uint64_t>(rowid);
  if (is(row, {Kind::kText, Kind::kBlob})) {
    const std::string name(reinterpret_cast<const char*>(row[0].bytes.data()), row[0].bytes.size());
    if (unsealed("value", name_key(name), row[1].bytes)) values.add(name, row[1].bytes, age);
  } else if (is(row, {Kind::kNull, Kind::kInteger, Kind::kBlob})) {
    const bool added = row[1].integer != 0;
    if (unsealed(added ? "added" : "island", id, row[2].bytes))
      islands.add({rowid, added}, row[2].bytes, age);
  } else if (is(row, {Kind::kNull, Kind::kBlob})) {
    if (unsealed("motion", id, row[1].bytes)) motions.add(rowid, row[1].bytes, age);
    if (unsealed("spare", id, row[1].bytes)) spares.add(rowid, row[1].bytes, age);
  }
}

/// One statement for all rows of a table. @return false: it failed.
class Filler {
 public:
  Filler(Database& into, std::string_view sql) : insert_(into.prepare(sql, code_)) {}
  template <class Bind>
  void put(Bind&& bind) {
    if (!insert_) return;
    bind(*insert_);
    if (insert_->step() != SQLITE_DONE) insert_.reset();
  }
  bool done() const { return insert_.has_value(); }

 private:
  int code_ = SQLITE_OK;
  std::optional<Statement> insert_;
};

}  // namespace

bool salvage(const std::filesystem::path& path, Database& into, std::vector<std::string>& doubts) {
  Rows rows;
  PageFile file(path);
  for (std::uint32_t page = 1; page <= file.count(); ++page) {
    rows.age = file.age(page);
    file.rows_of(page,
                 [&](std::int64_t rowid, std::span<const Field> row) { rows.take(rowid, row); });
  }
  if (into.run("BEGIN IMMEDIATE") != SQLITE_OK) return false;
  Filler values(into, "INSERT INTO value(name, data) VALUES(?1, ?2)");
  Filler islands(into, "INSERT OR REPLACE INTO island(id, added, spec) VALUES(?1, ?2, ?3)");
  Filler motions(into, "INSERT INTO motion(island, data) VALUES(?1, ?2)");
  Filler spares(into, "INSERT INTO spare(id, data) VALUES(?1, ?2)");
  Filler chunks(into, "INSERT INTO chunk(island, x, y, z, data) VALUES(?1, ?2, ?3, ?4, ?5)");
  std::size_t unclear = 0;
  bool has_info = false;
  const auto note_info = [&](std::optional<std::span<const std::byte>> bytes) {
    has_info = has_info || (bytes && decode_info(*bytes));
  };
  const auto by_id = [](Filler& filler) {
    return [&filler](std::int64_t id, const Blob& bytes) {
      filler.put([&](Statement& row) { row.bind(1, id).bind(2, std::span(bytes)); });
    };
  };
  unclear += rows.values.each([&](const std::string& name, const Blob& bytes) {
    if (name == "info") note_info(unsealed("value", name_key(name), bytes));
    values.put([&](Statement& row) { row.bind(1, name).bind(2, std::span(bytes)); });
  });
  unclear += rows.islands.each([&](const std::pair<std::int64_t, bool>& key, const Blob& bytes) {
    islands.put([&](Statement& row) {
      row.bind(1, key.first).bind(2, std::int64_t{key.second}).bind(3, std::span(bytes));
    });
  });
  unclear += rows.motions.each(by_id(motions));
  unclear += rows.spares.each([&](std::int64_t id, const Blob& bytes) {
    const std::uint64_t info = name_key("info");
    if (static_cast<std::uint64_t>(id) == info) note_info(unsealed("spare", info, bytes));
    by_id(spares)(id, bytes);
  });
  unclear += rows.chunks.each([&](const ChunkName& name, const Blob& bytes) {
    chunks.put([&](Statement& row) {
      bind_name(row, name);
      row.bind(5, std::span(bytes));
    });
  });
  if (unclear != 0)
    doubts.push_back(fmt::format("the world {} holds {} things twice, and not alike: left out",
                                 quoted(path), unclear));
  bool done = true;
  for (const Filler* filler : {&values, &islands, &motions, &spares, &chunks})
    done = done && filler->done();
  return into.run("COMMIT") == SQLITE_OK && done && has_info;
}

}  // namespace skerry::world
