#include "game/worlds/world_list.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>

#include "world/store/world_file.h"

namespace skerry::game {
namespace {

namespace fs = std::filesystem;
using world::WorldFile;

constexpr std::size_t kMostWorlds = 1000;  // looked at; a folder may hold anything
constexpr const char* kEnding = ".skerry";
// SQLite's companions, which hold what was written last.
constexpr const char* kCompanions[] = {"-wal", "-shm", "-journal", ".png"};

fs::path beside(const fs::path& path, const char* ending) {
  return fs::path(path) += ending;
}

/// Why a world cannot be played, without the path, which the list has no room for.
std::string reason_of(const Error& error) {
  const std::size_t at = error.message.find("': ");
  std::string reason = at == std::string::npos ? error.message : error.message.substr(at + 3);
  if (!reason.empty())
    reason[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(reason[0])));
  return reason;
}

WorldEntry entry_of(const fs::path& path) {
  WorldEntry entry;
  entry.path = path;
  entry.name = path.stem().string();
  for (const fs::path& file : {path, beside(path, "-wal")}) {
    struct ::stat seen {};
    if (::stat(file.c_str(), &seen) != 0) continue;
    entry.played_s = std::max<std::int64_t>(entry.played_s, seen.st_mtime);
    entry.bytes += static_cast<std::uint64_t>(seen.st_size);
  }
  const auto file = WorldFile::open(path, WorldFile::Mode::kRead);
  if (!file) {
    entry.problem = reason_of(file.error());
    return entry;
  }
  if (const std::string& name = (*file)->info().name; !name.empty()) entry.name = name;
  entry.seed_text = (*file)->info().seed_text;
  return entry;
}

}  // namespace

std::vector<WorldEntry> list_worlds(const fs::path& folder) {
  std::vector<WorldEntry> worlds;
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    if (worlds.size() == kMostWorlds) break;
    std::error_code of_file;
    if (at->path().extension() == kEnding && at->is_regular_file(of_file))
      worlds.push_back(entry_of(at->path()));
  }
  std::sort(worlds.begin(), worlds.end(), [](const WorldEntry& a, const WorldEntry& b) {
    return std::pair(-a.played_s, a.path) < std::pair(-b.played_s, b.path);
  });
  return worlds;
}

Result<void> remove_world(const fs::path& path) {
  // One that another process writes is not taken from under it; one that cannot be read may go.
  if (const auto free = WorldFile::check_free(path); !free) return free.error();
  std::error_code code;
  if (!fs::remove(path, code))
    return Error{fmt::format("cannot delete the world '{}': {}; check the folder's permissions",
                             path.string(), code ? code.message() : "it is not there")};
  for (const char* companion : kCompanions) fs::remove(beside(path, companion), code);
  return {};
}

fs::path picture_of_world(const fs::path& path) {
  return beside(path, ".png");
}

}  // namespace skerry::game
