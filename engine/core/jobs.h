#pragma once
#include <functional>

namespace skerry {

/// How many threads work beside frames if none are asked for: one a core, from 8 cores on three
/// quarters of them. Where all cores are busy, a frame's threads and the driver's wait for one by
/// milliseconds.
int threads_beside_frames();

/// Worker threads for everything that may run beside the frame. Wraps one TBB arena.
class Jobs {
 public:
  /// @param threads 1.. ; 0 takes one a core. While others live, no more than the least of
  /// them has: TBB limits the workers of a process.
  explicit Jobs(int threads = 0);
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  int threads() const { return threads_; }
  /// Runs on some worker later. Must not throw.
  void submit(std::function<void()> job);
  /// Returns when every job submitted so far, and those they submitted, has ended.
  void wait();
  /// Calls body(i) for i in [0, count) on all workers and returns when all are done.
  void parallel_for(int count, const std::function<void(int)>& body);

 private:
  struct Impl;
  Impl* impl_;
  int threads_;
};

}  // namespace skerry
