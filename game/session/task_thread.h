#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace skerry::game {

/// A thread that does what it is given, one after the other.
class TaskThread {
 public:
  TaskThread();
  ~TaskThread();  ///< does what is still queued
  TaskThread(const TaskThread&) = delete;
  TaskThread& operator=(const TaskThread&) = delete;

  /// @param task must not throw.
  void add(std::function<void()> task);
  /// Returns when all that was added so far is done.
  void wait();

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable wake_, idle_;
  std::deque<std::function<void()>> tasks_;
  bool busy_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace skerry::game
