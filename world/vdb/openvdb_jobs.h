// What the program skerry_openvdb does, with the file or the volumes on its standard input.
#pragma once
#include <filesystem>

#include "engine/core/result.h"
#include "world/vdb/answer.h"

namespace skerry::world {

/// Reads a .vdb file from a descriptor and writes an answer. Errors: not a file that OpenVDB reads,
/// cut short, a grid that disagrees with its own metadata, the sink is full.
Result<void> read_openvdb(int input, const ByteSink& sink);

/// Writes volumes to a .vdb file, compressed by Blosc: kIds as Int32, kMask as bool, all other
/// kinds as float. Errors: the file cannot be written.
Result<void> write_openvdb(const std::vector<VolumeGrid>& grids, const std::filesystem::path& path);

}  // namespace skerry::world
