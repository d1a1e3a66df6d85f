#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace skerry {

/// Threads of their own for work that no frame waits for. One thread does its jobs one after the
/// other.
class WorkerThreads {
 public:
  enum class Priority : std::uint8_t {
    kUsual,
    /// Less of the processors where all are busy (nice, on Linux), so that frames of a CPU driver
    /// keep their pace.
    kLowered,
  };
  /// @param threads 1..
  explicit WorkerThreads(int threads, Priority priority = Priority::kUsual);
  /// Waits for all jobs.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  /// Runs on some thread later, in the order of submission; what a job submits comes before all
  /// that waits, so that one piece of work ends before the next begins. Must not throw.
  void submit(std::function<void()> job);
  /// Alike, before all that waits.
  void submit_first(std::function<void()> job);
  /// Returns when every job submitted so far, and those they submitted, has ended.
  void wait();
  /// For an end that nobody should wait for: jobs that have not begun never run, nor does what is
  /// submitted from now on. Those that run end as usual.
  void drop_waiting();

 private:
  void work(Priority priority);
  void submit(std::function<void()> job, bool first);
  std::mutex mutex_;  // guards all below but the threads
  std::condition_variable wanted_, idle_;
  std::deque<std::function<void()>> jobs_;
  int running_ = 0;
  bool dropping_ = false;  // jobs, rather than running them
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace skerry
