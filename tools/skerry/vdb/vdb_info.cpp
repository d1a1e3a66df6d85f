#include "tools/skerry/vdb/vdb_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "game/scene_file/parse.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"
#include "world/vdb_import/grid_choice.h"

namespace skerry::tools {
namespace {

using world::VolumeGrid;
using world::VolumeKind;

std::string_view kind_name(VolumeKind kind) {
  switch (kind) {
    case VolumeKind::kFog:
      return "fog";
    case VolumeKind::kLevelSet:
      return "level set";
    case VolumeKind::kMask:
      return "mask";
    case VolumeKind::kIds:
      return "block ids";
    case VolumeKind::kColor:
      return "colour";
    case VolumeKind::kOther:
      return "other";
  }
  return "other";
}

/// What import and --cloud do with a grid.
std::string use_of(const VolumeGrid& grid, bool imported) {
  if (grid.kind == VolumeKind::kOther) return "left out: " + grid.remark;
  const world::GridSort sort = world::sort_of(grid);
  if (sort == world::GridSort::kEmpty) return "left out: it is empty";
  if (grid.kind == VolumeKind::kColor) return "colours the surface of what is imported";
  std::string use =
      fmt::format("{}, as {}", imported ? "imported as an island" : "imported if named by --grid",
                  world::reason_of(sort));
  if (world::holds_block_ids(grid)) {
    use += ": values are block ids";
  } else if (grid.kind == VolumeKind::kLevelSet) {
    use += ": solid below 0";
  } else if (grid.kind == VolumeKind::kFog) {
    use += fmt::format(": solid from {:.4g}; drawn by --cloud", 0.5f * grid.mean_value);
  }
  return use;
}

std::vector<std::string> uses_of(const std::vector<VolumeGrid>& grids) {
  const std::vector<std::size_t> imported = world::importable_grids(grids);
  std::vector<std::string> uses;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const bool is = std::find(imported.begin(), imported.end(), i) != imported.end();
    uses.push_back(use_of(grids[i], is));
  }
  return uses;
}

glm::dvec3 voxel_size(const VolumeGrid& grid) {
  const glm::dmat4& m = grid.world_from_index;
  return {glm::length(glm::dvec3(m[0])), glm::length(glm::dvec3(m[1])),
          glm::length(glm::dvec3(m[2]))};
}

std::string size_text(glm::dvec3 size) {
  const bool even =
      std::abs(size.x - size.y) < 1e-6 * size.x && std::abs(size.x - size.z) < 1e-6 * size.x;
  return even ? fmt::format("{:.6g}", size.x)
              : fmt::format("{:.6g} x {:.6g} x {:.6g}", size.x, size.y, size.z);
}

void print_table(const std::vector<VolumeGrid>& grids) {
  const std::vector<std::string> uses = uses_of(grids);
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const VolumeGrid& grid = grids[i];
    const world::VolumeBox& box = grid.active_box;
    fmt::print("{}\n", grid.name.empty() ? "(no name)" : grid.name);
    fmt::print("  kind     {}, {}, class {}\n", kind_name(grid.kind), grid.value_type,
               grid.grid_class);
    fmt::print("  active   {} voxels, {} tiles, {} leaves, {:.1f} MiB\n", grid.active_voxels,
               grid.active_tiles, grid.leaves, static_cast<double>(grid.memory_bytes) / 1048576.0);
    if (grid.active_voxels > 0)
      fmt::print("  box      [{}, {}, {}] .. [{}, {}, {}], both inclusive\n", box.min.x, box.min.y,
                 box.min.z, box.max.x, box.max.y, box.max.z);
    fmt::print("  voxel    {}\n", size_text(voxel_size(grid)));
    if (grid.kind != VolumeKind::kOther && grid.kind != VolumeKind::kColor)
      fmt::print("  values   {:.6g} .. {:.6g}, background {:.6g}\n", grid.min_value, grid.max_value,
                 grid.background);
    if (grid.replaced_values > 0)
      fmt::print("  damage   {} values are no numbers; the background stands for them\n",
                 grid.replaced_values);
    fmt::print("  use      {}\n", uses[i]);
  }
  if (grids.empty()) fmt::print("no grids\n");
}

void print_json(const std::vector<VolumeGrid>& grids) {
  const std::vector<std::string> uses = uses_of(grids);
  const auto array = [](world::IVec3 v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const VolumeGrid& grid = grids[i];
    const glm::dvec3 size = voxel_size(grid);
    nlohmann::ordered_json matrix = nlohmann::ordered_json::array();
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) matrix.push_back(grid.world_from_index[column][row]);
    rows.push_back({{"name", grid.name},
                    {"type", grid.value_type},
                    {"class", grid.grid_class},
                    {"kind", kind_name(grid.kind)},
                    {"active_voxels", grid.active_voxels},
                    {"active_tiles", grid.active_tiles},
                    {"leaves", grid.leaves},
                    {"memory_bytes", grid.memory_bytes},
                    {"index_min", array(grid.active_box.min)},
                    {"index_max", array(grid.active_box.max)},
                    {"voxel_size", {size.x, size.y, size.z}},
                    {"world_from_index", matrix},
                    {"background", grid.background},
                    {"min", grid.min_value},
                    {"max", grid.max_value},
                    {"replaced_values", grid.replaced_values},
                    {"use", uses[i]}});
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"grids", rows}}.dump(2));
}

}  // namespace

int vdb_info(const std::filesystem::path& file, bool json) {
  ProgressBar bar;
  const auto grids =
      world::read_vdb(file, {}, [&bar](double share) { bar.show(share, "reading"); });
  bar.clear();
  if (!grids) return fail(kFailed, grids.error());
  if (const std::string doubt = world::metadata_doubt(*grids); !doubt.empty())
    fmt::print(stderr, "skerry: {}: {}\n", game::quote_text(file.string()), doubt);
  json ? print_json(*grids) : print_table(*grids);
  return 0;
}

}  // namespace skerry::tools
