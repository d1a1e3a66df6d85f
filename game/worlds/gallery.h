// Pictures that the player took, and the way back into them.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/options.h"
#include "world/voxel/island.h"

namespace skerry::game {

inline constexpr std::size_t kMaxCommandBytes = 1 << 16;

/// The words of a shell command as shell_word() writes them: plain ones, parts in single quotes,
/// and characters behind a backslash. Errors: a quote or a backslash without an end.
Result<std::vector<std::string>> shell_words(std::string_view command);

/// Where a picture was taken, of the command that draws it (shot_command): its world, camera, time
/// and view, the settings of world and sky, clouds. How it was drawn is left to the player's own
/// settings. Errors: no such command, an option or a value that it does not have.
Result<SceneText> place_of_command(std::string_view command);

/// The same of what a picture has stored, checked. Errors: those of place_of_command and
/// make_scene.
Result<SceneOptions> place_of_picture(std::span<const platform::PngText> text);
/// What is played, moved to another place; how it is drawn stays.
SceneOptions at_place(const SceneOptions& played, const SceneOptions& place);

/// Where a picture was taken as seen from the island that the player was on: in a world that goes
/// on, islands drift away from the camera of the command, and can be steered and turned.
struct IslandView {
  std::uint64_t island = 0;
  CameraPlace eye;  ///< in the island's frame
};
IslandView seen_from(std::uint64_t island, const world::Pose& pose, const CameraPlace& eye);
/// The inverse, wherever the island is now.
CameraPlace seen_in_world(const IslandView& view, const world::Pose& pose);
/// The text that a picture keeps of it, besides its command.
platform::PngText text_of(const IslandView& view);
/// None: the picture has no such text, or another one.
std::optional<IslandView> island_view_of(std::span<const platform::PngText> text);

/// Screenshots in the player's folder, newest first. A folder that is not there has none.
std::vector<std::filesystem::path> list_pictures(const std::filesystem::path& folder);
/// Where screenshots are; empty if there is no folder for data.
std::filesystem::path pictures_dir();

}  // namespace skerry::game
