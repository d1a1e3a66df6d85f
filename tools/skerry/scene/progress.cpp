#include "tools/skerry/scene/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace skerry::tools {

ProgressBar::ProgressBar() : terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::clear() {
  if (!shown_) return;
  fmt::print(stderr, "\r\x1b[K");
  shown_ = false;
}

void ProgressBar::show(double share, std::string_view what) {
  if (!terminal_) return;
  constexpr int kCells = 30;
  const int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * kCells);
  clear();
  fmt::print(stderr, "[{:=<{}}{:<{}}] {:3.0f}% {:.40}", "", full, "", kCells - full, share * 100.0,
             what);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace skerry::tools
