#include "engine/core/worker_threads.h"

#include <sys/resource.h>
#include <unistd.h>
#include <utility>

#include "engine/core/check.h"

namespace skerry {
namespace {

// Against others, a third of the share of a thread of usual priority: light follows an edit within
// some seconds on two busy cores, and frames take a third longer meanwhile.
constexpr int kNice = 5;

thread_local const WorkerThreads* working_for = nullptr;

/// Of this thread alone: Linux keeps the value by thread. Without effect where it is refused.
void lower_priority() {
  const auto thread = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + kNice);
}

}  // namespace

WorkerThreads::WorkerThreads(int threads, Priority priority) {
  SKERRY_ASSERT(threads >= 1);
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this, priority] { work(priority); });
}

WorkerThreads::~WorkerThreads() {
  wait();
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  wanted_.notify_all();
}

void WorkerThreads::submit(std::function<void()> job) {
  submit(std::move(job), working_for == this);
}

void WorkerThreads::submit_first(std::function<void()> job) {
  submit(std::move(job), true);
}

void WorkerThreads::submit(std::function<void()> job, bool first) {
  SKERRY_ASSERT(job != nullptr);
  const std::lock_guard lock(mutex_);
  if (dropping_) return;
  if (first)
    jobs_.push_front(std::move(job));
  else
    jobs_.push_back(std::move(job));
  wanted_.notify_one();
}

void WorkerThreads::wait() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return jobs_.empty() && running_ == 0; });
}

void WorkerThreads::drop_waiting() {
  std::deque<std::function<void()>> dropped;  // freed without the lock: that may take long
  const std::lock_guard lock(mutex_);
  dropping_ = true;
  jobs_.swap(dropped);
  if (running_ == 0) idle_.notify_all();
}

void WorkerThreads::work(Priority priority) {
  if (priority == Priority::kLowered) lower_priority();
  working_for = this;
  std::unique_lock lock(mutex_);
  for (;;) {
    wanted_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    ++running_;
    lock.unlock();
    job();
    job = nullptr;  // what it holds may take long to free
    lock.lock();
    --running_;
    if (jobs_.empty() && running_ == 0) idle_.notify_all();
  }
}

}  // namespace skerry
