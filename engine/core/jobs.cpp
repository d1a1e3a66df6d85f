#include "engine/core/jobs.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>

#include "engine/core/check.h"

#if defined(SKERRY_THREAD_SANITIZER)
extern "C" void __tsan_acquire(void* place);
extern "C" void __tsan_release(void* place);
#endif

namespace skerry {
namespace {

// What TBB orders, declared to the thread sanitizer: the library is not built with it. This file is
// not either (CMakeLists.txt), or it would accuse TBB's headers.
void hand_over([[maybe_unused]] void* place) {
#if defined(SKERRY_THREAD_SANITIZER)
  __tsan_release(place);
#endif
}
void take_over([[maybe_unused]] void* place) {
#if defined(SKERRY_THREAD_SANITIZER)
  __tsan_acquire(place);
#endif
}

// TBB starts at most (allowed parallelism - 1) workers in all and counts the calling thread as one.
// submit() must be served without any caller inside the arena, so one thread more than the workers
// is allowed.
std::size_t allowed_parallelism(int threads) {
  return static_cast<std::size_t>(threads) + 1;
}

/// How many threads a Jobs has that is asked for so many. TBB lets no arena have more workers than
/// the least that any control allows, and warns on stderr when one is asked for more.
int threads_for(int asked, bool others_live) {
  const int wanted = asked > 0 ? asked : tbb::info::default_concurrency();
  if (!others_live) return wanted;
  const std::size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::clamp(static_cast<int>(allowed) - 1, 1, wanted);
}

std::atomic<int> living{0};

}  // namespace

int threads_beside_frames() {
  constexpr int kFew = 8;
  const int cores = tbb::info::default_concurrency();
  return cores < kFew ? cores : cores - cores / 4;
}

struct Jobs::Impl {
  explicit Impl(int threads)
      : control(tbb::global_control::max_allowed_parallelism, allowed_parallelism(threads)),
        arena(threads, 0) {}

  void finished() {
    std::lock_guard lock(mutex);
    if (--pending == 0) idle.notify_all();
  }

  tbb::global_control control;
  tbb::task_arena arena;  // no slot is reserved for callers: all of them belong to workers
  std::mutex mutex;
  std::condition_variable idle;
  long pending = 0;  // jobs submitted and not ended; guarded by mutex
};

Jobs::Jobs(int threads) : threads_(threads_for(threads, living++ > 0)) {
  impl_ = new Impl(threads_);
}

Jobs::~Jobs() {
  wait();
  delete impl_;
  --living;
}

void Jobs::submit(std::function<void()> job) {
  SKERRY_ASSERT(job != nullptr);
  {
    std::lock_guard lock(impl_->mutex);
    ++impl_->pending;
  }
  hand_over(impl_);
  impl_->arena.enqueue([impl = impl_, work = std::move(job)] {
    take_over(impl);
    work();
    impl->finished();
  });
}

void Jobs::wait() {
  std::unique_lock lock(impl_->mutex);
  impl_->idle.wait(lock, [this] { return impl_->pending == 0; });
}

void Jobs::parallel_for(int count, const std::function<void(int)>& body) {
  if (count <= 0) return;
  // The simple partitioner with grain 1 lets the slowest single item decide the end, not a block of
  // them: items here are chunks or rows, whose costs differ widely.
  int begun = 0, ended = 0;  // places for the sanitizer
  hand_over(&begun);
  impl_->arena.execute([&] {
    tbb::parallel_for(
        0, count,
        [&](int i) {
          take_over(&begun);
          body(i);
          hand_over(&ended);
        },
        tbb::simple_partitioner());
  });
  take_over(&ended);
}

}  // namespace skerry
