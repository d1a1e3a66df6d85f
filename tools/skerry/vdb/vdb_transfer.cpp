#include "tools/skerry/vdb/vdb_transfer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/core/clock.h"
#include "engine/core/log.h"
#include "game/scene_file/parse.h"
#include "game/worlds/open_world.h"
#include "game/worlds/vdb_world.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"
#include "world/store/world_file.h"

namespace skerry::tools {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

struct Times {
  double import_s = 0.0, write_s = 0.0, bytes_per_s = 0.0;
};

void print_text(const std::vector<world::ImportedIsland>& islands, const Times& times) {
  for (const world::ImportedIsland& island : islands) {
    const world::IslandSpec& spec = island.spec;
    fmt::print("{}: {} blocks in {} chunks, {} x {} x {}, around {},{},{}",
               island.grid.empty() ? "(no name)" : island.grid, island.blocks, island.chunks.size(),
               spec.box_max.x - spec.box_min.x, spec.box_max.y - spec.box_min.y,
               spec.box_max.z - spec.box_min.z, game::format_blocks(spec.origin.x),
               game::format_blocks(spec.origin.y), game::format_blocks(spec.origin.z));
    if (island.error_blocks > 0.0)
      fmt::print(", resampled: its surface is off by at most {:.2f} blocks", island.error_blocks);
    if (island.unknown_ids > 0)
      fmt::print(", {} blocks of unknown ids became stone", island.unknown_ids);
    fmt::print("\n");
  }
  fmt::print("read and imported in {:.2f} s ({:.1f} MB/s), written in {:.2f} s\n", times.import_s,
             times.bytes_per_s * 1e-6, times.write_s);
}

void print_json(const std::vector<world::ImportedIsland>& islands, const Times& times) {
  const auto array = [](auto v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const world::ImportedIsland& island : islands) {
    const glm::dvec3 origin = world::difference_blocks(island.spec.origin, {});
    rows.push_back({{"grid", island.grid},
                    {"blocks", island.blocks},
                    {"chunks", island.chunks.size()},
                    {"threshold", island.threshold},
                    {"error_blocks", island.error_blocks},
                    {"unknown_ids", island.unknown_ids},
                    {"origin", array(origin)},
                    {"yaw_deg", island.spec.yaw_rad * kDegrees},
                    {"box_min", array(island.spec.box_min)},
                    {"box_max", array(island.spec.box_max)}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"islands", rows},
                                            {"import_s", times.import_s},
                                            {"write_s", times.write_s},
                                            {"bytes_per_s", times.bytes_per_s}}
                         .dump(2));
}

/// Every block that can be; islands that no seed made are all within.
world::BlockBox whole_world() {
  constexpr std::int64_t kFar = world::kMaxBlock;
  return {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
}

Result<bool> grows_from_a_seed(const VdbExportOptions& options) {
  if (!options.world) return true;
  if (game::is_vdb(*options.world)) return false;
  const auto file = world::WorldFile::open(*options.world, world::WorldFile::Mode::kRead);
  if (!file) return file.error();
  return (*file)->info().desc.generated;
}

}  // namespace

int vdb_import(const VdbImportOptions& options) {
  ProgressBar bar;
  const Stopwatch importing;
  const auto imported = game::islands_of_vdb(
      options.file, options.how, [&bar](double share) { bar.show(share, "importing"); });
  bar.clear();
  if (!imported) return fail(kFailed, imported.error());
  for (const std::string& note : imported->notes) fmt::print(stderr, "skerry: {}\n", note);
  const std::vector<world::ImportedIsland>& islands = imported->islands;
  Times times;
  times.import_s = importing.seconds();
  const auto bytes = static_cast<double>(std::filesystem::file_size(options.file));
  times.bytes_per_s = bytes / times.import_s;
  const Stopwatch writing;
  if (const Result<void> saved = game::save_imported(islands, options.out); !saved)
    return fail(kFailed, saved.error());
  times.write_s = writing.seconds();
  options.json ? print_json(islands, times) : print_text(islands, times);
  return kDone;
}

int vdb_export(const VdbExportOptions& options) {
  if (!options.box) {
    const Result<bool> endless = grows_from_a_seed(options);
    if (!endless) return fail(kFailed, endless.error());
    if (*endless) return fail(kUsage, {"a seed's world has no end: give --box X0,Y0,Z0,X1,Y1,Z1"});
  }
  game::SceneOptions scene;
  scene.seed_text = options.seed_text;
  scene.world = options.world;
  std::vector<std::string> damage;
  auto world = game::open_world(scene, damage);
  if (!world) return fail(kFailed, world.error());
  if (!damage.empty() && !options.partial)
    return fail(kFailed, {"cannot export all of it: " + damage.front() +
                          "; give --partial to export the rest"});
  for (const std::string& line : damage) log_warning(line);
  ProgressBar bar;
  const Stopwatch watch;
  const auto grids = world::volumes_of(**world, options.box.value_or(whole_world()),
                                       [&bar](double share) { bar.show(share, "collecting"); });
  bar.clear();
  if (!grids) return fail(kFailed, {"cannot export: " + grids.error().message});
  const double collected_s = watch.seconds();
  bar.show(1.0, "writing");
  const Result<void> written = world::write_vdb(*grids, options.out);
  bar.clear();
  if (!written) return fail(kFailed, written.error());
  for (const world::VolumeGrid& grid : *grids)
    fmt::print("{}: {} voxels, {} bricks, {} tiles\n", grid.name, grid.active_voxels,
               grid.bricks.size(), grid.tiles.size());
  std::error_code stream;  // which has no size
  const std::uintmax_t bytes = std::filesystem::file_size(options.out, stream);
  fmt::print("collected in {:.2f} s, written and read back in {:.2f} s{}\n", collected_s,
             watch.seconds() - collected_s, stream ? "" : fmt::format(", {} bytes", bytes));
  return kDone;
}

}  // namespace skerry::tools
