#include "game/worlds/open_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "engine/core/log.h"
#include "engine/platform/files.h"
#include "game/scene_file/parse.h"
#include "game/session/saved_play.h"
#include "game/worlds/vdb_world.h"
#include "world/islands/march.h"
#include "world/store/world_file.h"

namespace skerry::game {

Result<std::unique_ptr<world::World>> open_world(const SceneOptions& options) {
  std::vector<std::string> damage;
  auto world = open_world(options, damage);
  for (const std::string& line : damage) log_warning(line);
  return world;
}

namespace {

constexpr double kReachOfBlocks = 512.0;  // blocks from a box to the island it is put on

/// The voxel of an island's lattice that a block of the world lies in.
world::IVec3 voxel_of(const std::array<std::int64_t, 3>& block, const world::Pose& pose) {
  constexpr std::int64_t kHalfBlock = world::kUnitsPerBlock / 2;
  const world::WorldPos middle{block[0] * world::kUnitsPerBlock + kHalfBlock,
                               block[1] * world::kUnitsPerBlock + kHalfBlock,
                               block[2] * world::kUnitsPerBlock + kHalfBlock};
  const glm::dvec3 p = glm::inverse(pose.rotation) * world::difference_blocks(middle, pose.origin);
  return {world::floor_to_int(p.x), world::floor_to_int(p.y), world::floor_to_int(p.z)};
}

/// Puts a box on the island that is nearest to its first corner.
Result<void> put(const BlockBox& box, double time_s, world::World& world) {
  const world::WorldPos at{box.from[0] * world::kUnitsPerBlock, box.from[1] * world::kUnitsPerBlock,
                           box.from[2] * world::kUnitsPerBlock};
  const std::vector<world::IslandSpec> near = world.islands_near(at, kReachOfBlocks, time_s);
  if (near.empty())
    return Error{fmt::format("no island is within {} blocks of the scene's block at {}, {}, {}",
                             kReachOfBlocks, box.from[0], box.from[1], box.from[2])};
  const std::uint64_t id = near.front().id;
  const world::Pose pose = *world.pose(id, time_s);
  const world::IVec3 a = voxel_of(box.from, pose), b = voxel_of(box.to, pose);
  // A chunk at a time: each change of one copies all edits that it has.
  std::map<world::IVec3, world::ChunkEdits> edits;
  for (int y = std::min(a.y, b.y); y <= std::max(a.y, b.y); ++y)
    for (int x = std::min(a.x, b.x); x <= std::max(a.x, b.x); ++x)
      for (int z = std::min(a.z, b.z); z <= std::max(a.z, b.z); ++z)
        edits[world::chunk_of({x, y, z})].push_back(
            {static_cast<std::uint32_t>(world::index_in_chunk({x, y, z})), box.block});
  for (const auto& [chunk, of_chunk] : edits) world.set_blocks(id, chunk, of_chunk);
  return {};
}

Result<std::unique_ptr<world::World>> open_source(const SceneOptions& options,
                                                  std::vector<std::string>& damage) {
  if (!options.world) {
    return std::make_unique<world::World>(world::WorldDesc{world::seed_from_text(options.seed_text),
                                                           options.settings.world_offset,
                                                           options.settings.world_islands});
  }
  if (is_vdb(*options.world)) return world_of_vdb(*options.world, options.import);
  auto file = world::WorldFile::open(*options.world, world::WorldFile::Mode::kRead);
  if (!file) return file.error();
  world::LoadedWorld loaded = world::load_world(**file);
  damage = (*file)->damage();
  return std::move(loaded.world);
}

}  // namespace

Result<std::unique_ptr<world::World>> open_world(const SceneOptions& options,
                                                 std::vector<std::string>& damage) {
  Result<std::unique_ptr<world::World>> world = open_source(options, damage);
  if (!world) return world;
  for (const BlockBox& box : options.blocks)
    if (Result<void> done = put(box, options.settings.world_time_s, **world); !done)
      return done.error();
  return world;
}

Result<SceneText> scene_of_world(const std::filesystem::path& path) {
  if (is_vdb(path)) return SceneText();  // it has no player yet
  auto file = world::WorldFile::open(path, world::WorldFile::Mode::kRead);
  if (!file) return file.error();
  SceneText scene;
  const std::optional<SavedPlay> play = saved_play(**file);
  if (!play) return scene;
  scene.camera = format_camera(play->eye);
  scene.time = format_time_of_day(static_cast<int>(play->time_of_day_s));
  scene.settings.push_back(fmt::format("world.time={}", play->world_time_s));
  return scene;
}

std::filesystem::path worlds_dir() {
  const std::filesystem::path data = platform::data_dir();
  return data.empty() ? data : data / "worlds";
}

std::filesystem::path new_world_path(const std::string& name) {
  constexpr std::size_t kLongestName = 64;
  std::string stem;
  for (const char c : name.substr(0, kLongestName)) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (plain || (!stem.empty() && stem.back() != '_')) stem += plain ? c : '_';
  }
  if (stem.empty()) stem = "world";
  const std::filesystem::path dir = worlds_dir();
  std::error_code code;
  for (int count = 1;; ++count) {
    const std::filesystem::path path =
        dir / (count == 1 ? stem + ".skerry" : fmt::format("{}_{}.skerry", stem, count));
    if (!std::filesystem::exists(path, code)) return path;
  }
}

}  // namespace skerry::game
