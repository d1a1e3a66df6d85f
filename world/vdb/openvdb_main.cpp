// The program skerry_openvdb: the only one that runs OpenVDB (worker.h).
//   skerry_openvdb MEMORY_BYTES ANSWER_BYTES CPU_SECONDS read          < a .vdb file > an answer
//   skerry_openvdb MEMORY_BYTES ANSWER_BYTES CPU_SECONDS write FILE    < an answer  > an answer
#include <malloc.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <string_view>

#include "world/vdb/openvdb_jobs.h"

namespace skerry::world {
namespace {

bool write_all(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

// AddressSanitizer's own books are terabytes of address space.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kAddressesAreScarce = false;
#elif defined(__has_feature)
constexpr bool kAddressesAreScarce = !__has_feature(address_sanitizer);
#else
constexpr bool kAddressesAreScarce = true;
#endif

void limit(int what, rlim_t amount, rlim_t more = 0) {
  const rlimit both{amount, amount + more};
  ::setrlimit(static_cast<__rlimit_resource>(what), &both);
}

/// Address space that this process has by now, most of it libraries [bytes].
rlim_t address_space() {
  unsigned long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

struct Arguments {
  std::uint64_t memory_bytes = 0, answer_bytes = 0, cpu_s = 0;
  std::string_view job, path;
};

bool parse(std::string_view text, std::uint64_t& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc();
}

bool parse(std::span<char*> words, Arguments& out) {
  if (words.size() < 5 || words.size() > 6) return false;
  out.job = words[4];
  if (words.size() == 6) out.path = words[5];
  return parse(words[1], out.memory_bytes) && parse(words[2], out.answer_bytes) &&
         parse(words[3], out.cpu_s) && out.job == (out.path.empty() ? "read" : "write");
}

void confine(const Arguments& arguments) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  limit(RLIMIT_CORE, 0);
  // SIGXCPU comes first, so that SIGKILL is left to mean that the system ran out of memory.
  limit(RLIMIT_CPU, arguments.cpu_s, 2);
  if (kAddressesAreScarce) limit(RLIMIT_AS, address_space() + arguments.memory_bytes);
  ::signal(SIGXFSZ, SIG_IGN);  // a full answer is an error that can be reported
  if (arguments.job == "read") limit(RLIMIT_FSIZE, arguments.answer_bytes);
  // Each thread of the allocator's or TBB's own would reserve address space by the gigabyte.
  ::mallopt(M_ARENA_MAX, 1);
}

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
  if (written) begin_answer(0, write_all);
  return written;
}

Result<void> run(const Arguments& arguments) {
  try {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    return arguments.job == "read" ? read_openvdb(STDIN_FILENO, write_all)
                                   : write_job(arguments.path);
  } catch (const std::bad_alloc&) {
    return Error{"it needs more memory than is allowed; it is damaged or too large"};
  } catch (const std::exception& error) {
    return Error{std::string("OpenVDB gave up on it (") + error.what() +
                 "); copy or write it again"};
  }
}

}  // namespace
}  // namespace skerry::world

int main(int count, char** words) {
  using namespace skerry::world;
  Arguments arguments;
  if (!parse({words, static_cast<std::size_t>(count)}, arguments)) return 2;
  confine(arguments);
  const skerry::Result<void> done = run(arguments);
  if (done) return 0;
  // What was written so far is no whole answer; the message takes its place.
  const bool sent = ::ftruncate(STDOUT_FILENO, 0) == 0 &&
                    ::lseek(STDOUT_FILENO, 0, SEEK_SET) == 0 &&
                    encode_error(done.error().message, write_all);
  return sent ? 0 : 1;
}
