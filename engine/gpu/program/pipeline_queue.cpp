#include "engine/gpu/program/pipeline_queue.h"

#include <algorithm>
#include <utility>

#include "engine/core/processors.h"

namespace skerry::gpu {
namespace {

constexpr int kMostWorkers = 8;

/// A core is left to the frame.
int worker_count() {
  return std::clamp(usable_cpus(), 2, kMostWorkers + 1) - 1;
}

}  // namespace

const Pipeline& Pipeline::made() const {
  if (!ready()) queue_->finish(const_cast<Pipeline&>(*this));
  return *this;
}

void PipelineQueue::add(Pipeline& pipeline, std::function<void(Pipeline&)> compile, bool last) {
  pipeline.queue_ = this;
  pipeline.compile_ = std::move(compile);
  {
    const std::lock_guard lock(mutex_);
    (last ? last_ : first_).push_back(&pipeline);
    ++pending_;
  }
  if (workers_.empty())
    for (int i = 0; i < worker_count(); ++i) workers_.emplace_back([this] { work(); });
  added_.notify_one();
}

void PipelineQueue::finish(Pipeline& pipeline) {
  std::unique_lock lock(mutex_);
  if (!std::exchange(pipeline.begun_, true)) {
    lock.unlock();
    return compile(pipeline);
  }
  made_.wait(lock, [&] { return pipeline.ready(); });
}

std::size_t PipelineQueue::pending() const {
  const std::lock_guard lock(mutex_);
  return pending_;
}

void PipelineQueue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  added_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  workers_.clear();
}

void PipelineQueue::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    added_.wait(lock, [this] { return stopping_ || !first_.empty() || !last_.empty(); });
    if (stopping_) return;
    Pipeline* pipeline = next();
    if (!pipeline) continue;
    lock.unlock();
    compile(*pipeline);
    lock.lock();
  }
}

/// Takes one that nobody has begun; null: what was waiting has begun. @pre the mutex is held.
Pipeline* PipelineQueue::next() {
  for (std::deque<Pipeline*>* waiting : {&first_, &last_}) {
    while (!waiting->empty()) {
      Pipeline* pipeline = waiting->front();
      waiting->pop_front();
      if (!std::exchange(pipeline->begun_, true)) return pipeline;
    }
  }
  return nullptr;
}

/// @pre this thread has begun it.
void PipelineQueue::compile(Pipeline& pipeline) {
  pipeline.compile_(pipeline);
  {
    const std::lock_guard lock(mutex_);
    pipeline.ready_.store(true, std::memory_order_release);
    --pending_;
  }
  made_.notify_all();
}

}  // namespace skerry::gpu
