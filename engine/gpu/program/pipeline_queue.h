#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/gpu/program/pipeline.h"

namespace skerry::gpu {

/// Worker threads that compile pipelines. They start with the first one.
class PipelineQueue {
 public:
  PipelineQueue() = default;
  ~PipelineQueue() { stop(); }
  PipelineQueue(const PipelineQueue&) = delete;
  PipelineQueue& operator=(const PipelineQueue&) = delete;

  /// @param pipeline and what `compile` refers to outlive this or its stop().
  /// @param last after those that are not.
  void add(Pipeline& pipeline, std::function<void(Pipeline&)> compile, bool last);
  /// See Pipeline::made.
  void finish(Pipeline& pipeline);
  std::size_t pending() const;
  /// Ends the workers; what no worker has begun is not compiled.
  void stop();

 private:
  void work();
  Pipeline* next();
  void compile(Pipeline& pipeline);

  mutable std::mutex mutex_;
  std::condition_variable added_, made_;
  std::deque<Pipeline*> first_, last_;  // some of them may have begun by now
  std::size_t pending_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace skerry::gpu
