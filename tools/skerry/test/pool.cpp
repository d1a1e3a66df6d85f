#include "tools/skerry/test/pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <functional>
#include <limits>
#include <list>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/processors.h"
#include "tools/skerry/farm/cpu_share.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/test/worker.h"

namespace skerry::tools {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// A child process that draws, and the pipes to and from it.
struct Worker {
  pid_t process = -1;
  int jobs = -1;     ///< scenes to draw are written here
  int results = -1;  ///< lines come from here
  std::string unread;
  bool greeted = false;
  std::optional<std::uint32_t> device;  ///< none: the best
  std::optional<std::size_t> scene;     ///< it draws now
  std::set<std::string> worlds;         ///< of which it has drawn scenes, see world_shown()
};

/// What scenes of the same islands have in common.
std::string world_shown(const game::SceneOptions& scene) {
  return scene.world ? "file " + *scene.world : "seed " + scene.seed_text;
}

/// "signal 11", "status 3".
std::string end_of(int status) {
  if (WIFSIGNALED(status)) return fmt::format("signal {}", WTERMSIG(status));
  return fmt::format("status {}", WEXITSTATUS(status));
}

class Pool {
 public:
  Pool(std::span<const TestScene> scenes, const PoolOptions& options,
       const std::function<void(std::size_t, const Outcome&)>& done, const Serve& serve)
      : scenes_(scenes),
        options_(options),
        done_(done),
        serve_(serve),
        cores_(usable_cpus()),
        left_(scenes.size() * static_cast<std::size_t>(options.runs)),
        seconds_(options.expected_s),
        order_(scenes.size()) {
    seconds_.resize(scenes.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    for (const TestScene& scene : scenes) worlds_.push_back(world_shown(scene.scene));
    devices_.assign(options.devices.begin(), options.devices.end());
    if (devices_.empty()) devices_.push_back(std::nullopt);
    const auto devices = static_cast<int>(devices_.size());
    const int wanted = options.processes ? *options.processes * devices : std::max(cores_, devices);
    planned_ = std::min(wanted, static_cast<int>(std::min<std::size_t>(left_, 1024)));
  }
  ~Pool() {
    for (Worker& worker : workers_) {
      ::kill(worker.process, SIGKILL);
      end(worker);
    }
  }

  PoolResult run() {
    start_workers(0, processes(false));
    while (!workers_.empty() && !result_.refusal) wait_for_lines();
    return result_;
  }

 private:
  void start_workers(int first, int end);
  void start_worker(std::optional<std::uint32_t> device);
  [[noreturn]] void become_worker(int jobs, int results, std::optional<std::uint32_t> device);
  int processes(bool on_cpu) const;
  void wait_for_lines();
  bool take_in(Worker& worker);
  void take_line(Worker& worker, const std::string& line);
  void greet(const Greeting& greeting);
  std::size_t next_scene(Worker& worker);
  void give_job(Worker& worker);
  void lose(Worker& worker);
  int end(Worker& worker);

  std::span<const TestScene> scenes_;
  const PoolOptions& options_;
  const std::function<void(std::size_t, const Outcome&)>& done_;
  const Serve& serve_;
  std::vector<std::optional<std::uint32_t>> devices_;
  int cores_;
  int planned_ = 1;                             // processes, if devices are CPUs
  std::size_t left_;                            // jobs not given out yet
  std::vector<std::optional<double>> seconds_;  // that each scene took when it was drawn last
  std::vector<std::string> worlds_;             // by scene
  std::vector<std::size_t> order_;              // of all scenes, in this run of them
  std::vector<std::size_t> waiting_;            // of them, those that no worker has been given
  bool met_ = false;                            // a worker has said that there is a device
  std::list<Worker> workers_;
  PoolResult result_;
};

/// All at once, each device's turn after the other's: opening a GPU takes up to a second.
void Pool::start_workers(int first, int end) {
  for (auto i = static_cast<std::size_t>(first);
       i < static_cast<std::size_t>(end) && !result_.refusal; ++i)
    start_worker(devices_[i % devices_.size()]);
}

void Pool::start_worker(std::optional<std::uint32_t> device) {
  int jobs[2], results[2];
  const bool piped = ::pipe(jobs) == 0 && ::pipe(results) == 0;
  std::fflush(nullptr);  // or the child would write it again
  const pid_t process = piped ? ::fork() : -1;
  if (process < 0) {
    result_.refusal =
        Refusal{kFailed,
                {fmt::format("cannot start a process to draw in: {}; close other programs",
                             std::strerror(errno))}};
    return;
  }
  if (process == 0) {
    ::close(jobs[1]);
    ::close(results[0]);
    become_worker(jobs[0], results[1], device);
  }
  ::close(jobs[0]);
  ::close(results[1]);
  Worker worker;
  worker.process = process;
  worker.jobs = jobs[1];
  worker.results = results[0];
  worker.device = device;
  workers_.push_back(std::move(worker));
}

void Pool::become_worker(int jobs, int results, std::optional<std::uint32_t> device) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // A sibling sees the end of its jobs only when no other process holds its pipe.
  for (const Worker& sibling : workers_) {
    ::close(sibling.jobs);
    ::close(sibling.results);
  }
  stay_on_cpu_share(
      static_cast<std::size_t>(std::ranges::find(devices_, device) - devices_.begin()),
      devices_.size());
  // Worlds are made on the processor whatever draws them: more threads than cores only contend.
  serve_(jobs, results,
         {device, std::max(1, cores_ / planned_), std::max(1, cores_ / processes(false))});
  std::fflush(nullptr);
  ::_exit(0);
}

/// How many processes there are to be.
int Pool::processes(bool on_cpu) const {
  if (on_cpu || options_.processes) return planned_;
  return std::min(planned_, static_cast<int>(devices_.size()));
}

void Pool::wait_for_lines() {
  std::vector<pollfd> waiting;
  for (const Worker& worker : workers_) waiting.push_back({worker.results, POLLIN, 0});
  if (::poll(waiting.data(), waiting.size(), -1) < 0) return;  // a signal; ask again
  auto worker = workers_.begin();
  for (const pollfd& seen : waiting) {  // workers started meanwhile stand behind these
    const auto now = worker++;
    if (seen.revents == 0 || take_in(*now)) continue;
    lose(*now);
    workers_.erase(now);
  }
}

/// @return false when the worker has closed its end.
bool Pool::take_in(Worker& worker) {
  char block[1 << 14];
  const ssize_t got = ::read(worker.results, block, sizeof block);
  if (got < 0) return errno == EINTR;
  if (got == 0) return false;
  worker.unread.append(block, static_cast<std::size_t>(got));
  for (std::size_t end = 0; (end = worker.unread.find('\n')) != std::string::npos;) {
    const std::string line = worker.unread.substr(0, end);
    worker.unread.erase(0, end + 1);
    take_line(worker, line);
  }
  return true;
}

void Pool::take_line(Worker& worker, const std::string& line) {
  if (!worker.greeted) {
    worker.greeted = true;
    greet(greeting_of(line));
    if (!result_.refusal) give_job(worker);
  } else if (worker.scene) {
    const std::size_t scene = *std::exchange(worker.scene, std::nullopt);
    const Outcome outcome = outcome_of(line);
    seconds_[scene] = outcome.row.seconds;
    done_(scene, outcome);
    give_job(worker);
  } else {
    result_.validation_messages += farewell_of(line).validation_messages;
  }
}

/// The first greeting says whether devices are CPUs, on which more processes draw at once.
void Pool::greet(const Greeting& greeting) {
  if (!greeting.error.empty()) {
    result_.refusal = Refusal{kNoDevice, {greeting.error}};
    return;
  }
  if (std::exchange(met_, true)) return;
  start_workers(processes(false), processes(greeting.on_cpu));
}

/// Scenes that take long come first in every run, so that no worker is left with one while the
/// others have nothing to do; before them those that nothing is known of. But as long as there are
/// others, a worker gets none of a world that only another has drawn scenes of: what it has made of
/// its worlds serves it again (game::SceneCache).
std::size_t Pool::next_scene(Worker& worker) {
  if (waiting_.empty()) {
    const auto seconds = [&](std::size_t scene) { return seconds_[scene].value_or(kUnknown); };
    std::ranges::stable_sort(order_, std::greater(), seconds);
    waiting_ = order_;
  }
  const auto suits = [&](std::size_t scene) {
    const std::string& world = worlds_[scene];
    return worker.worlds.contains(world) ||
           std::ranges::none_of(workers_,
                                [&](const Worker& other) { return other.worlds.contains(world); });
  };
  auto chosen = std::ranges::find_if(waiting_, suits);
  if (chosen == waiting_.end()) chosen = waiting_.begin();
  const std::size_t scene = *chosen;
  waiting_.erase(chosen);
  worker.worlds.insert(worlds_[scene]);
  return scene;
}

void Pool::give_job(Worker& worker) {
  if (left_ == 0) {
    ::close(std::exchange(worker.jobs, -1));
    return;
  }
  --left_;
  worker.scene = next_scene(worker);
  const std::string line = fmt::format("{}\n", *worker.scene);
  // A worker that has died meanwhile is noticed when its results end.
  [[maybe_unused]] const ssize_t written = ::write(worker.jobs, line.data(), line.size());
}

/// Takes leave of a worker that has closed its end, in peace or by accident.
void Pool::lose(Worker& worker) {
  const int status = end(worker);
  if (!worker.greeted && !result_.refusal) {
    result_.refusal =
        Refusal{kNoDevice,
                {fmt::format("opening the Vulkan device ended the process by {}; try another "
                             "--device, or update the driver",
                             end_of(status))}};
  }
  if (!worker.scene) return;
  const std::string why = fmt::format("drawing it ended the process by {}", end_of(status));
  Outcome outcome{failed_row(scenes_[*worker.scene], why), {}, false};
  outcome.row.device = worker.device;
  done_(*worker.scene, outcome);
  if (left_ > 0) start_worker(worker.device);
}

int Pool::end(Worker& worker) {
  if (worker.jobs >= 0) ::close(std::exchange(worker.jobs, -1));
  if (worker.results >= 0) ::close(std::exchange(worker.results, -1));
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

PoolResult run_pool(std::span<const TestScene> scenes, const PoolOptions& options,
                    const std::function<void(std::size_t scene, const Outcome&)>& done) {
  return run_pool(scenes, options, done, [&](int jobs, int results, const Seat& seat) {
    serve(jobs, results, scenes, options, seat);
  });
}

PoolResult run_pool(std::span<const TestScene> scenes, const PoolOptions& options,
                    const std::function<void(std::size_t scene, const Outcome&)>& done,
                    const Serve& serve) {
  // Writing to a worker that has died must not end this process.
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  PoolResult result = Pool(scenes, options, done, serve).run();
  std::signal(SIGPIPE, before);
  return result;
}

}  // namespace skerry::tools
