// Primitives one voxel or quad at a time, for instruction sets without byte permutations and
// compression. Included like kernel_body.h, after SKERRY_MESH_TARGET is defined.
#include "world/mesh/kernel_emission.h"

namespace skerry::world::mesh_detail {
namespace {

SKERRY_MESH_TARGET inline std::uint64_t flag_bits(const std::array<std::uint8_t, 256>& flags,
                                                  const std::uint8_t* bytes, std::uint8_t flag) {
  std::uint64_t bits = 0;
  for (int z = 0; z < kEdge; ++z) bits |= std::uint64_t{(flags[bytes[z]] & flag) != 0} << z;
  return bits;
}

// Adds what lies beyond the row's ends to its kinds.
SKERRY_MESH_TARGET inline RowKinds with_neighbours(const std::array<std::uint8_t, 256>& flags,
                                                   const std::uint8_t* bytes, std::uint64_t opaque,
                                                   std::uint64_t see_through) {
  const std::uint64_t before = flags[bytes[-1]] & kFlagOpaque;
  const std::uint64_t after = flags[bytes[kEdge]] & kFlagOpaque;
  return {opaque, see_through, opaque >> 1 | after << 63, opaque << 1 | before};
}

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
