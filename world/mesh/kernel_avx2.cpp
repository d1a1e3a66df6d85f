// The mesher for x86-64 with AVX2 and BMI2.
#if defined(__x86_64__)
#include <immintrin.h>

#include "world/mesh/kernel.h"
#include "world/mesh/kernel_emission.h"

#define SKERRY_MESH_TARGET __attribute__((target("avx2,bmi,bmi2")))
#include "world/mesh/kernel_scalar.h"

namespace skerry::world::mesh_detail {
namespace {

SKERRY_MESH_TARGET inline __m256i load_half(const std::uint8_t* bytes, int half) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bytes + 32 * half));
}

SKERRY_MESH_TARGET inline std::uint64_t sign_bits(__m256i low, __m256i high) {
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(low)) |
         std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_epi8(high))} << 32;
}

SKERRY_MESH_TARGET inline __m256i twice(const std::array<std::uint8_t, 16>& half) {
  return _mm256_broadcastsi128_si256(_mm_load_si128(reinterpret_cast<const __m128i*>(half.data())));
}

// Which bytes belong to a set: the low nibble picks a set of high nibbles, the high nibble a bit of
// it. After W. Mula, "SIMD-ized check which bytes are in a set" (2018), re-derived.
class SetMatcher {
 public:
  SKERRY_MESH_TARGET explicit SetMatcher(const ByteSet& set)
      : below_8_(twice(set.high_below_8)), from_8_(twice(set.high_from_8)) {}
  SKERRY_MESH_TARGET std::uint64_t match(__m256i low, __m256i high) const {
    return sign_bits(in_set(low), in_set(high));
  }

 private:
  SKERRY_MESH_TARGET __m256i in_set(__m256i bytes) const {
    const __m256i nibble = _mm256_set1_epi8(15);
    const __m256i low = _mm256_and_si256(bytes, nibble);
    const __m256i high = _mm256_and_si256(_mm256_srli_epi16(bytes, 4), nibble);
    const __m256i bit_of_high = _mm256_broadcastsi128_si256(
        _mm_setr_epi8(1, 2, 4, 8, 16, 32, 64, -128, 1, 2, 4, 8, 16, 32, 64, -128));
    const __m256i members = _mm256_blendv_epi8(_mm256_shuffle_epi8(below_8_, low),
                                               _mm256_shuffle_epi8(from_8_, low), bytes);
    const __m256i bit = _mm256_shuffle_epi8(bit_of_high, high);
    return _mm256_cmpeq_epi8(_mm256_and_si256(members, bit), bit);
  }

  __m256i below_8_, from_8_;
};

class RowReader {
 public:
  SKERRY_MESH_TARGET explicit RowReader(const ByteTable& table)
      : opaque_(table.opaque), see_through_(table.see_through), flags_(table.flags) {}
  SKERRY_MESH_TARGET RowKinds kinds(const std::uint8_t* bytes) const {
    const __m256i low = load_half(bytes, 0), high = load_half(bytes, 1);
    return with_neighbours(flags_, bytes, opaque_.match(low, high), see_through_.match(low, high));
  }
  SKERRY_MESH_TARGET std::uint64_t flag(const std::uint8_t* bytes, std::uint8_t flag) const {
    if (flag == kFlagOpaque) return opaque_.match(load_half(bytes, 0), load_half(bytes, 1));
    return flag_bits(flags_, bytes, flag);
  }

 private:
  SetMatcher opaque_, see_through_;
  const std::array<std::uint8_t, 256>& flags_;
};
using NarrowReader = RowReader;

SKERRY_MESH_TARGET inline std::uint64_t row_equal(const std::uint8_t* a, const std::uint8_t* b) {
  return sign_bits(_mm256_cmpeq_epi8(load_half(a, 0), load_half(b, 0)),
                   _mm256_cmpeq_epi8(load_half(a, 1), load_half(b, 1)));
}

SKERRY_MESH_TARGET inline std::uint64_t nonzero_words(const std::uint64_t* words) {
  std::uint64_t zero = 0;
  for (int i = 0; i < kEdge; i += 4) {
    const __m256i four = _mm256_load_si256(reinterpret_cast<const __m256i*>(words + i));
    const __m256i equal = _mm256_cmpeq_epi64(four, _mm256_setzero_si256());
    zero |= std::uint64_t(_mm256_movemask_pd(_mm256_castsi256_pd(equal))) << i;
  }
  return ~zero;
}

}  // namespace
}  // namespace skerry::world::mesh_detail

#include "world/mesh/kernel_body.h"

namespace skerry::world::mesh_detail {
const Kernel kAvx2Kernel{"avx2", narrow, build_planes, mesh_face};
}
#endif
