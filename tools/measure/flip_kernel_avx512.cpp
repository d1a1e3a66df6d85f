// FLIP for x86-64 with AVX-512.
#if defined(__x86_64__)
#include <immintrin.h>

#include "tools/measure/flip_kernel.h"

#define SKERRY_FLIP_TARGET __attribute__((target("avx512f,avx512dq,avx512vl")))
#define SKERRY_FLIP_LANES 8
#include "tools/measure/flip_kernel_vector.h"

namespace skerry::measure::flip_detail {
namespace {

SKERRY_FLIP_TARGET inline Vec square_root(const Vec& x) {
  return _mm512_maskz_sqrt_pd(0xff, x);
}

}  // namespace
}  // namespace skerry::measure::flip_detail

#include "tools/measure/flip_kernel_body.h"

namespace skerry::measure::flip_detail {

const Kernel kAvx512Kernel{"avx512", tile_errors};

}  // namespace skerry::measure::flip_detail
#endif
