#pragma once
#include <cstddef>
#include <cstdint>

namespace skerry::world {

/// Refused beyond these, which all islands of an import share: chunks, and those of them through
/// which a surface passes.
inline constexpr std::size_t kMaxImportChunks = 1 << 18;
inline constexpr std::size_t kMaxDetailedChunks = 1 << 13;
/// Chunks that bricks and tiles name, one of several counted for each: those of sheared grids
/// overlap, and a set that they name again and again takes time without growing.
inline constexpr std::uint64_t kMaxNamedChunks = 1 << 23;
/// Looks into the grids, in units of one block's; some minutes of a processor. Under a strong slant
/// no cube of blocks is settled by bounds, and of chunks that turn out to be empty every block is
/// asked.
inline constexpr std::uint64_t kMaxImportLooks = std::uint64_t{1} << 31;
/// What else takes time, in those units: bounds of the values in a cube, materials of a chunk.
inline constexpr std::uint64_t kBoundsLooks = 16, kPaintLooks = 1 << 15;

/// Without a scale or size that the user gave, an import looks no more often than this, and this
/// for each brick and tile: what they need at one block a voxel, alone in their chunks.
inline constexpr std::uint64_t kUnaskedLooks = 3 << 26, kLooksPerPart = 1 << 16;

/// What an import has taken so far.
struct ImportCost {
  std::size_t chunks = 0;           ///< that may hold something
  std::size_t mixed_chunks = 0;     ///< that are neither empty nor full
  std::size_t detailed_chunks = 0;  ///< of several blocks
  std::uint64_t named_chunks = 0;
  std::uint64_t looks = 0;
  std::uint64_t most_looks = kMaxImportLooks;  ///< refused beyond
};

}  // namespace skerry::world
