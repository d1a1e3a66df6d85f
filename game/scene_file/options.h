// What a command was asked to do, checked, as plain values.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/cloud_files.h"
#include "game/scene_file/expectations.h"
#include "game/scene_file/parse.h"
#include "game/scene_file/scene_contents.h"
#include "game/scene_file/settings.h"
#include "world/vdb_import/import.h"

namespace skerry::game {

/// In place of a panorama: the sky of the air.
inline constexpr std::string_view kAmbientSky = "sky";

/// A picture to be drawn: shared by shot, play and bench frame.
struct SceneOptions {
  std::string seed_text = "1";        ///< world::seed_from_text makes the seed
  std::optional<std::string> world;   ///< a file in place of a seed (open_world.h)
  world::ImportOptions import;        ///< of a .vdb file as the world
  std::optional<CameraPlace> camera;  ///< none: the seed's spawn view
  double fov_deg = 70.0;              ///< vertical, 0.1 .. 175
  int time_of_day_s = 12 * 3600;      ///< since midnight
  PictureSize size;
  Quality quality = Quality::kMedium;
  bool quality_named = false;  ///< it was asked for, not taken for want of a name
  bool quality_auto = false;   ///< play chooses it, and what hangs on it (game/pace)
  Settings settings;
  std::vector<std::string> assigned;      ///< KEY=VALUE that were asked for, later ones win
  std::vector<std::string> pinned;        ///< those of them that quality_auto must keep
  std::vector<WorldLight> lights;         ///< of the scene file
  std::vector<BlockBox> blocks;           ///< of the scene file, later ones win
  std::vector<CloudFile> clouds;          ///< of the scene file, then of the command line
  std::optional<std::string> ambient;     ///< file of a panorama that is the sky, or kAmbientSky
  std::optional<std::string> scene_file;  ///< where lights and blocks are from
  std::optional<std::uint32_t> device;    ///< none: the best
  bool validate = false;
};

/// One optional text a field, as typed on the command line or read from a scene file.
struct SceneText {
  std::optional<std::string> seed, world, camera, fov, time, size, quality, ambient;
  std::vector<std::string> settings;  ///< KEY=VALUE, later ones win
  std::vector<std::string> import;    ///< KEY=VALUE (vdb_options.h), later ones win
  std::vector<WorldLight> lights;     ///< of a scene file
  std::vector<BlockBox> blocks;       ///< likewise
  std::vector<CloudFile> clouds;
  Expectations expectations;  ///< of a scene file; no concern of make_scene
};

/// The longest scene file worth reading.
inline constexpr std::uint64_t kMaxSceneBytes = 1 << 20;

/// Reads a scene: a JSON object with the fields seed, world, camera (five numbers or strings), fov,
/// time, size, quality, ambient, settings and import (objects), lights (read_lights), blocks
/// (read_blocks), clouds (read_clouds) and those of Expectations. Errors: no JSON, an unknown field
/// (names the nearest), a value of the wrong kind. Values are checked by make_scene, but for lights
/// and blocks; masks and regions by check_expectations.
Result<SceneText> parse_scene(std::string_view json_text);

/// Finds the world that a scene file names, as file_of_scene (scene_files.h) has it.
void find_world_beside(const std::string& scene_file, SceneText& scene);
/// The same for a panorama.
void find_ambient_beside(const std::string& scene_file, SceneText& scene);

/// Checks and converts. Fields of `over` win over those of `under`; settings of `under` are applied
/// first. A seed and a world exclude each other. What `under` imports goes with its world.
Result<SceneOptions> make_scene(const SceneText& under, const SceneText& over);

/// A word of a command line: in single quotes unless every character is harmless to a shell.
std::string shell_word(std::string_view text);

/// The command that draws this scene again, quoted for a shell. Without a camera it names none: the
/// seed's spawn view is the default. Lights and blocks are named by the scene file that they are
/// from.
std::string shot_command(const SceneOptions& scene);

}  // namespace skerry::game
