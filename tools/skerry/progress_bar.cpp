#include "tools/skerry/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace skerry::tools {

ProgressBar::ProgressBar() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::show(double share, std::string_view what) {
  constexpr int kCells = 40;
  if (!terminal_ || watch_.seconds() < 1.0) return;
  const double clamped = std::clamp(share, 0.0, 1.0);
  const std::string bar(static_cast<std::size_t>(clamped * kCells), '#');
  fmt::print(stderr, "\r\033[K[{:<{}}] {:3.0f}% {}", bar, kCells, 100.0 * clamped, what);
  std::fflush(stderr);
  shown_ = true;
}

void ProgressBar::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace skerry::tools
