// What WorldFile keeps. Private to world/store.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "world/store/chunk_blob.h"
#include "world/store/database.h"
#include "world/store/world_file.h"

namespace skerry::world {

struct WorldFile::State {
  std::filesystem::path path;
  Mode mode = Mode::kRead;
  WorldInfo info;
  int version = 0;                 // of the tables
  std::optional<WriterLock> lock;  // outlives the database
  std::optional<Database> database;
  std::map<std::string_view, Statement> statements;  // by text, which is a literal
  bool in_transaction = false;
  std::vector<std::string> damage;
  bool recovered = false;  // or tried to

  int open_database(bool& newer);
  bool find_info();
  bool recover();
  std::optional<std::vector<std::byte>> value(std::string_view name);

  /// Runs a statement unless something failed before; what fails is kept.
  template <class Bind>
  void put(std::optional<Error>& error, std::string_view sql, Bind&& bind) {
    if (error) return;
    int code = SQLITE_OK;
    auto found = statements.find(sql);
    if (found == statements.end()) {
      std::optional<Statement> made = database->prepare(sql, code);
      if (made) found = statements.emplace(sql, std::move(*made)).first;
    }
    if (code == SQLITE_OK) {
      bind(found->second);
      code = found->second.step();
    }
    if (code != SQLITE_DONE) error = file_error("save", path, code);
  }
  void put_blob(std::optional<Error>& error, const ChunkName& name,
                std::span<const std::byte> blob);

  std::map<std::uint64_t, IslandRow> read_islands();
  void lost(std::string_view what);
  /// Notes damage, once.
  void report(std::string what);
};

}  // namespace skerry::world
