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
  /// @param code_bytes of its shaders. @param last after those that are not, in the order of these
  /// calls; of the others workers take the longest first, so that none is left alone in the end.
  void add(Pipeline& pipeline, std::function<void(Pipeline&)> compile, std::size_t code_bytes,
           bool last);
  /// See Pipeline::made.
  void finish(Pipeline& pipeline);
  /// Compiles one on this thread that is not to come last. @return false: none was waiting.
  bool help();
  std::size_t pending() const;
  /// Ends the workers; what no worker has begun is not compiled.
  void stop();

 private:
  void work();
  static Pipeline* take_next(std::deque<Pipeline*>& waiting);
  static Pipeline* take_longest(std::deque<Pipeline*>& waiting);
  void compile(Pipeline& pipeline);

  mutable std::mutex mutex_;
  std::condition_variable added_, made_;
  std::deque<Pipeline*> first_, last_;  // some of them may have begun by now
  std::size_t pending_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace skerry::gpu
