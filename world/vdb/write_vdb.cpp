#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <string>

#include "engine/core/draft.h"
#include "world/vdb/answer.h"
#include "world/vdb/export.h"
#include "world/vdb/worker.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr ReadLimits kWriteLimits{std::uint64_t{4} << 30, 0, 600, 1200.0};
// A file of our own may hold as much as was put into it.
constexpr ReadLimits kVerifyLimits{std::uint64_t{4} << 30, std::uint64_t{2} << 30, 600, 1200.0};

Result<void> write(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path) {
  if (!has_openvdb()) return no_openvdb();
  Result<MemoryFile> question = MemoryFile::create(), answer = MemoryFile::create();
  if (!question) return question.error();
  if (!answer) return answer.error();
  const ByteSink sink = [&](std::span<const std::byte> bytes) { return question->append(bytes); };
  bool kept = begin_answer(static_cast<std::uint32_t>(grids.size()), sink);
  for (const VolumeGrid& grid : grids) kept = kept && encode_grid(grid, sink);
  if (!kept) return Error{"there is not enough memory; export less"};
  const Result<void> ran = run_confined(kOpenVdb, {"write", path.string()}, question->descriptor(),
                                        answer->descriptor(), 0, kWriteLimits, {});
  if (!ran) return ran.error();
  const Result<std::span<const std::byte>> bytes = answer->seal();
  if (!bytes) return bytes.error();
  const Result<std::vector<VolumeGrid>> decoded = decode_answer(*bytes);
  if (!decoded) return decoded.error();
  return {};
}

bool equal(const VolumeGrid& a, const VolumeGrid& b) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (std::abs(a.world_from_index[column][row] - b.world_from_index[column][row]) > 1e-9)
        return false;
  // Active voxels first: they bound what hashing of tiles may take.
  return a.name == b.name && a.kind == b.kind && a.active_voxels == b.active_voxels &&
         content_hash(a) == content_hash(b);
}

/// OpenVDB does not notice a disk that fills up.
Result<void> verify(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path) {
  const Result<std::vector<VolumeGrid>> back = read_vdb(path, kVerifyLimits);
  bool same = back && back->size() == grids.size();
  for (std::size_t i = 0; same && i < grids.size(); ++i) same = equal((*back)[i], grids[i]);
  if (!same) return Error{"what was written cannot be read back; check the space on the disk"};
  return {};
}

}  // namespace

std::uint64_t content_hash(const VolumeGrid& grid) {
  const auto at = [](IVec3 p, std::uint32_t bits) {
    return mix64(mix64(std::uint64_t{hash3(bits, p.x, p.y, p.z)} << 32 | bits) ^
                 hash3(~bits, p.z, p.x, p.y));
  };
  // Sums, for the order does not count.
  std::uint64_t sum = 0;
  for (const VolumeTile& tile : grid.tiles) {
    const auto bits = std::bit_cast<std::uint32_t>(tile.value);
    for (std::int32_t x = 0; x < tile.edge; x += kBrickEdge)
      for (std::int32_t y = 0; y < tile.edge; y += kBrickEdge)
        for (std::int32_t z = 0; z < tile.edge; z += kBrickEdge)
          sum += at({tile.origin.x + x, tile.origin.y + y, tile.origin.z + z}, bits);
  }
  for (const VolumeBrick& brick : grid.bricks) {
    std::uint64_t values = 0;
    for (const float value : brick.values)
      values = mix64(values ^ std::bit_cast<std::uint32_t>(value));
    sum += mix64(values ^ at(brick.origin, 0));
  }
  return sum;
}

Result<void> write_vdb(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path) {
  Result<Draft> draft = Draft::create(path);
  Result<void> done = draft ? write(grids, draft->path()) : draft.error();
  if (done) done = verify(grids, draft->path());
  if (done) done = draft->publish();
  if (done) return {};
  return Error{fmt::format("cannot write {}: {}", quoted_path(path), done.error().message)};
}

}  // namespace skerry::world
