#include "engine/core/shared_work.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/processors.h"

namespace skerry {

Helpers* Helpers::of_frames() {
  // Never destroyed: a forked process that exits has no such threads, and would wait for them.
  static Helpers* const kHelpers = new Helpers(std::clamp(usable_cpus() - 1, 1, 3));
  return kHelpers;
}

/// Outlives the work where a helper comes too late for it.
struct SharedWork::Pieces {
  Pieces(int all, std::function<void(int)> each) : count(all), body(std::move(each)) {}

  void take() {
    for (int i = next++; i < count; i = next++) {
      body(i);
      if (done.fetch_add(1, std::memory_order_acq_rel) + 1 == count) done.notify_one();
    }
  }
  void wait() const {
    for (int now = done.load(std::memory_order_acquire); now != count;
         now = done.load(std::memory_order_acquire))
      done.wait(now, std::memory_order_acquire);
  }

  const int count;
  const std::function<void(int)> body;
  std::atomic<int> next{0}, done{0};
};

SharedWork::SharedWork(Helpers* helpers, int pieces, std::function<void(int)> body) {
  SKERRY_ASSERT(pieces >= 0 && body != nullptr);
  if (pieces == 0) return;
  pieces_ = std::make_shared<Pieces>(pieces, std::move(body));
  if (!helpers) return;
  for (int i = 0; i < std::min(pieces, helpers->count_); ++i)
    helpers->threads_.submit([shared = pieces_] { shared->take(); });
}

void SharedWork::join() {
  if (!pieces_) return;
  pieces_->take();
  pieces_->wait();
  pieces_.reset();
}

void share_calls(std::size_t count, std::size_t a_piece,
                 const std::function<void(std::size_t)>& each) {
  SKERRY_ASSERT(a_piece > 0);
  const auto pieces = static_cast<int>((count + a_piece - 1) / a_piece);
  SharedWork(pieces > 1 ? Helpers::of_frames() : nullptr, pieces, [&](int piece) {
    const std::size_t first = static_cast<std::size_t>(piece) * a_piece;
    for (std::size_t i = first; i < std::min(first + a_piece, count); ++i) each(i);
  }).join();
}

}  // namespace skerry
