// The bytes in which the program and its OpenVDB process hand each other volumes. Only one machine
// ever sees them, so numbers stand as in memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "world/confined/answer_text.h"
#include "world/vdb/volume_grid.h"

namespace skerry::world {

/// Most grids of one file.
inline constexpr std::uint32_t kMaxVolumeGrids = 4096;

/// Starts an answer that will hold so many grids; encode_grid must follow for each.
bool begin_answer(std::uint32_t grids, const ByteSink& sink);
bool encode_grid(const VolumeGrid& grid, const ByteSink& sink);
/// A whole answer that says why there are no grids.
bool encode_error(std::string_view message, const ByteSink& sink);

/// Parses what a child that may be out of control has written. Everything that volume_grid.h
/// promises is checked. Errors: the child's own message, or what is wrong with the bytes; one
/// printable line, without the file's name.
Result<std::vector<VolumeGrid>> decode_answer(std::span<const std::byte> bytes);

/// Whether all of a box lies where voxels of a grid may: kMaxVolumeIndex.
bool within_reach(const VolumeBox& box);

}  // namespace skerry::world
