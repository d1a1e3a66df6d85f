#pragma once
#include <cstdint>

#include "world/mesh/kernel.h"

namespace skerry::world::mesh_detail {

/// How the three coordinates found for a quad become its words. Everything is linear in them, so
/// one form serves all faces: geometry = base + a * mul_a + b * mul_b + c * mul_c, modulo 2^32.
/// emit_runs takes a = first row, b = the run's start bit, c = its end bit; emit_columns takes
/// a = first x, b = first y, c = z. A negative weight in mul turns "first" into "extent".
struct Emission {
  const ByteTable& table;
  std::uint32_t face_bits;  // of the material word
  std::uint32_t mul_a, mul_b, mul_c;
  std::uint32_t base = 0;               // of the current row
  const std::uint8_t* bytes = nullptr;  // voxels of the current row

  Emission(const ByteTable& byte_table, unsigned face, std::uint32_t a, std::uint32_t b,
           std::uint32_t c)
      : table(byte_table), face_bits(face << shared::kFaceShift), mul_a(a), mul_b(b), mul_c(c) {}

  __attribute__((always_inline)) inline shared::Quad quad(std::uint32_t a, std::uint32_t b,
                                                          std::uint32_t c, unsigned byte) const {
    return {base + a * mul_a + b * mul_b + c * mul_c, table.ids[byte] | face_bits};
  }
};

}  // namespace skerry::world::mesh_detail
