#include "world/vdb_import/grid_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

bool names_density(const VolumeGrid& grid) {
  return grid.name.starts_with("density");
}

/// Fog that says how hot rather than how dense a place is.
bool names_heat(const VolumeGrid& grid) {
  constexpr std::array<std::string_view, 4> kNames = {"temperature", "heat", "flame", "fuel"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](std::string_view name) { return grid.name.starts_with(name); });
}

}  // namespace

bool holds_block_ids(const VolumeGrid& grid) {
  constexpr std::array<std::string_view, 4> kNames = {"block_id", "block_ids", "ids", "blocks"};
  if (grid.kind == VolumeKind::kIds) return true;
  const std::string_view name = std::string_view(grid.name).substr(0, grid.name.find('['));
  return grid.kind == VolumeKind::kFog &&
         std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

std::vector<std::size_t> importable_grids(const std::vector<VolumeGrid>& grids) {
  const auto all = [&grids](auto&& wanted) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < grids.size(); ++i)
      if (wanted(grids[i])) out.push_back(i);
    return out;
  };
  const auto of_kind = [](VolumeKind kind) {
    return [kind](const VolumeGrid& grid) { return grid.kind == kind; };
  };
  if (auto ids = all(holds_block_ids); !ids.empty()) return ids;
  if (auto sets = all(of_kind(VolumeKind::kLevelSet)); !sets.empty()) return sets;
  if (auto masks = all(of_kind(VolumeKind::kMask)); !masks.empty()) return masks;
  if (auto dense = all([](const VolumeGrid& grid) {
        return grid.kind == VolumeKind::kFog && names_density(grid);
      });
      !dense.empty())
    return dense;
  return all(
      [](const VolumeGrid& grid) { return grid.kind == VolumeKind::kFog && !names_heat(grid); });
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
  if (out.empty()) return Error{"none of its grids has an inside; see skerry vdb info"};
  const VolumeGrid& first = *out.front();
  if (first.kind == VolumeKind::kOther || first.kind == VolumeKind::kColor)
    return Error{fmt::format("grid '{}' has no inside: {}; give another --grid", first.name,
                             first.remark.empty() ? "it holds colours" : first.remark)};
  return out;
}

}  // namespace skerry::world
