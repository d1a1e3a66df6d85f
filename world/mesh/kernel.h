// What the mesher's parts share. Private to world/mesh and its tests.
//
// One chunk goes through three steps:
//  1. planes: one bit a voxel, 64 voxels of a row (z) in a word, words ordered by y, then x. Bits
//     say "opaque", "same id as the next voxel along x / y / z", and so on. After this step no
//     voxel is compared again.
//  2. sweeps: for each of the six faces and each layer y, which runs of faces begin, end, and
//     repeat in the next row, all by bit logic on 8 words at once (kernel_body.h).
//  3. emission: one quad for every run that ends and is not repeated.
// Steps 1 and 3 have primitives for each instruction set; everything else is shared.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/mesh/chunk_mesh.h"
#include "world/voxel/blocks.h"

namespace skerry::world::mesh_detail {

inline constexpr int kEdge = 64;
inline constexpr int kVoxelStepX = kPaddedEdge;                // from a voxel to its +x neighbour
inline constexpr int kVoxelStepY = kPaddedEdge * kPaddedEdge;  // and to its +y neighbour

/// Kinds as bits, so that a table lookup answers several questions at once.
enum KindFlag : std::uint8_t {
  kFlagOpaque = 1,
  kFlagCutout = 2,
  kFlagTranslucent = 4,
  kFlagPlant = 8
};
inline constexpr std::uint8_t kFlagsSeeThrough = kFlagCutout | kFlagTranslucent | kFlagPlant;

std::uint8_t kind_flag(BlockId id);

/// One bit for each voxel of the chunk and its shell in x and y. x = 0 lies on a cache line.
struct alignas(64) Plane {
  static constexpr int kStride = 80;
  std::array<std::uint64_t, std::size_t{kPaddedEdge} * kStride> words{};
  /// The word of row (0, y); x may be added from -1 to 64. @pre -1 <= y <= 64.
  std::uint64_t* row(int y) { return words.data() + (y + 1) * kStride + 8; }
  const std::uint64_t* row(int y) const { return words.data() + (y + 1) * kStride + 8; }
};

struct Planes {
  Plane opaque;            // with shell
  Plane above_z, below_z;  // the +z, -z neighbour is opaque; inner rows only
  // Same id as the next voxel along the axis (from -1 along it) and, same_below_z, as the one
  // before. Only rows with a face to draw are kept up to date.
  Plane same_x, same_y, same_z, same_below_z;
  Plane see_through;                 // cut-out, translucent or plant
  Plane cutout, translucent, plant;  // meaningless when their `any` is 0
  // The bits of all rows together: 0 when the chunk has none of the kind.
  std::uint64_t any_opaque = 0, any_see_through = 0;
  std::uint64_t any_cutout = 0, any_translucent = 0, any_plant = 0;
};

/// A set of bytes by nibbles: bit h & 7 of entry l says whether byte 16 h + l is in it.
struct ByteSet {
  alignas(16) std::array<std::uint8_t, 16> high_below_8{}, high_from_8{};
  void add(unsigned byte) {
    auto& half = byte < 128 ? high_below_8 : high_from_8;
    half[byte & 15] = static_cast<std::uint8_t>(half[byte & 15] | 1u << (byte >> 4 & 7));
  }
};

/// What a voxel byte means.
struct ByteTable {
  alignas(64) std::array<std::uint8_t, 256> flags{};     // KindFlag
  alignas(64) std::array<std::uint16_t, 256 + 2> ids{};  // block id; gathers read 4 bytes
  ByteSet opaque, see_through;
  bool narrow = true;  // no byte in use reaches 64
  void set(unsigned byte, BlockId id);
};

/// One bit for each of 64 voxels along z.
struct RowKinds {
  std::uint64_t opaque, see_through;
  std::uint64_t above_z, below_z;  ///< the +z, -z neighbour is opaque
};

/// The voxels of one call.
struct Voxels {
  const std::uint8_t* bytes = nullptr;  // kPaddedVoxels of them
  const ByteTable* table = nullptr;
  const std::uint8_t* row(int x, int y) const {
    return bytes + ((y + 1) * kPaddedEdge + (x + 1)) * kPaddedEdge + 1;
  }
};

/// Which voxels have a face in one direction, as a set of coordinates an axis.
struct Extent {
  std::uint64_t x = 0, y = 0, z = 0;
};

/// Quads written so far. The vector is kept larger than `count`, so that emission can store whole
/// vectors without looking.
struct QuadSink {
  static constexpr std::size_t kSlack = 64;
  std::vector<shared::Quad>& quads;
  std::size_t count = 0;
  /// Room for `more` quads and the slack.
  shared::Quad* reserve(std::size_t more) {
    const std::size_t needed = count + more + kSlack;
    if (quads.size() < needed) quads.resize(needed + quads.size());
    return quads.data() + count;
  }
};

/// The steps as one instruction set runs them.
struct Kernel {
  const char* name;
  /// Copies ids to bytes. @return false if an id needs more than 8 bits.
  bool (*narrow)(std::span<const BlockId> ids, std::uint8_t* bytes, BlockId& largest);
  /// Step 1.
  void (*build_planes)(const Voxels& voxels, Planes& planes);
  /// Steps 2 and 3 for one kind and one face.
  /// @param own_id_hides whether a neighbour of the same id hides the face.
  Extent (*mesh_face)(const Planes& planes, const Plane& kind, bool own_id_hides, unsigned face,
                      const Voxels& voxels, QuadSink& sink);
};

extern const Kernel kPortableKernel;
#if defined(__x86_64__)
extern const Kernel kAvx2Kernel, kAvx512Kernel;
#endif

/// The kernels this CPU can run, fastest first; the last one is the portable one.
std::span<const Kernel* const> kernels();

/// mesh_chunk with a kernel of choice: all give the same quads.
void mesh_chunk_with(const Kernel& kernel, std::span<const BlockId> voxels, MeshScratch& scratch,
                     ChunkMesh& out);
void mesh_chunk_with(const Kernel& kernel, std::span<const std::uint8_t> voxels,
                     std::span<const BlockId> palette, MeshScratch& scratch, ChunkMesh& out);

}  // namespace skerry::world::mesh_detail
