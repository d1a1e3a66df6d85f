#pragma once
#include <filesystem>
#include <functional>

namespace skerry {

/// While this lives, a signal to end (SIGINT, SIGTERM, SIGHUP) removes a file or folder first;
/// the process then ends by that signal, as without. A second signal ends it at once. Source: the
/// self-pipe trick (D. J. Bernstein): the handler writes a byte, a thread does the rest.
class RemovedWhenInterrupted {
 public:
  explicit RemovedWhenInterrupted(std::filesystem::path path);
  /// Does not return any more once the removal has begun, so that whatever follows does not
  /// happen: neither a second removal nor a new name.
  ~RemovedWhenInterrupted();
  RemovedWhenInterrupted(const RemovedWhenInterrupted&) = delete;
  RemovedWhenInterrupted& operator=(const RemovedWhenInterrupted&) = delete;

 private:
  std::filesystem::path path_;
};

/// While this lives, a signal to end first does `work` on a thread of its own, whatever the other
/// threads are at. The process then ends by the signal, or, when `work` says that it failed or
/// takes more than two seconds, with status 1. What is interrupted during that is never
/// removed: the work must not make or drop one of these or a RemovedWhenInterrupted.
class DoneWhenInterrupted {
 public:
  explicit DoneWhenInterrupted(std::function<bool()> work);
  /// Does not return any more once the work has begun.
  ~DoneWhenInterrupted();
  DoneWhenInterrupted(const DoneWhenInterrupted&) = delete;
  DoneWhenInterrupted& operator=(const DoneWhenInterrupted&) = delete;
};

/// Does something during which no removal may begin; when one has begun, this does not
/// return. The work makes and drops no RemovedWhenInterrupted.
void uninterrupted(const std::function<void()>& work);

}  // namespace skerry
