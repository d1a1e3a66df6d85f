// The scenes a test is asked to judge: found, read, checked and split before anything is drawn.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/options.h"
#include "tools/skerry/compare/baseline.h"

namespace skerry::tools {

/// One scene file.
struct TestScene {
  std::string name;  ///< the file's, without its ending
  std::filesystem::path file;
  game::SceneOptions scene;
  game::Expectations expected;

  std::optional<std::filesystem::path> baseline;  ///< folder with a folder a driver
  std::optional<Unpacked> unpacked;               ///< if that is from an archive

  /// The folder of what is approved for a driver: the baseline's, else the scene's, which is the
  /// same for all drivers.
  std::filesystem::path approved(std::string_view driver) const;
  /// The reference picture in it.
  std::filesystem::path reference(std::string_view driver) const;
  /// Errors name the archive if it is from one.
  Result<platform::PngImage> read_reference(std::string_view driver) const;
};

/// Part `index` (from 1) of `count`.
struct Shard {
  std::size_t index = 1, count = 1;
  bool operator==(const Shard&) const = default;
};

/// "I/N". Errors: not that, or not 1 <= I <= N <= 10000.
Result<Shard> parse_shard(std::string_view text);

/// The scene files that paths name: files, and the *.json in folders (not below them). Sorted by
/// name, each once. Errors: no such path, no scene at all, two files of one name.
Result<std::vector<std::filesystem::path>> find_scenes(std::span<const std::string> paths);

/// Reads and checks one scene. Errors name the file.
Result<TestScene> read_scene(const std::filesystem::path& file);

/// Every count-th of the scenes, from the index-th on.
std::vector<TestScene> shard_of(std::vector<TestScene> scenes, const Shard& shard);

}  // namespace skerry::tools
