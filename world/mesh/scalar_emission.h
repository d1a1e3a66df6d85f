// The emission step one quad at a time, for instruction sets without byte compression. Included
// like kernel_body.h, after SKERRY_MESH_TARGET is defined.
#include "world/mesh/emission.h"

namespace skerry::world::mesh_detail {
namespace {

SKERRY_MESH_TARGET inline void set_bytes(std::uint8_t* bytes, std::uint64_t mask,
                                         std::uint8_t value) {
  for (; mask != 0; mask &= mask - 1) bytes[__builtin_ctzll(mask)] = value;
}

SKERRY_MESH_TARGET inline unsigned emit_runs(shared::Quad* out, const Emission& emission,
                                             std::uint64_t finished, std::uint64_t starts,
                                             std::uint64_t /*ends*/, const std::uint8_t* first) {
  unsigned count = 0;
  for (; finished != 0; finished &= finished - 1) {
    const unsigned end = static_cast<unsigned>(__builtin_ctzll(finished));
    // The run's start is the highest start at or below its end.
    const std::uint64_t below = starts & (finished ^ (finished - 1));
    const unsigned start = 63u - static_cast<unsigned>(__builtin_clzll(below));
    out[count++] = emission.quad(first[end], start, end, emission.bytes[end]);
  }
  return count;
}

SKERRY_MESH_TARGET inline unsigned emit_columns(shared::Quad* out, const Emission& emission,
                                                std::uint64_t finished, const std::uint8_t* first_x,
                                                const std::uint8_t* first_y) {
  unsigned count = 0;
  for (; finished != 0; finished &= finished - 1) {
    const unsigned z = static_cast<unsigned>(__builtin_ctzll(finished));
    out[count++] = emission.quad(first_x[z], first_y[z], z, emission.bytes[z]);
  }
  return count;
}

}  // namespace
}  // namespace skerry::world::mesh_detail
