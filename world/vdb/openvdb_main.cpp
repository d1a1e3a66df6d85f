// The program skerry_openvdb: the only one that runs OpenVDB (worker.h).
//   skerry_openvdb MEMORY_BYTES ANSWER_BYTES CPU_SECONDS read          < a .vdb file > an answer
//   skerry_openvdb MEMORY_BYTES ANSWER_BYTES CPU_SECONDS write FILE    < an answer  > an answer
#include <sys/mman.h>
#include <sys/stat.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <optional>
#include <string_view>

#include "world/confined/child.h"
#include "world/vdb/openvdb_jobs.h"

namespace skerry::world {
namespace {

Result<void> write_job(std::string_view path) {
  struct stat state {};
  if (::fstat(STDIN_FILENO, &state) != 0) return Error{"there is nothing to write"};
  const auto size = static_cast<std::size_t>(state.st_size);
  const void* bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
  if (bytes == MAP_FAILED) return Error{"there is no memory for it"};
  const Result<std::vector<VolumeGrid>> grids =
      decode_answer({static_cast<const std::byte*>(bytes), size});
  if (!grids) return grids.error();
  const Result<void> written = write_openvdb(*grids, path);
  if (written) begin_answer(0, write_to_output);
  return written;
}

Result<void> run(const ConfinedJob& job) {
  return guarded("OpenVDB", [&] {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    return job.writes() ? write_job(job.path) : read_openvdb(STDIN_FILENO, write_to_output);
  });
}

}  // namespace
}  // namespace skerry::world

int main(int count, char** words) {
  using namespace skerry::world;
  const std::optional<ConfinedJob> job = parse_job({words, static_cast<std::size_t>(count)});
  if (!job) return 2;
  confine(*job);
  const skerry::Result<void> done = run(*job);
  if (done) return 0;
  // What was written so far is no whole answer; the message takes its place.
  const bool sent = empty_output() && encode_error(done.error().message, write_to_output);
  return sent ? 0 : 1;
}
