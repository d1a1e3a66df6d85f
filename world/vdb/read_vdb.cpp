#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "world/vdb/answer.h"
#include "world/vdb/volume_grid.h"
#include "world/vdb/worker.h"

namespace skerry::world {
namespace {

Result<std::vector<VolumeGrid>> read(const std::filesystem::path& path, const ReadLimits& limits,
                                     const ReadProgress& progress) {
  if (!has_openvdb()) return no_openvdb();
  Result<MemoryFile> answer = read_confined(
      kOpenVdb, path, [&](std::uint64_t bytes) { return limits_for(bytes, limits); }, progress);
  if (!answer) return answer.error();
  const Result<std::span<const std::byte>> bytes = answer->seal();
  if (!bytes) return bytes.error();
  return decode_answer(*bytes);
}

}  // namespace

Error no_openvdb() {
  return Error{"this build has no OpenVDB; configure with -DSKERRY_OPENVDB=ON"};
}

std::string metadata_doubt(const std::vector<VolumeGrid>& grids) {
  constexpr double kAllowedShare = 1.0 / 32.0, kOfEmptyTrees = 4096.0;
  const VolumeGrid* first = nullptr;
  std::size_t count = 0;
  for (const VolumeGrid& grid : grids) {
    const auto stated = static_cast<double>(grid.stated_memory_bytes);
    const double off = std::abs(static_cast<double>(grid.memory_bytes) - stated);
    if (grid.stated_memory_bytes == 0 || off <= kAllowedShare * stated + kOfEmptyTrees) continue;
    if (count++ == 0) first = &grid;
  }
  if (!first) return {};
  return fmt::format(
      "grid '{}'{} may be damaged: it states {} bytes of memory and takes {}; "
      "compare the file with its source",
      first->name, count > 1 ? fmt::format(" and {} more", count - 1) : "",
      first->stated_memory_bytes, first->memory_bytes);
}

ReadLimits limits_for(std::uint64_t file_bytes, const ReadLimits& most) {
  constexpr std::uint64_t kMiB = 1 << 20;
  constexpr std::uint64_t kMemoryPerByte = 256, kAnswerPerByte = 128, kBytesPerSecond = kMiB / 2;
  const std::uint64_t bytes = std::min(file_bytes, std::uint64_t{1} << 40);  // no overflow below
  ReadLimits out = most;
  out.memory_bytes = std::min(most.memory_bytes, 128 * kMiB + kMemoryPerByte * bytes);
  out.answer_bytes = std::min(most.answer_bytes, 16 * kMiB + kAnswerPerByte * bytes);
  out.cpu_s = static_cast<int>(
      std::min(static_cast<std::uint64_t>(most.cpu_s), 4 + bytes / kBytesPerSecond));
  return out;
}

Result<std::vector<VolumeGrid>> read_vdb(const std::filesystem::path& path,
                                         const ReadLimits& limits, const ReadProgress& progress) {
  Result<std::vector<VolumeGrid>> grids = read(path, limits, progress);
  if (grids) return grids;
  return Error{fmt::format("cannot read the volumes of '{}': {}", printable(path.string()),
                           grids.error().message)};
}

Result<std::vector<VolumeGrid>> read_volumes(const std::filesystem::path& path,
                                             const ReadLimits& limits,
                                             const ReadProgress& progress) {
  Result<std::vector<VolumeGrid>> grids = read_vdb(path, limits, progress);
  if (!grids) return grids;
  std::erase_if(*grids, [](const VolumeGrid& grid) {
    return grid.kind == VolumeKind::kOther || grid.kind == VolumeKind::kColor;
  });
  if (grids->empty()) {
    return Error{
        fmt::format("cannot read the volumes of '{}': no grid in it holds a number a "
                    "voxel; see skerry vdb info",
                    printable(path.string()))};
  }
  return grids;
}

}  // namespace skerry::world
