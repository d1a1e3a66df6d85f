#include "engine/platform/heap.h"

#include <cstdlib>  // says which C library this is

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace skerry::platform {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kKeptBytes = 256 << 20;
  // Setting one threshold stops glibc from adapting the other, which it does upwards to at most
  // this.
  constexpr int kOwnMappingBytes = 32 << 20;
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
  mallopt(M_MMAP_THRESHOLD, kOwnMappingBytes);
#endif
}

}  // namespace skerry::platform
