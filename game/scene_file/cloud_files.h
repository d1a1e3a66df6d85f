// Clouds of .vdb files: what was asked for, and the volumes in them.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/render/sky/cloud_volume.h"
#include "world/vdb/volume_grid.h"
#include "world/voxel/coords.h"

namespace skerry::game {

/// One file's clouds in a world.
struct CloudFile {
  std::string path;
  world::WorldPos position{};  ///< of the file's own origin
  double scale = 1.0;          ///< blocks a unit of the file, 1e-3 .. 1e3
  bool of_scene_file = false;  ///< a scene file names it, so that no command line has to
  bool operator==(const CloudFile&) const = default;
};

/// Reads "FILE[@X,Y,Z[,SCALE]]". What follows the last @ is a part of the name unless it looks like
/// numbers. Errors: no name, a number that cannot be used.
Result<CloudFile> parse_cloud(std::string_view text);
/// Reads back as an equal one.
std::string format_cloud(const CloudFile& cloud);

/// Reads the field `clouds` of a scene file: a list of objects with file, and optionally position
/// [X, Y, Z] and scale. Errors name the cloud.
Result<std::vector<CloudFile>> read_clouds(const nlohmann::json& value);

/// Relative paths are meant as file_of_scene (scene_files.h) has it.
void find_beside(const std::string& scene_file, std::vector<CloudFile>& clouds);

/// Volumes, and the grids that their bricks are in.
struct LoadedClouds {
  std::vector<std::unique_ptr<std::vector<world::VolumeGrid>>> grids;
  std::vector<render::CloudVolumeDesc> volumes;
  std::vector<std::string> remarks;  ///< a line for each file of which grids are left out
};

/// What a fog grid of this name is: heat glows, everything else is density.
render::CloudRole cloud_role(std::string_view grid_name);
/// Which of a file's fog grids are drawn, in their order: all, but where any is named for density,
/// those and the ones that glow alone. Fuel, pressure and the like are no density.
std::vector<std::size_t> drawn_grids(std::span<const std::string> names);

/// Reads the fog grids of all files. Errors, naming the file: it cannot be read; it holds no fog.
Result<LoadedClouds> load_clouds(std::span<const CloudFile> files);

}  // namespace skerry::game
