#pragma once
#include <string_view>

#include "engine/core/clock.h"

namespace skerry::tools {

/// A bar on stderr for work of more than a second, if stderr is a terminal. Gone when it goes.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param share done, 0..1. @param what is being done, a few words.
  void show(double share, std::string_view what);
  /// Takes the bar off the line, for a line of text.
  void clear();

 private:
  const bool terminal_;
  bool shown_ = false;
  Stopwatch watch_;
};

}  // namespace skerry::tools
