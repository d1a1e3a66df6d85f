#include "game/scene_file/cloud_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"
#include "game/scene_file/scene_files.h"

namespace skerry::game {
namespace {

using nlohmann::json;

constexpr double kLeastScale = 1e-3, kMostScale = 1e3;

bool looks_like_numbers(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isdigit(c) || c == ',' || c == '.' || c == '-' || c == '+' || c == 'e';
  });
}

Result<void> read_place(std::span<const std::string> parts, CloudFile& into) {
  std::int64_t* const axes[] = {&into.position.x, &into.position.y, &into.position.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const Result<std::int64_t> part = parse_blocks(parts[i], "the cloud's place");
    if (!part) return part.error();
    *axes[i] = *part;
  }
  if (parts.size() == 3) return {};
  const Result<double> scale = parse_number(parts[3], "the cloud's scale", kLeastScale, kMostScale);
  if (!scale) return scale.error();
  into.scale = *scale;
  return {};
}

Error wrong(std::string_view field, std::string_view wanted) {
  return Error{fmt::format("'{}' is wrong: give {}", field, wanted)};
}

/// A coordinate as parse_blocks reads it; texts hold digits that a JSON number would lose.
Result<std::string> coordinate(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.17f}", value.get<double>());
  if (value.is_number()) return value.dump();
  return wrong("position", "[X, Y, Z] in blocks");
}

Result<CloudFile> read_cloud(const json& value) {
  constexpr std::array<std::string_view, 3> kFields{"file", "position", "scale"};
  if (!value.is_object() || !value.contains("file") || !value.at("file").is_string() ||
      value.at("file").get<std::string>().empty())
    return Error{"it has no file: give an object with 'file', e.g. {\"file\": \"cloud.vdb\"}"};
  if (const Result<void> known = check_fields(value, kFields); !known) return known.error();
  CloudFile out;
  out.path = value.at("file").get<std::string>();
  out.of_scene_file = true;
  std::vector<std::string> parts{"0", "0", "0"};
  if (value.contains("position")) {
    const json& place = value.at("position");
    if (!place.is_array() || place.size() != 3) return wrong("position", "[X, Y, Z] in blocks");
    for (std::size_t i = 0; i < 3; ++i) {
      const Result<std::string> part = coordinate(place[i]);
      if (!part) return part.error();
      parts[i] = *part;
    }
  }
  if (value.contains("scale")) {
    if (!value.at("scale").is_number()) return wrong("scale", "a number");
    parts.push_back(fmt::format("{}", value.at("scale").get<double>()));
  }
  if (Result<void> read = read_place(parts, out); !read) return read.error();
  return out;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

render::CloudVolumeDesc volume_of(const world::VolumeGrid& grid, const CloudFile& file) {
  render::CloudVolumeDesc out;
  out.origin = {file.position.x, file.position.y, file.position.z};
  glm::dmat4 scaled(file.scale);
  scaled[3][3] = 1.0;
  out.blocks_from_index = scaled * grid.world_from_index;
  out.role = cloud_role(grid.name);
  const auto place = [](const world::IVec3& p) { return glm::ivec3(p.x, p.y, p.z); };
  for (const world::VolumeBrick& brick : grid.bricks)
    out.bricks.push_back({place(brick.origin), brick.values.data()});
  for (const world::VolumeTile& tile : grid.tiles)
    out.tiles.push_back({place(tile.origin), tile.edge, tile.value});
  return out;
}

}  // namespace

Result<CloudFile> parse_cloud(std::string_view text) {
  CloudFile out;
  const std::size_t at = text.rfind('@');
  const bool placed = at != std::string_view::npos && looks_like_numbers(text.substr(at + 1));
  out.path = text.substr(0, placed ? at : text.size());
  if (out.path.empty()) return Error{"the cloud has no file: give FILE.vdb[@X,Y,Z[,SCALE]]"};
  if (!placed) return out;
  const std::vector<std::string> parts = split(text.substr(at + 1), ',');
  if (parts.size() != 3 && parts.size() != 4)
    return Error{fmt::format("the cloud's place cannot be {}: give X,Y,Z or X,Y,Z,SCALE",
                             quote_text(text.substr(at + 1)))};
  if (Result<void> read = read_place(parts, out); !read) return read.error();
  return out;
}

std::string format_cloud(const CloudFile& cloud) {
  return fmt::format("{}@{},{},{},{}", cloud.path, format_blocks(cloud.position.x),
                     format_blocks(cloud.position.y), format_blocks(cloud.position.z), cloud.scale);
}

Result<std::vector<CloudFile>> read_clouds(const json& value) {
  if (!value.is_array()) return Error{"the scene's field 'clouds' is wrong: give a list of clouds"};
  std::vector<CloudFile> out;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Result<CloudFile> cloud = read_cloud(value[i]);
    if (!cloud) return Error{fmt::format("the scene's cloud {}: {}", i + 1, cloud.error().message)};
    out.push_back(*cloud);
  }
  return out;
}

void find_beside(const std::string& scene_file, std::vector<CloudFile>& clouds) {
  for (CloudFile& cloud : clouds) cloud.path = file_of_scene(scene_file, cloud.path);
}

render::CloudRole cloud_role(std::string_view grid_name) {
  const std::string name = lower_case(grid_name);
  for (const std::string_view hot : {"temperature", "heat", "flame"})
    if (name.find(hot) != std::string::npos) return render::CloudRole::kEmission;
  return render::CloudRole::kDensity;
}

std::vector<std::size_t> drawn_grids(std::span<const std::string> names) {
  const auto named_density = [](const std::string& name) {
    return lower_case(name).find("density") != std::string::npos;
  };
  const bool named = std::any_of(names.begin(), names.end(), named_density);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!named || named_density(names[i]) || cloud_role(names[i]) == render::CloudRole::kEmission)
      out.push_back(i);
  return out;
}

Result<LoadedClouds> load_clouds(std::span<const CloudFile> files) {
  LoadedClouds out;
  for (const CloudFile& file : files) {
    Result<std::vector<world::VolumeGrid>> grids = world::read_volumes(file.path);
    if (!grids) return grids.error();
    out.grids.push_back(std::make_unique<std::vector<world::VolumeGrid>>(*std::move(grids)));
    std::vector<const world::VolumeGrid*> fog;
    std::vector<std::string> names;
    for (const world::VolumeGrid& grid : *out.grids.back()) {
      if (grid.kind != world::VolumeKind::kFog) continue;
      fog.push_back(&grid);
      names.push_back(grid.name);
    }
    if (fog.empty())
      return Error{
          fmt::format("cannot draw {} as a cloud: it holds no fog volume; open solid "
                      "volumes with --world",
                      quote_text(file.path))};
    const std::vector<std::size_t> drawn = drawn_grids(names);
    for (const std::size_t i : drawn) out.volumes.push_back(volume_of(*fog[i], file));
    if (drawn.size() == fog.size()) continue;
    out.remarks.push_back(
        fmt::format("{} of the {} fog grids of {} are not drawn: it has density, and they are "
                    "neither density nor heat",
                    fog.size() - drawn.size(), fog.size(), quote_text(file.path)));
  }
  return out;
}

}  // namespace skerry::game
