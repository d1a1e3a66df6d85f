#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace skerry {

/// Worker threads for long work that no frame waits for. The system gives them less of the
/// processors than others where all are busy (nice, on Linux), so that frames of a CPU driver keep
/// their pace meanwhile.
class BackgroundThreads {
 public:
  /// @param threads 1..
  explicit BackgroundThreads(int threads);
  /// Waits for all jobs.
  ~BackgroundThreads();
  BackgroundThreads(const BackgroundThreads&) = delete;
  BackgroundThreads& operator=(const BackgroundThreads&) = delete;

  /// Runs on some thread later, in the order of submission; what a job submits comes before all
  /// that waits, so that one piece of work ends before the next begins. Must not throw.
  void submit(std::function<void()> job);
  /// Returns when every job submitted so far, and those they submitted, has ended.
  void wait();

 private:
  void work();
  std::mutex mutex_;  // guards all below but the threads
  std::condition_variable wanted_, idle_;
  std::deque<std::function<void()>> jobs_;
  int running_ = 0;
  bool stopping_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace skerry
