#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace skerry::tools {

/// A bar on stderr while work goes on; nothing when stderr is no terminal. Gone when destroyed.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// @param share 0..1. @param what is being done, one line.
  void show(double share, std::string_view what);
  /// Takes the bar away, so that something else can be printed.
  void clear();

 private:
  bool terminal_;
  bool shown_ = false;
};

}  // namespace skerry::tools
