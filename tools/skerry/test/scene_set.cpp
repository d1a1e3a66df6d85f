#include "tools/skerry/test/scene_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/core/check.h"
#include "engine/platform/files.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxShards = 10000;

/// Adds a file, or the scenes of a folder.
Result<void> add_path(const std::string& text, std::vector<fs::path>& files) {
  std::error_code code;
  const fs::file_status status = fs::status(text, code);
  if (!fs::exists(status)) {
    return Error{fmt::format("cannot test {}: it does not exist; give scene files or folders",
                             game::quote_text(text))};
  }
  if (!fs::is_directory(status)) {
    files.emplace_back(text);
    return {};
  }
  for (fs::directory_iterator at(text, code), end; !code && at != end; at.increment(code)) {
    if (at->path().extension() == ".json" && !at->is_directory()) files.push_back(at->path());
  }
  if (!code) return {};
  return Error{fmt::format("cannot read the folder {}: {}; give one you may read",
                           game::quote_text(text), code.message())};
}

}  // namespace

fs::path TestScene::approved(std::string_view driver) const {
  return baseline ? *baseline / driver : file.parent_path();
}

fs::path TestScene::reference(std::string_view driver) const {
  return approved(driver) / file.filename().replace_extension(".png");
}

Result<platform::PngImage> TestScene::read_reference(std::string_view driver) const {
  const fs::path picture = reference(driver);
  if (!unpacked) return platform::read_png(picture);
  const Result<std::string> bytes = platform::read_text(picture, platform::kMaxPngFileBytes);
  if (!bytes)
    return Error{
        fmt::format("cannot read {}: it is no file of at most {} bytes; take it out "
                    "(tar --delete) and run skerry test --approve",
                    known_as(picture, unpacked), platform::kMaxPngFileBytes)};
  return platform::decode_png(*bytes, known_as(picture, unpacked));
}

Result<Shard> parse_shard(std::string_view text) {
  const std::vector<std::string> parts = game::split(text, '/');
  if (parts.size() != 2) {
    return Error{
        fmt::format("--shard cannot be {}: give I/N, such as 1/4", game::quote_text(text))};
  }
  const auto count = game::parse_integer(parts[1], "the number of shards", 1, kMaxShards);
  if (!count) return count.error();
  const auto index = game::parse_integer(parts[0], "the shard", 1, *count);
  if (!index) return index.error();
  return Shard{static_cast<std::size_t>(*index), static_cast<std::size_t>(*count)};
}

Result<std::vector<fs::path>> find_scenes(std::span<const std::string> paths) {
  std::vector<fs::path> files;
  for (const std::string& path : paths) {
    if (const Result<void> added = add_path(path, files); !added) return added.error();
  }
  if (files.empty()) {
    return Error{"there is no scene to test: the folders hold no *.json; give others"};
  }
  std::map<std::string, fs::path> by_name;
  std::error_code code;
  for (const fs::path& file : files) {
    const auto [entry, fresh] = by_name.try_emplace(file.stem().string(), file);
    if (fresh || fs::equivalent(entry->second, file, code)) continue;
    return Error{fmt::format(
        "two scenes are called {}: rename one of {} and {}", game::quote_text(entry->first),
        game::quote_text(entry->second.string()), game::quote_text(file.string()))};
  }
  std::vector<fs::path> sorted;
  for (const auto& [name, file] : by_name) sorted.push_back(file);
  return sorted;
}

Result<TestScene> read_scene(const fs::path& file) {
  const Result<std::string> text = platform::read_text(file, game::kMaxSceneBytes);
  if (!text) return text.error();
  const auto wrong = [&file](const Error& why) {
    return Error{fmt::format("cannot use {}: {}", game::quote_text(file.string()), why.message)};
  };
  Result<game::SceneText> parsed = game::parse_scene(*text);
  if (!parsed) return wrong(parsed.error());
  game::find_world_beside(file.string(), *parsed);
  game::find_ambient_beside(file.string(), *parsed);
  game::find_beside(file.string(), parsed->clouds);
  Result<game::SceneOptions> scene = game::make_scene(*parsed, {});
  if (!scene) return wrong(scene.error());
  const Result<void> checked = game::check_expectations(parsed->expectations, scene->size);
  if (!checked) return wrong(checked.error());
  return TestScene{file.stem().string(), file, *std::move(scene), parsed->expectations, {}, {}};
}

std::vector<TestScene> shard_of(std::vector<TestScene> scenes, const Shard& shard) {
  SKERRY_ASSERT(shard.index >= 1 && shard.index <= shard.count);
  std::vector<TestScene> part;
  for (std::size_t i = shard.index - 1; i < scenes.size(); i += shard.count)
    part.push_back(std::move(scenes[i]));
  return part;
}

}  // namespace skerry::tools
