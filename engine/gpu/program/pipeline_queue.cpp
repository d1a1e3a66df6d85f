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

void PipelineQueue::add(Pipeline& pipeline, std::function<void(Pipeline&)> compile,
                        std::size_t code_bytes, bool last) {
  pipeline.queue_ = this;
  pipeline.compile_ = std::move(compile);
  pipeline.code_bytes_ = code_bytes;
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
  lock.unlock();
  // What comes next the frame is going to wait for as well.
  while (!pipeline.ready() && help()) {
  }
  lock.lock();
  made_.wait(lock, [&] { return pipeline.ready(); });
}

bool PipelineQueue::help() {
  std::unique_lock lock(mutex_);
  Pipeline* pipeline = take_next(first_);
  lock.unlock();
  if (pipeline) compile(*pipeline);
  return pipeline != nullptr;
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
    Pipeline* pipeline = take_longest(first_);
    if (!pipeline) pipeline = take_next(last_);
    if (!pipeline) continue;
    lock.unlock();
    compile(*pipeline);
    lock.lock();
  }
}

/// Takes the first that nobody has begun; null: what was waiting has begun. @pre the mutex is held.
Pipeline* PipelineQueue::take_next(std::deque<Pipeline*>& waiting) {
  while (!waiting.empty()) {
    Pipeline* pipeline = waiting.front();
    waiting.pop_front();
    if (!std::exchange(pipeline->begun_, true)) return pipeline;
  }
  return nullptr;
}

Pipeline* PipelineQueue::take_longest(std::deque<Pipeline*>& waiting) {
  std::erase_if(waiting, [](const Pipeline* pipeline) { return pipeline->begun_; });
  const auto longest = std::ranges::max_element(waiting, {}, &Pipeline::code_bytes_);
  if (longest == waiting.end()) return nullptr;
  Pipeline* pipeline = *longest;
  waiting.erase(longest);
  pipeline->begun_ = true;
  return pipeline;
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
