#include <fmt/format.h>
#include <unistd.h>

#include <string>
#include <system_error>

#include "world/vdb/answer.h"
#include "world/vdb/export.h"
#include "world/vdb/worker.h"

namespace skerry::world {
namespace {

constexpr ReadLimits kWriteLimits{std::uint64_t{16} << 30, 0, 600, 1200.0};
// A file of our own may hold as much as was put into it.
constexpr ReadLimits kVerifyLimits{std::uint64_t{16} << 30, std::uint64_t{8} << 30, 600, 1200.0};

Result<void> write(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path) {
  Result<MemoryFile> question = MemoryFile::create(), answer = MemoryFile::create();
  if (!question) return question.error();
  if (!answer) return answer.error();
  const ByteSink sink = [&](std::span<const std::byte> bytes) { return question->append(bytes); };
  bool kept = begin_answer(static_cast<std::uint32_t>(grids.size()), sink);
  for (const VolumeGrid& grid : grids) kept = kept && encode_grid(grid, sink);
  if (!kept) return Error{"there is not enough memory; export less"};
  const Result<void> ran = run_worker({"write", path.string()}, question->descriptor(),
                                      answer->descriptor(), 0, kWriteLimits, {});
  if (!ran) return ran.error();
  const Result<std::span<const std::byte>> bytes = answer->seal();
  if (!bytes) return bytes.error();
  const Result<std::vector<VolumeGrid>> told = decode_answer(*bytes);
  if (!told) return told.error();
  return {};
}

/// OpenVDB does not notice a disk that fills up.
Result<void> verify(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path) {
  const Result<std::vector<VolumeGrid>> back = read_vdb(path, kVerifyLimits);
  bool same = back && back->size() == grids.size();
  for (std::size_t i = 0; same && i < grids.size(); ++i)
    same = (*back)[i].name == grids[i].name && (*back)[i].active_voxels == grids[i].active_voxels;
  if (!same) return Error{"what was written cannot be read back; check the space on the disk"};
  return {};
}

}  // namespace

Result<void> write_vdb(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path) {
  const std::filesystem::path draft = fmt::format("{}.{}.part", path.string(), ::getpid());
  Result<void> done = write(grids, draft);
  if (done) done = verify(grids, draft);
  std::error_code failed;
  if (done) std::filesystem::rename(draft, path, failed);
  if (failed) done = Error{failed.message() + "; check the path"};
  if (done) return {};
  std::filesystem::remove(draft, failed);
  return Error{fmt::format("cannot write '{}': {}", path.string(), done.error().message)};
}

}  // namespace skerry::world
