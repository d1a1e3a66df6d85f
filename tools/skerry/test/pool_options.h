#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/skerry/test/judge.h"

namespace skerry::tools {

/// How scenes are drawn and judged, in every process alike.
struct PoolOptions {
  std::vector<std::uint32_t> devices;  ///< each has processes of its own; empty: the best one
  bool validate = false;
  std::optional<int> processes;  ///< a device; none: one a core on CPU devices, else one
  int runs = 1;                  ///< every scene is drawn afresh so many times
  /// Seconds that each scene may take, none where it is not known: those come first, then longer
  /// ones. Empty: nothing is known.
  std::vector<std::optional<double>> expected_s;
  JudgeOptions judge;
};

}  // namespace skerry::tools
