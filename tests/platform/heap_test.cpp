#include "engine/platform/heap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <vector>

namespace skerry::platform {
namespace {

constexpr std::size_t kBlockBytes = 64u << 10, kBlocks = 384, kPageBytes = 4096;

/// Fills 24 MiB in blocks as a CPU rasteriser does with a frame's bins, and frees them.
void fill_and_free() {
  std::vector<std::unique_ptr<char[]>> blocks(kBlocks);
  for (std::unique_ptr<char[]>& block : blocks) {
    block = std::make_unique_for_overwrite<char[]>(kBlockBytes);
    for (std::size_t i = 0; i < kBlockBytes; i += kPageBytes) {
      *static_cast<volatile char*>(block.get() + i) = 1;
    }
  }
}

long faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

TEST(Heap, MemoryThatIsFreedAndTakenAgainFaultsOnce) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "another allocator";
#endif
  // In a process of its own, so that other tests keep the allocator as it is.
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    keep_freed_memory();
    fill_and_free();
    const long before = faults();
    for (int frame = 0; frame < 8; ++frame) fill_and_free();
    const long pages = static_cast<long>(kBlocks * kBlockBytes / kPageBytes);
    _exit(faults() - before < pages / 4 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
      << "memory went back to the kernel between frames";
}

}  // namespace
}  // namespace skerry::platform
