#pragma once
#include <cstddef>
#include <functional>
#include <memory>

#include "engine/core/worker_threads.h"

namespace skerry {

/// Threads that take pieces of work off others, see SharedWork.
class Helpers {
 public:
  /// @param threads 1..
  explicit Helpers(int threads) : count_(threads), threads_(threads) {}
  /// Those of the process, for what threads of frames wait for: one a processor but the frame's
  /// own, three at most. All renderers have them in common, as they have the processors.
  static Helpers* of_frames();
  int threads() const { return count_; }

 private:
  friend class SharedWork;
  int count_;
  WorkerThreads threads_;
};

/// Work in pieces that helpers begin while the thread that has it done does something else. In the
/// end this thread does what no helper has begun, so that it waits for no helper that is busy or
/// has no processor, but for the piece that one is in the middle of.
class SharedWork {
 public:
  /// @param helpers null: this thread does all of it, in join(). To wake one takes some 0.01 ms.
  /// @param pieces 0..
  /// @param body is called once with each of [0, pieces), on any thread and in any order; what it
  /// does must not depend on either, and it must not throw.
  SharedWork(Helpers* helpers, int pieces, std::function<void(int)> body);
  ~SharedWork() { join(); }
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  /// Returns when all pieces are done. Again: nothing.
  void join();

 private:
  struct Pieces;
  std::shared_ptr<Pieces> pieces_;  // null: joined
};

/// Calls each(i) once for each i of [0, count), shared with the helpers of frames where that is
/// more than one piece, and returns when all are done.
/// @param a_piece calls that one thread makes in a row, 1..: worth far more than waking a helper.
/// @param each as SharedWork's body.
void share_calls(std::size_t count, std::size_t a_piece,
                 const std::function<void(std::size_t)>& each);

}  // namespace skerry
