// The command line: options shared by sub-commands, and usage errors that name what was probably
// meant.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/options.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// Why a command cannot start, with its exit status.
struct Refusal {
  int status = 0;
  Error error;
};

Refusal usage(Error error);          ///< of a command line that asks for what cannot be
int refuse(const Refusal& refusal);  ///< Reports it. @return the exit status.

/// Options of every command that draws a scene, as typed.
struct SceneArguments {
  game::SceneText text;
  std::vector<std::string> clouds;
  std::optional<std::string> scene_file, device, renderer, shading;
  bool validate = false;
  game::SceneText usual;  ///< below everything typed; a scene file is taken in its place
};

void add_scene_options(CLI::App& command, SceneArguments& arguments);

/// Reads the scene file, checks every value. @param needs_source a seed, world or scene must be
/// given.
std::optional<Refusal> resolve(const SceneArguments& arguments, bool needs_source,
                               game::SceneOptions& scene);

/// Takes quality `auto`, which play alone has, out of what was typed and what is usual, and drops
/// usual settings that are changes of another level. @return whether it was typed.
bool take_auto(SceneArguments& arguments);

/// Checks that a command's frames can be drawn: the reference renderer draws screenshots only.
std::optional<Refusal> check_draws_frames(const game::SceneOptions& scene);
/// Reads --device, if given, into `index`.
std::optional<Refusal> parse_device(const std::optional<std::string>& text,
                                    std::optional<std::uint32_t>& index);

/// Rejects unknown arguments of a command; names the nearest option.
std::optional<Refusal> check_leftovers(const CLI::App& command);

/// Checks early that a file can be written, so that no work is done in vain.
std::optional<Refusal> check_output(const std::optional<std::string>& path);

}  // namespace skerry::tools
