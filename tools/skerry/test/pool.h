// Processes that draw and judge scenes side by side.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/test/judge.h"
#include "tools/skerry/test/pool_options.h"
#include "tools/skerry/test/worker.h"

namespace skerry::tools {

struct PoolResult {
  std::optional<Refusal> refusal;  ///< there is no device, or no process to use it
  int validation_messages = 0;
};

/// The body of a drawing process, as serve().
using Serve = std::function<void(int jobs, int results, const Seat& seat)>;

/// Draws and judges every scene. Each process keeps one device and its pipelines for all of its
/// scenes. A process that dies fails its scene; another takes its place on its device.
/// @param done receives each outcome as it comes, with the scene's index. The order is the scenes'
/// with one process, else any.
/// @pre this process has no thread but its main one: the others are forked from it.
PoolResult run_pool(std::span<const TestScene> scenes, const PoolOptions& options,
                    const std::function<void(std::size_t scene, const Outcome&)>& done);
PoolResult run_pool(std::span<const TestScene> scenes, const PoolOptions& options,
                    const std::function<void(std::size_t scene, const Outcome&)>& done,
                    const Serve& serve);

}  // namespace skerry::tools
