#include "world/confined/jail.h"

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <vector>

namespace skerry::world {
namespace {

#ifdef __has_feature
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

#if defined(__x86_64__)
constexpr unsigned kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr unsigned kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr unsigned kMachine = 0;
#endif

// Reads and writes what is open, takes memory, runs threads, ends.
constexpr long kAllowed[] = {
    __NR_read,
    __NR_write,
    __NR_writev,
    __NR_lseek,
    __NR_ftruncate,
    __NR_mmap,
    __NR_munmap,
    __NR_mremap,
    __NR_mprotect,
    __NR_madvise,
    __NR_brk,
    __NR_futex,
    __NR_sched_yield,
    __NR_sched_getaffinity,
    __NR_gettid,
    __NR_getpid,
    __NR_clock_gettime,
    __NR_clock_nanosleep,
    __NR_nanosleep,
    __NR_getrandom,
    __NR_rt_sigaction,
    __NR_rt_sigprocmask,
    __NR_rt_sigreturn,
    __NR_sigaltstack,
    __NR_restart_syscall,
    __NR_exit,
    __NR_exit_group,
    __NR_set_robust_list,
    __NR_rseq,
};

// What only a process that was taken over would try.
constexpr long kDeadly[] = {__NR_openat, __NR_openat2, __NR_socket, __NR_execve, __NR_execveat,
#ifdef __NR_open
                            __NR_open,   __NR_creat,
#endif
                            __NR_ptrace};

constexpr auto kNumber = static_cast<unsigned>(offsetof(seccomp_data, nr));
constexpr auto kArch = static_cast<unsigned>(offsetof(seccomp_data, arch));

void answer(std::vector<sock_filter>& program, unsigned action) {
  program.push_back(BPF_STMT(BPF_RET | BPF_K, action));
}

void answer_if(std::vector<sock_filter>& program, long value, unsigned action) {
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(value), 0, 1));
  answer(program, action);
}

std::vector<sock_filter> filter() {
  std::vector<sock_filter> program;
  // Numbers of another machine's calls (32-bit ones, say) mean other things.
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kArch));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0));
  answer(program, SECCOMP_RET_KILL_PROCESS);
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kNumber));
  for (const long number : kAllowed) answer_if(program, number, SECCOMP_RET_ALLOW);
  // Threads, and no processes. Flags of clone3 are out of a filter's sight: it fails, and libraries
  // fall back to clone.
  const auto flags = static_cast<unsigned>(offsetof(seccomp_data, args[0]));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_clone, 0, 4));
  program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, flags));
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 0, 1));
  answer(program, SECCOMP_RET_ALLOW);
  answer(program, SECCOMP_RET_ERRNO | EPERM);
  for (const long number : kDeadly) answer_if(program, number, SECCOMP_RET_KILL_PROCESS);
  answer(program, SECCOMP_RET_ERRNO | ENOSYS);
  return program;
}

}  // namespace

bool enter_jail() {
  if (kMachine == 0 || kSanitized) return false;
  std::vector<sock_filter> program = filter();
  const sock_fprog loaded{static_cast<unsigned short>(program.size()), program.data()};
  // Threads that libraries have started come along.
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::syscall(__NR_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &loaded) == 0;
}

}  // namespace skerry::world
