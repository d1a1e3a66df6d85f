#include "world/confined/child.h"

#include <malloc.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <fstream>
#include <system_error>

namespace skerry::world {
namespace {

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

bool parse(std::string_view text, std::uint64_t& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc();
}

}  // namespace

std::optional<ConfinedJob> parse_job(std::span<char*> words) {
  if (words.size() < 5 || words.size() > 6) return std::nullopt;
  ConfinedJob job;
  if (words.size() == 6) job.path = words[5];
  if (!parse(words[1], job.memory_bytes) || !parse(words[2], job.answer_bytes) ||
      !parse(words[3], job.cpu_s) || words[4] != std::string_view(job.writes() ? "write" : "read"))
    return std::nullopt;
  return job;
}

void confine(const ConfinedJob& job) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  limit(RLIMIT_CORE, 0);
  // SIGXCPU comes first, so that SIGKILL is left to mean that the system ran out of memory.
  limit(RLIMIT_CPU, job.cpu_s, 2);
  if (kAddressesAreScarce) limit(RLIMIT_AS, address_space() + job.memory_bytes);
  ::signal(SIGXFSZ, SIG_IGN);  // a full answer is an error that can be reported
  if (!job.writes()) limit(RLIMIT_FSIZE, job.answer_bytes);
  // Each thread of the allocator's own would reserve address space by the gigabyte.
  ::mallopt(M_ARENA_MAX, 1);
}

bool write_to_output(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

bool empty_output() {
  return ::ftruncate(STDOUT_FILENO, 0) == 0 && ::lseek(STDOUT_FILENO, 0, SEEK_SET) == 0;
}

}  // namespace skerry::world
