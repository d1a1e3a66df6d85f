#include "engine/core/interruption.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "engine/core/log.h"

namespace skerry {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

// The handler's, and so lock-free: a child process has the handler, too, but not the thread.
std::atomic<pid_t> owner{0};
std::atomic<int> signal_pipe{-1};
std::atomic<bool> listening{false};

constexpr std::chrono::seconds kMostWork{2};

struct Registry {
  std::mutex mutex;
  std::multiset<std::filesystem::path> paths;
  std::mutex works_mutex;                              // never taken while the other is held
  std::map<const void*, std::function<bool()>> works;  // by who wants it
};

/// Never destroyed: the thread may outlive main().
Registry& registry() {
  static Registry* const one = new Registry;
  return *one;
}

void end_by(int signal_number) {
  ::signal(signal_number, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal_number);
  ::pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  ::raise(signal_number);
  ::_exit(128 + signal_number);  // the first process of a container outlives its own signals
}

void on_signal(int signal_number) {
  const int before = errno;
  const auto byte = static_cast<unsigned char>(signal_number);
  if (::getpid() != owner || ::write(signal_pipe, &byte, 1) != 1) ::raise(signal_number);
  errno = before;
}

void remove_all_of(const std::filesystem::path& path) {
  // Others may still put files into a folder that is being emptied.
  std::error_code code;
  for (int attempt = 0; attempt < 100 && std::filesystem::exists(path, code); ++attempt)
    std::filesystem::remove_all(path, code);
}

/// @return whether all that was to be done before the end is done.
bool do_works() {
  const auto done = std::make_shared<std::promise<bool>>();
  std::future<bool> result = done->get_future();
  std::thread([done] {
    // Never unlocked: work in progress must not be dropped.
    registry().works_mutex.lock();
    bool all = true;
    for (const auto& [owner_of_work, work] : registry().works) all = work() && all;
    done->set_value(all);
  }).detach();
  if (result.wait_for(kMostWork) == std::future_status::ready) return result.get();
  log_error(fmt::format("ended without saving: it took more than {} s; look at the disk",
                        kMostWork.count()));
  return false;
}

void wait_for_signal(int descriptor) {
  listening = true;
  listening.notify_one();
  unsigned char byte = 0;
  while (::read(descriptor, &byte, 1) < 0 && errno == EINTR) {
  }
  const bool done = do_works();
  // Never unlocked: no thread may use what is removed now.
  registry().mutex.lock();
  for (const std::filesystem::path& path : registry().paths) remove_all_of(path);
  if (!done) ::_exit(1);
  end_by(byte);
}

/// Once in each process. @pre the registry is locked.
void listen() {
  if (owner == ::getpid()) return;
  // A child process must not remove what its parent makes.
  registry().paths.clear();
  registry().works.clear();

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;  // then only an interruption leaves something behind
  signal_pipe = ends[1];
  owner = ::getpid();
  listening = false;
  std::thread(wait_for_signal, ends[0]).detach();
  // A thread that begins holds locks, as of a sanitizer's allocator: a process forked meanwhile
  // would wait for them forever.
  listening.wait(false);
  for (const int signal_number : kSignals) {
    struct sigaction before {};
    ::sigaction(signal_number, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;  // nohup
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    ::sigaction(signal_number, &action, nullptr);
  }
}

}  // namespace

void uninterrupted(const std::function<void()>& work) {
  const std::lock_guard lock(registry().mutex);
  work();
}

RemovedWhenInterrupted::RemovedWhenInterrupted(std::filesystem::path path) {
  std::error_code code;
  path_ = std::filesystem::absolute(path, code);
  const std::lock_guard lock(registry().mutex);
  listen();
  registry().paths.insert(path_);
}

DoneWhenInterrupted::DoneWhenInterrupted(std::function<bool()> work) {
  {
    const std::lock_guard lock(registry().mutex);
    listen();
  }
  const std::lock_guard lock(registry().works_mutex);
  registry().works.emplace(this, std::move(work));
}

DoneWhenInterrupted::~DoneWhenInterrupted() {
  const std::lock_guard lock(registry().works_mutex);
  registry().works.erase(this);
}

RemovedWhenInterrupted::~RemovedWhenInterrupted() {
  const std::lock_guard lock(registry().mutex);
  const auto found = registry().paths.find(path_);
  if (found != registry().paths.end()) registry().paths.erase(found);
}

}  // namespace skerry
