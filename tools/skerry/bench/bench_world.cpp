#include "tools/skerry/bench/bench_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "engine/core/clock.h"
#include "engine/core/draft.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"
#include "world/islands/stored_voxels.h"
#include "world/motion/motion.h"
#include "world/motion/split.h"
#include "world/store/world_file.h"
#include "world/voxel/hash.h"

namespace skerry::tools {
namespace {

using namespace world;
using Rows = nlohmann::ordered_json;

constexpr int kWorldRounds = 9;

void add_row(Rows& rows, const char* name, const std::vector<double>& ms,
             const std::map<std::string, std::uint64_t>& counts) {
  const Spread spread = spread_of(ms);
  Rows row{
      {"name", name}, {"ms_median", spread.median}, {"ms_p10", spread.p10}, {"ms_p90", spread.p90}};
  std::string said;
  for (const auto& [what, count] : counts) {
    row[what] = count;
    said += fmt::format("  {} {}", count, what);
  }
  fmt::print("{:<28} {:>9.3f} ms ({:.3f} .. {:.3f}){}\n", name, spread.median, spread.p10,
             spread.p90, said);
  rows.push_back(row);
}

/// 10,000 edits as a player makes them: shafts and walls about places of the home island.
std::map<IVec3, ChunkEdits> walk_edits(std::size_t count) {
  Rng rng(1);
  std::set<IVec3> voxels;
  IVec3 at{0, 0, 0};
  while (voxels.size() < count) {
    if (rng.in(0, 199) == 0) at = {rng.in(-80, 80), rng.in(-20, 20), rng.in(-80, 80)};
    (rng.in(0, 2) == 0 ? at.x : rng.in(0, 1) == 0 ? at.y : at.z) += rng.in(0, 1) == 0 ? 1 : -1;
    voxels.insert(at);
  }
  std::map<IVec3, ChunkEdits> edits;
  for (const IVec3& v : voxels)
    edits[chunk_of(v)].push_back({static_cast<std::uint32_t>(index_in_chunk(v)),
                                  rng.in(0, 2) == 0 ? BlockId{block::kPlanks} : kAir});
  for (auto& [chunk, list] : edits)
    std::sort(list.begin(), list.end(),
              [](const VoxelEdit& a, const VoxelEdit& b) { return a.index < b.index; });
  return edits;
}

Result<void> bench_saving(Rows& rows) {
  std::error_code missing;
  const auto folder = std::filesystem::temp_directory_path(missing) / "skerry_bench";
  const Result<Draft> scratch = Draft::create(folder, Draft::What::kFolder);  // gone at the end
  if (!scratch) return Error{"cannot make a folder for worlds: " + scratch.error().message};
  constexpr std::size_t kEdits = 10'000;
  const std::map<IVec3, ChunkEdits> edits = walk_edits(kEdits);
  WorldInfo info{"bench", "1", {}};
  info.desc.seed = 1;
  World world(info.desc);
  const IslandSpec home = world.islands_near({}, 300.0, 0.0).front();
  std::vector<double> save_ms, open_ms;
  std::uint64_t bytes = 0;
  for (int round = 0; round < kWorldRounds; ++round) {
    const std::filesystem::path path = scratch->folder() / fmt::format("{}.skerry", round);
    Result<std::unique_ptr<WorldFile>> file = WorldFile::create(path, info);
    if (!file) return file.error();
    Stopwatch watch;
    WorldFile::Transaction transaction = (*file)->begin();
    transaction.put_island({home});
    for (const auto& [chunk, list] : edits) transaction.put_edits(home.id, chunk, list);
    if (Result<void> done = transaction.commit(); !done) return done;
    save_ms.push_back(watch.milliseconds());
    *file = nullptr;
    bytes = std::filesystem::file_size(path);
    watch.restart();
    file = WorldFile::open(path, WorldFile::Mode::kWrite);
    if (!file) return file.error();
    const LoadedWorld loaded = load_world(**file);
    open_ms.push_back(watch.milliseconds());
  }
  add_row(rows, "save 10,000 edits", save_ms, {{"bytes", bytes}, {"chunks", edits.size()}});
  add_row(rows, "open that world", open_ms, {{"bytes", bytes}});
  return {};
}

std::uint64_t add_made(World& world, WorldPos origin, IVec3 low, IVec3 high,
                       const std::function<bool(IVec3)>& wanted) {
  std::map<IVec3, std::vector<BlockId>> blocks;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z)
        if (wanted({x, y, z}))
          blocks.try_emplace(chunk_of({x, y, z}), kChunkVoxels, kAir)
              .first->second[index_in_chunk({x, y, z})] = block::kStone;
  std::map<IVec3, Chunk> chunks;
  for (const auto& [at, list] : blocks) chunks.emplace(at, Chunk::from_voxels(list));
  const auto stored = std::make_shared<const StoredVoxels>(std::move(chunks));
  IslandSpec spec;
  spec.id = world.unused_id();
  spec.origin = origin;
  world.add_island(fitted(spec, *stored), stored);
  return spec.id;
}

/// Two halves of half a million blocks and one block between them, which is taken: the worst there
/// is, since neither half is smaller.
void bench_split(Rows& rows) {
  WorldDesc desc;
  desc.generated = false;
  std::vector<double> look_ms, find_ms, whole_ms, move_ms;
  std::uint64_t blocks = 0, bricks = 0;
  for (int round = 0; round < kWorldRounds; ++round) {
    World world(desc);
    const std::uint64_t id = add_made(world, {}, {-64, -32, -62}, {64, 32, 62},
                                      [](IVec3 v) { return v.z != 0 || (v.x == 0 && v.y == 0); });
    Stopwatch watch;
    SolidGrid grid = SolidGrid::of_island(world, id);
    grid.complete();
    look_ms.push_back(watch.milliseconds());
    // A block whose neighbours hang together round about it.
    const IVec3 surface{-64, 31, -62}, neck{0, 0, 0};
    grid.set(surface, false);
    watch.restart();
    find_fragments(grid, {&surface, 1});
    whole_ms.push_back(watch.milliseconds());
    grid.set(neck, false);
    world.set_block(id, neck, kAir);
    watch.restart();
    const SplitSearch search = find_fragments(grid, {&neck, 1});
    find_ms.push_back(watch.milliseconds());
    watch.restart();
    const BrokenOff off = break_off(world, id, *copy_piece(world, id, search.fragments.front()),
                                    *world.pose(id, 0.0));
    move_ms.push_back(watch.milliseconds());
    blocks = off.mass.blocks;
    bricks = search.bricks_looked_at;
  }
  add_row(rows, "look at 10^6 blocks, once", look_ms, {});
  add_row(rows, "cut that breaks nothing", whole_ms, {});
  add_row(rows, "find a split of 10^6 blocks", find_ms, {{"bricks", bricks}});
  add_row(rows, "move half of them out", move_ms, {{"blocks", blocks}});
}

/// 1,024 islands of some 500 blocks that fly about in a room where they collide all the time.
void bench_motion(Rows& rows) {
  WorldDesc desc;
  desc.generated = false;
  World world(desc);
  IslandMotion motion(world);
  motion.start(0.0);
  constexpr int kAcross = 32;
  constexpr double kApart = 16.0;
  Rng rng(7);
  for (int i = 0; i < kAcross * kAcross; ++i) {
    MotionState state;
    const auto real = [&](double most) { return rng.in(-1000, 1000) * most / 1000.0; };
    state.pose.origin = moved({}, {kApart * (i % kAcross), real(2.0), kApart * (i / kAcross)});
    state.velocity = {real(6.0), 0.0, real(6.0)};
    state.spin = real(0.5);
    const std::uint64_t id =
        add_made(world, state.pose.origin, {-5, -5, -5}, {5, 5, 5},
                 [](IVec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z <= 25; });
    motion.add(id, state);
  }
  std::vector<double> ms;
  std::uint64_t near = 0, touching = 0;
  for (int tick = 0; tick < 5 * kMotionTicksPerSecond; ++tick) {
    const Stopwatch watch;
    motion.step();
    ms.push_back(watch.milliseconds());
    near = std::max<std::uint64_t>(near, motion.counts().near);
    touching = std::max<std::uint64_t>(touching, motion.counts().touching);
  }
  add_row(rows, "tick with 1,024 islands", ms,
          {{"awake at the end", motion.counts().awake}, {"near", near}, {"touching", touching}});
}

}  // namespace

int bench_world(const BenchWorldOptions& options) {
  Rows rows = Rows::array();
  if (const Result<void> done = bench_saving(rows); !done) return fail(kFailed, done.error());
  bench_split(rows);
  bench_motion(rows);
  if (Result<void> written = write_rows(options.json, rows); !written)
    return fail(kFailed, written.error());
  return kDone;
}

}  // namespace skerry::tools
