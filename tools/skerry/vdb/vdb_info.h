#pragma once
#include <filesystem>

namespace skerry::tools {

/// `skerry vdb info`: prints the grids of a .vdb file and what Skerry does with each, as a table or
/// as JSON ({"grids": [{name, type, class, kind, active_voxels, active_tiles, leaves, memory_bytes,
/// index_min, index_max, voxel_size, world_from_index, background, min, max, replaced_values,
/// use}]}). @return exit status.
int vdb_info(const std::filesystem::path& file, bool json);

}  // namespace skerry::tools
