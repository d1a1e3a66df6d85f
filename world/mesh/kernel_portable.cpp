// The mesher for any CPU: 64-bit integers only.
#include <cstring>

#include "world/mesh/kernel.h"
#include "world/mesh/kernel_emission.h"

#define SKERRY_MESH_TARGET
#include "world/mesh/kernel_scalar.h"

namespace skerry::world::mesh_detail {
namespace {

class RowReader {
 public:
  explicit RowReader(const ByteTable& table) : flags_(table.flags) {}
  RowKinds kinds(const std::uint8_t* bytes) const {
    std::uint64_t opaque = 0, see_through = 0;
    for (int z = 0; z < kEdge; ++z) {
      const std::uint64_t flags = flags_[bytes[z]];
      opaque |= (flags & kFlagOpaque) << z;
      see_through |= std::uint64_t{(flags & kFlagsSeeThrough) != 0} << z;
    }
    return with_neighbours(flags_, bytes, opaque, see_through);
  }
  std::uint64_t flag(const std::uint8_t* bytes, std::uint8_t flag) const {
    return flag_bits(flags_, bytes, flag);
  }

 private:
  const std::array<std::uint8_t, 256>& flags_;
};
using NarrowReader = RowReader;

inline std::uint64_t row_equal(const std::uint8_t* a, const std::uint8_t* b) {
  std::uint64_t bits = 0;
  for (int z = 0; z < kEdge; ++z) bits |= std::uint64_t{a[z] == b[z]} << z;
  return bits;
}

inline std::uint64_t nonzero_words(const std::uint64_t* words) {
  std::uint64_t bits = 0;
  for (int i = 0; i < kEdge; ++i) bits |= std::uint64_t{words[i] != 0} << i;
  return bits;
}

}  // namespace
}  // namespace skerry::world::mesh_detail

#include "world/mesh/kernel_body.h"

namespace skerry::world::mesh_detail {
const Kernel kPortableKernel{"portable", narrow, build_planes, mesh_face};
}
