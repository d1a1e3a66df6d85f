// FLIP for x86-64 with AVX2.
#if defined(__x86_64__)
#include <immintrin.h>

#include "tools/measure/flip_kernel.h"

#define SKERRY_FLIP_TARGET __attribute__((target("avx2")))
#define SKERRY_FLIP_LANES 4
#include "tools/measure/flip_kernel_vector.h"

namespace skerry::measure::flip_detail {
namespace {

SKERRY_FLIP_TARGET inline Vec square_root(const Vec& x) {
  return _mm256_sqrt_pd(x);
}

}  // namespace
}  // namespace skerry::measure::flip_detail

#include "tools/measure/flip_kernel_body.h"

namespace skerry::measure::flip_detail {

const Kernel kAvx2Kernel{"avx2", tile_errors};

}  // namespace skerry::measure::flip_detail
#endif
