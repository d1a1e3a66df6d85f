// FLIP for any CPU: vectors of two doubles.
#include <cmath>

#include "tools/measure/flip_kernel.h"

#define SKERRY_FLIP_TARGET
#define SKERRY_FLIP_LANES 2
#include "tools/measure/flip_kernel_vector.h"

namespace skerry::measure::flip_detail {
namespace {

inline Vec square_root(const Vec& x) {
  return Vec{std::sqrt(x[0]), std::sqrt(x[1])};
}

}  // namespace
}  // namespace skerry::measure::flip_detail

#include "tools/measure/flip_kernel_body.h"

namespace skerry::measure::flip_detail {

const Kernel kPortableKernel{"portable", tile_errors};

}  // namespace skerry::measure::flip_detail
