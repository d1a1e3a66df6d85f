// The mesher for x86-64 with AVX-512 BW, VL, DQ, VBMI and VBMI2 (Ice Lake, Zen 4 and later).
#if defined(__x86_64__)
#include <immintrin.h>

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns of the undefined vectors in its own header (GCC bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "world/mesh/kernel.h"
#include "world/mesh/kernel_emission.h"

#define SKERRY_MESH_TARGET \
  __attribute__((          \
      target("avx512f,avx512bw,avx512vl,avx512dq,avx512vbmi,avx512vbmi2,avx2,bmi,bmi2,popcnt")))

namespace skerry::world::mesh_detail {
namespace {

SKERRY_MESH_TARGET inline __m512i load(const void* bytes) {
  return _mm512_loadu_si512(bytes);
}

// table[byte] for 64 bytes at once.
class WideLookUp {
 public:
  SKERRY_MESH_TARGET explicit WideLookUp(const std::uint8_t* table)
      : quarters_{load(table), load(table + 64), load(table + 128), load(table + 192)} {}
  SKERRY_MESH_TARGET __m512i operator()(__m512i bytes) const {
    const __m512i low = _mm512_permutex2var_epi8(quarters_[0], bytes, quarters_[1]);
    const __m512i high = _mm512_permutex2var_epi8(quarters_[2], bytes, quarters_[3]);
    return _mm512_mask_mov_epi8(low, _mm512_movepi8_mask(bytes), high);
  }

 private:
  __m512i quarters_[4];
};

class NarrowLookUp {
 public:
  SKERRY_MESH_TARGET explicit NarrowLookUp(const std::uint8_t* table) : table_(load(table)) {}
  SKERRY_MESH_TARGET __m512i operator()(__m512i bytes) const {
    return _mm512_permutexvar_epi8(bytes, table_);
  }

 private:
  __m512i table_;
};

template <class LookUp>
class Reader {
 public:
  SKERRY_MESH_TARGET explicit Reader(const ByteTable& table) : flags_(table.flags.data()) {}
  SKERRY_MESH_TARGET RowKinds kinds(const std::uint8_t* bytes) const {
    const __m512i flags = flags_(load(bytes));
    return {has(flags, kFlagOpaque), has(flags, kFlagsSeeThrough), flag(bytes + 1, kFlagOpaque),
            flag(bytes - 1, kFlagOpaque)};
  }
  SKERRY_MESH_TARGET std::uint64_t flag(const std::uint8_t* bytes, std::uint8_t flag) const {
    return has(flags_(load(bytes)), flag);
  }

 private:
  SKERRY_MESH_TARGET static std::uint64_t has(__m512i flags, std::uint8_t flag) {
    return _mm512_test_epi8_mask(flags, _mm512_set1_epi8(static_cast<char>(flag)));
  }
  LookUp flags_;
};
using RowReader = Reader<WideLookUp>;
using NarrowReader = Reader<NarrowLookUp>;

SKERRY_MESH_TARGET inline std::uint64_t row_equal(const std::uint8_t* a, const std::uint8_t* b) {
  return _mm512_cmpeq_epi8_mask(load(a), load(b));
}

SKERRY_MESH_TARGET inline std::uint64_t nonzero_words(const std::uint64_t* words) {
  std::uint64_t bits = 0;
  for (int i = 0; i < kEdge; i += 8) {
    const __m512i eight = load(words + i);
    bits |= std::uint64_t{_mm512_test_epi64_mask(eight, eight)} << i;
  }
  return bits;
}

SKERRY_MESH_TARGET inline void set_bytes(std::uint8_t* bytes, std::uint64_t mask,
                                         std::uint8_t value) {
  // Load, blend and store: a masked store would stall the load that follows.
  const __m512i set =
      _mm512_mask_mov_epi8(load(bytes), mask, _mm512_set1_epi8(static_cast<char>(value)));
  _mm512_storeu_si512(bytes, set);
}

SKERRY_MESH_TARGET inline __m512i indices() {
  alignas(64) static constexpr std::array<std::uint8_t, 64> kIndices = [] {
    std::array<std::uint8_t, 64> list{};
    for (unsigned i = 0; i < 64; ++i) list[i] = static_cast<std::uint8_t>(i);
    return list;
  }();
  return _mm512_load_si512(kIndices.data());
}

// The low eight bytes as 64-bit lanes.
SKERRY_MESH_TARGET inline __m512i widen(__m512i bytes) {
  return _mm512_cvtepu8_epi64(_mm512_castsi512_si128(bytes));
}

SKERRY_MESH_TARGET inline __m512i block_ids(__m512i byte, const ByteTable& table) {
  if (table.narrow) {
    return _mm512_maskz_permutex2var_epi16(0x11111111u, load(table.ids.data()), byte,
                                           load(table.ids.data() + 32));
  }
  const __m256i words = _mm512_i64gather_epi32(byte, table.ids.data(), 2);
  return _mm512_and_si512(_mm512_cvtepu32_epi64(words), _mm512_set1_epi64(0xffff));
}

// Of each quad: its first voxel's three indices, and its byte of the table.
struct PackedLists {
  __m512i a, b, c, byte;
};

// Writes the quads of packed lists, eight at a time. It may write up to seven more, which the next
// ones replace; QuadSink keeps room.
SKERRY_MESH_TARGET inline unsigned emit_lists(shared::Quad* out, const Emission& emission,
                                              unsigned count, PackedLists lists) {
  const __m512i mul_a = _mm512_set1_epi32(static_cast<int>(emission.mul_a));
  const __m512i mul_b = _mm512_set1_epi32(static_cast<int>(emission.mul_b));
  const __m512i mul_c = _mm512_set1_epi32(static_cast<int>(emission.mul_c));
  // Low half of a lane: geometry. High half: material.
  const __m512i base = _mm512_set1_epi64(
      static_cast<long long>(std::uint64_t{emission.face_bits} << 32 | emission.base));
  for (unsigned done = 0;;) {
    // The high halves of the products are 0, so 32-bit sums never touch the material.
    const __m512i from_a = _mm512_mullo_epi32(widen(lists.a), mul_a);
    const __m512i from_b = _mm512_mullo_epi32(widen(lists.b), mul_b);
    const __m512i from_c = _mm512_mullo_epi32(widen(lists.c), mul_c);
    const __m512i id = _mm512_slli_epi64(block_ids(widen(lists.byte), emission.table), 32);
    const __m512i sum = _mm512_add_epi32(_mm512_add_epi32(from_a, from_b),
                                         _mm512_add_epi32(from_c, _mm512_add_epi32(id, base)));
    _mm512_storeu_si512(out + done, sum);
    done += 8;
    if (done >= count) return count;
    lists.a = _mm512_alignr_epi64(lists.a, lists.a, 1);
    lists.b = _mm512_alignr_epi64(lists.b, lists.b, 1);
    lists.c = _mm512_alignr_epi64(lists.c, lists.c, 1);
    lists.byte = _mm512_alignr_epi64(lists.byte, lists.byte, 1);
  }
}

SKERRY_MESH_TARGET inline unsigned emit_runs(shared::Quad* out, const Emission& emission,
                                             std::uint64_t finished, std::uint64_t starts,
                                             std::uint64_t ends, const std::uint8_t* first) {
  // The n-th end belongs to the n-th start.
  const std::uint64_t begins = _pdep_u64(_pext_u64(finished, ends), starts);
  return emit_lists(out, emission, static_cast<unsigned>(__builtin_popcountll(finished)),
                    {_mm512_maskz_compress_epi8(finished, load(first)),
                     _mm512_maskz_compress_epi8(begins, indices()),
                     _mm512_maskz_compress_epi8(finished, indices()),
                     _mm512_maskz_compress_epi8(finished, load(emission.bytes))});
}

SKERRY_MESH_TARGET inline unsigned emit_columns(shared::Quad* out, const Emission& emission,
                                                std::uint64_t finished, const std::uint8_t* first_x,
                                                const std::uint8_t* first_y) {
  return emit_lists(out, emission, static_cast<unsigned>(__builtin_popcountll(finished)),
                    {_mm512_maskz_compress_epi8(finished, load(first_x)),
                     _mm512_maskz_compress_epi8(finished, load(first_y)),
                     _mm512_maskz_compress_epi8(finished, indices()),
                     _mm512_maskz_compress_epi8(finished, load(emission.bytes))});
}

}  // namespace
}  // namespace skerry::world::mesh_detail

#include "world/mesh/kernel_body.h"

namespace skerry::world::mesh_detail {
const Kernel kAvx512Kernel{"avx512", narrow, build_planes, mesh_face};
}
#endif
