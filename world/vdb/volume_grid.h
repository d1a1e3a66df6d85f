// Grids of a .vdb file as plain values. No OpenVDB header is needed to use them.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "world/confined/process.h"
#include "world/voxel/coords.h"

namespace skerry::world {

inline constexpr int kBrickEdge = 8;

/// 8^3 values, index z + 8 * y + 64 * x as in OpenVDB's leaves. origin is a multiple of 8.
struct VolumeBrick {
  IVec3 origin;
  std::array<float, 512> values;
};

/// A cube of one value; origin is a multiple of edge.
struct VolumeTile {
  IVec3 origin;
  std::int32_t edge = 0;  ///< a power of two, 8..kMaxTileEdge
  float value = 0.0f;
};
inline constexpr std::int32_t kMaxTileEdge = 4096;
/// Most tiles of all grids of a file: looking one up takes some 70 bytes beside its own.
inline constexpr std::size_t kMaxVolumeTiles = std::size_t{1} << 22;

/// No index of a grid is further from 0: so far, differences fit 32 bits.
inline constexpr std::int32_t kMaxVolumeIndex = 1 << 30;

/// What the values mean.
enum class VolumeKind : std::uint8_t {
  kFog,       ///< density, temperature ...; 0 or the background is nothing
  kLevelSet,  ///< distance to a surface, negative inside
  kMask,      ///< bool or mask grid: 1 inside, 0 outside
  kIds,       ///< integer grid: block ids
  kColor,     ///< three floats a voxel, packed as sRGB: 65536 * r + 256 * g + b, each 0..255
  kOther,     ///< neither: no values are held (`remark` says why)
};

/// The index box of active voxels; max is inclusive, as OpenVDB counts.
struct VolumeBox {
  IVec3 min, max;
};

/// A sparse grid: a value for every integer index (i, j, k). Where neither a brick nor a tile is,
/// the value is `background`. Bricks and tiles do not overlap, are sorted by origin, and all values
/// are finite. The sample of index (i, j, k) lies at world_from_index * (i, j, k, 1); its voxel, if
/// one wants it to have an extent, reaches half an index to each side. Inactive voxels read as the
/// background, but for level sets, whose inactive values distinguish inside from outside.
struct VolumeGrid {
  std::string name;        ///< unique in the file: grids of one name get [0], [1] ...
  std::string value_type;  ///< "float", "bool", "int32", "vec3s" ..., of OpenVDB
  std::string grid_class;  ///< as the file states it: "level set", "fog volume", "unknown" ...
  VolumeKind kind = VolumeKind::kOther;
  std::string remark;                ///< kOther: why its values are not held, else empty
  glm::dmat4 world_from_index{1.0};  ///< affine, finite, invertible unless kOther
  float background = 0.0f;
  std::uint64_t active_voxels = 0;  ///< those of tiles too
  std::uint64_t active_tiles = 0;
  std::uint64_t leaves = 0;                  ///< OpenVDB leaf nodes
  std::uint64_t memory_bytes = 0;            ///< OpenVDB's own count of the tree
  std::uint64_t stated_memory_bytes = 0;     ///< what the file says of that; 0: nothing
  std::uint64_t replaced_values = 0;         ///< NaN and infinite ones that became the background
  VolumeBox active_box;                      ///< meaningless without active voxels
  float min_value = 0.0f, max_value = 0.0f;  ///< of bricks, tiles and background
  float mean_value = 0.0f;  ///< of all values in bricks and tiles that are not the background
  std::vector<VolumeBrick> bricks;
  std::vector<VolumeTile> tiles;
};

/// What makes grids that could be read look damaged, in one line without the file's name; empty:
/// nothing. The memory of a tree follows from its nodes, and versions of OpenVDB differ by less
/// than one percent in what they state of it. Active voxels and their box are held against the
/// metadata when a file is read, which refuses it.
std::string metadata_doubt(const std::vector<VolumeGrid>& grids);

/// What a file of a size can rightly need, and no more than `most`: OpenVDB makes room for what a
/// file states before it finds that there is no such thing in it. The nodes of a tree take up to
/// 100 times their masks in the file, which are never compressed.
ReadLimits limits_for(std::uint64_t file_bytes, const ReadLimits& most = {});

/// Every grid of a .vdb file, in the file's order; those that cannot be sampled are kOther.
/// Errors: no such file, no VDB file, truncated, damaged, a limit exceeded, no OpenVDB in this
/// build, the reader program is missing.
Result<std::vector<VolumeGrid>> read_vdb(const std::filesystem::path& path,
                                         const ReadLimits& limits = {},
                                         const ReadProgress& progress = {});

/// The scalar grids of a .vdb file: kFog, kLevelSet, kMask and kIds.
/// Errors: those of read_vdb; the file holds no such grid.
Result<std::vector<VolumeGrid>> read_volumes(const std::filesystem::path& path,
                                             const ReadLimits& limits = {},
                                             const ReadProgress& progress = {});

}  // namespace skerry::world
