#pragma once
#include <cstdint>
#include <optional>

#include "tools/skerry/test/judge.h"

namespace skerry::tools {

/// How scenes are drawn and judged, in every process alike.
struct PoolOptions {
  std::optional<std::uint32_t> device;
  bool validate = false;
  std::optional<int> processes;  ///< none: one a core on a CPU device, else one
  int runs = 1;                  ///< every scene is drawn afresh so many times
  JudgeOptions judge;
};

}  // namespace skerry::tools
