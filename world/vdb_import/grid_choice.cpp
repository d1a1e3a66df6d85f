#include "world/vdb_import/grid_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

#include "world/vdb/answer.h"

namespace skerry::world {
namespace {

std::string list_of(const std::vector<VolumeGrid>& grids) {
  std::string names;
  for (const VolumeGrid& grid : grids)
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", grid.name);
  return names;
}

bool starts_with_any(const std::string& name, std::initializer_list<std::string_view> starts) {
  return std::ranges::any_of(starts,
                             [&](std::string_view start) { return name.starts_with(start); });
}

bool names_block_ids(const VolumeGrid& grid) {
  constexpr std::array<std::string_view, 4> kNames = {"block_id", "block_ids", "ids", "blocks"};
  std::string_view name = std::string_view(grid.name).substr(0, grid.name.find('['));
  // Exports of several islands number them: block_id_0, block_id_1 ...
  if (const std::size_t end = name.find_last_not_of("0123456789");
      end != std::string_view::npos && end + 1 < name.size() && name[end] == '_')
    name = name.substr(0, end);
  return std::ranges::find(kNames, name) != kNames.end();
}

/// "'density' (float, fog volume, 415642 active voxels)"
std::string described(const VolumeGrid& grid) {
  return fmt::format("'{}' ({}, class {}, {} active voxels)", grid.name, grid.value_type,
                     grid.grid_class, grid.active_voxels);
}

}  // namespace

bool holds_block_ids(const VolumeGrid& grid) {
  return grid.kind == VolumeKind::kIds || (grid.kind == VolumeKind::kFog && names_block_ids(grid));
}

GridSort sort_of(const VolumeGrid& grid) {
  if (grid.kind == VolumeKind::kOther || grid.kind == VolumeKind::kColor)
    return GridSort::kNoInside;
  if (grid.bricks.empty() && grid.tiles.empty()) return GridSort::kEmpty;
  if (holds_block_ids(grid) && names_block_ids(grid)) return GridSort::kBlockIds;
  if (starts_with_any(grid.name, {"obstacle", "collision", "collider"})) return GridSort::kObstacle;
  if (grid.kind == VolumeKind::kLevelSet) return GridSort::kLevelSet;
  if (grid.kind == VolumeKind::kMask) return GridSort::kMask;
  if (grid.kind == VolumeKind::kIds) return GridSort::kIntegers;
  if (grid.name.starts_with("density")) return GridSort::kDensity;
  // Fog that says how hot rather than how dense a place is.
  if (starts_with_any(grid.name, {"temperature", "heat", "flame", "fuel"})) return GridSort::kHeat;
  return grid.grid_class == "fog volume" ? GridSort::kFogVolume : GridSort::kOtherValues;
}

std::string_view reason_of(GridSort sort) {
  switch (sort) {
    case GridSort::kBlockIds:
      return "its name says block ids";
    case GridSort::kLevelSet:
      return "it is a level set";
    case GridSort::kDensity:
      return "its name says density";
    case GridSort::kFogVolume:
      return "it is a fog volume";
    case GridSort::kMask:
      return "it is a mask";
    case GridSort::kIntegers:
      return "its integers may be block ids";
    case GridSort::kOtherValues:
      return "its values may be a density";
    case GridSort::kObstacle:
      return "its name says obstacle";
    case GridSort::kHeat:
      return "its name says heat";
    case GridSort::kEmpty:
      return "it is empty";
    case GridSort::kNoInside:
      return "it has no inside";
  }
  return "";
}

std::vector<std::size_t> importable_grids(const std::vector<VolumeGrid>& grids) {
  GridSort best = GridSort::kHeat;
  for (const VolumeGrid& grid : grids) best = std::min(best, sort_of(grid));
  std::vector<std::size_t> out;
  for (std::size_t i = 0; best < GridSort::kHeat && i < grids.size(); ++i)
    if (sort_of(grids[i]) == best) out.push_back(i);
  return out;
}

std::string choice_line(const std::vector<VolumeGrid>& grids, const ImportOptions& options) {
  constexpr int kMostNamed = 4;  // of each list, so that a line stays one
  if (options.grid) return {};
  std::string taken, left;
  int named_taken = 0, named_left = 0;
  const auto add = [](std::string& list, int& count, std::string item) {
    if (++count <= kMostNamed) list += (list.empty() ? "" : ", ") + item;
  };
  const std::vector<std::size_t> chosen = importable_grids(grids);
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const GridSort sort = sort_of(grids[i]);
    if (sort == GridSort::kNoInside) continue;
    const bool is = std::ranges::find(chosen, i) != chosen.end();
    std::string item = fmt::format("{}: {}", described(grids[i]), reason_of(sort));
    is ? add(taken, named_taken, std::move(item)) : add(left, named_left, std::move(item));
  }
  if (named_taken == 0 || named_left == 0) return {};
  const auto more = [](int count) {
    return count > kMostNamed ? fmt::format(" and {} more", count - kMostNamed) : "";
  };
  return fmt::format("takes {}{}; leaves {}{}; --import grid=NAME picks another", taken,
                     more(named_taken), left, more(named_left));
}

Result<std::vector<const VolumeGrid*>> chosen_grids(const std::vector<VolumeGrid>& grids,
                                                    const ImportOptions& options) {
  std::vector<const VolumeGrid*> out;
  for (const std::size_t i : importable_grids(grids))
    if (!options.grid) out.push_back(&grids[i]);
  for (const VolumeGrid& grid : grids)
    if (options.grid && grid.name == *options.grid) out.push_back(&grid);
  if (out.empty() && grids.empty()) return Error{"it holds no grid"};
  if (out.empty() && options.grid)
    return Error{fmt::format("it has no grid '{}'; give one of {}", printable(*options.grid),
                             list_of(grids))};
  if (out.empty() && std::ranges::any_of(grids, [](const VolumeGrid& grid) {
        return sort_of(grid) == GridSort::kEmpty;
      }))
    return Error{"its grids are empty; see skerry vdb info"};
  if (out.empty()) return Error{"none of its grids has an inside; see skerry vdb info"};
  const VolumeGrid& first = *out.front();
  if (first.kind == VolumeKind::kOther || first.kind == VolumeKind::kColor)
    return Error{fmt::format("grid '{}' has no inside: {}; give another --grid", first.name,
                             first.remark.empty() ? "it holds colours" : first.remark)};
  return out;
}

}  // namespace skerry::world
