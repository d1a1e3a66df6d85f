#include "game/worlds/vdb_world.h"

#include <fmt/format.h>

#include <cstdio>
#include <system_error>
#include <utility>

#include "engine/core/draft.h"
#include "game/scene_file/parse.h"
#include "game/worlds/file_sum.h"
#include "world/islands/stored_voxels.h"
#include "world/store/world_file.h"
#include "world/vdb_import/grid_choice.h"

namespace skerry::game {
namespace {

world::WorldDesc desc_of_imported() {
  world::WorldDesc desc;
  desc.generated = false;
  return desc;
}

Result<void> write(const std::vector<world::ImportedIsland>& islands,
                   const std::filesystem::path& path, const std::string& name) {
  auto file = world::WorldFile::create(path, {name.substr(0, 200), "", desc_of_imported()});
  if (!file) return file.error();
  world::WorldFile::Transaction changes = (*file)->begin();
  for (const world::ImportedIsland& island : islands) {
    changes.put_island({island.spec, true, {}});
    for (const auto& [at, chunk] : island.chunks) changes.put_chunk(island.spec.id, at, chunk);
  }
  return changes.commit();
}

}  // namespace

Result<VdbIslands> islands_of_vdb(const std::filesystem::path& path,
                                  const world::ImportOptions& options,
                                  const world::ReadProgress& progress) {
  constexpr double kReading = 0.2;  // share of the work
  const auto part = [&progress](double from, double share) -> world::ReadProgress {
    if (!progress) return {};
    return [=](double done) { progress(from + share * done); };
  };
  if (options.expect)
    if (const Result<void> sum = check_sum(path, *options.expect); !sum) return sum.error();
  const auto grids = world::read_vdb(path, {}, part(0.0, kReading));
  if (!grids) return grids.error();
  Jobs jobs;
  auto islands = world::import_islands(*grids, options, jobs, part(kReading, 1.0 - kReading));
  if (!islands)
    return Error{
        fmt::format("cannot import {}: {}", quote_text(path.string()), islands.error().message)};
  VdbIslands out{*std::move(islands), {}};
  for (const std::string& line :
       {world::metadata_doubt(*grids), world::choice_line(*grids, options)})
    if (!line.empty()) out.notes.push_back(fmt::format("{}: {}", quote_text(path.string()), line));
  return out;
}

Result<std::unique_ptr<world::World>> world_of_vdb(const std::filesystem::path& path,
                                                   const world::ImportOptions& options) {
  auto imported = islands_of_vdb(path, options);
  if (!imported) return imported.error();
  for (const std::string& note : imported->notes) fmt::print(stderr, "skerry: {}\n", note);
  auto world = std::make_unique<world::World>(desc_of_imported());
  for (world::ImportedIsland& island : imported->islands)
    world->add_island(island.spec,
                      std::make_shared<const world::StoredVoxels>(std::move(island.chunks)));
  return world;
}

Result<void> save_imported(const std::vector<world::ImportedIsland>& islands,
                           const std::filesystem::path& path) {
  std::error_code failed;
  if (std::filesystem::exists(path, failed))
    return Error{fmt::format("cannot write {}: it is there already; give another --out",
                             quote_text(path.string()))};
  // A world whose islands did not all come in must not be taken for a whole one.
  Result<Draft> draft = Draft::create(path);
  Result<void> done = draft ? write(islands, draft->path(), path.stem().string()) : draft.error();
  if (done) done = draft->publish_new();
  if (done) return {};
  return Error{fmt::format("cannot write {}: {}", quote_text(path.string()), done.error().message)};
}

}  // namespace skerry::game
