#include "tools/skerry/command_line.h"

#include <fmt/format.h>
#include <skerry_version.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string_view>

#include "engine/core/log.h"
#include "game/client/preferences.h"
#include "game/pace/quality_front.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/bench/bench_commands.h"
#include "tools/skerry/devices.h"
#include "tools/skerry/farm/farm_command.h"
#include "tools/skerry/play_command.h"
#include "tools/skerry/report/report_command.h"
#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/shot/shot.h"
#include "tools/skerry/stability/command.h"
#include "tools/skerry/test/test_command.h"
#include "tools/skerry/vdb/vdb_command.h"

namespace skerry::tools {
namespace {

/// The sub-commands and what was typed for them.
struct CommandLine {
  CLI::App app{"Skerry: islands of voxels in the air, lit by a real sun.", "skerry"};
  CLI::App* play = nullptr;
  CLI::App* shot = nullptr;
  CLI::App* devices = nullptr;
  SceneArguments scene;
  std::string out = "skerry.png";
  std::optional<std::string> stats;
  bool explain = false;
  bool json = false;
  std::optional<BenchCommands> bench;
  std::optional<ReportCommand> report;
  std::vector<std::string> typed;  ///< all arguments, the command first
  std::optional<TestCommand> test;
  std::optional<StabilityCommand> stability;
  std::optional<FarmCommand> farm;
  std::optional<VdbCommand> vdb;

  CommandLine();
  int run();

 private:
  CLI::App* add(const char* name, const char* description);
  int run_play();
  int run_shot();
};

CommandLine::CommandLine() {
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("skerry ") + kSkerryVersion,
                       "Print the version and exit");
  app.footer("Without a command, skerry plays. 'skerry COMMAND --help' tells more.");
  play = add("play", "Walk and fly through a world in a window (docs/controls.md)");
  add_scene_options(*play, scene);
  shot = add("shot", "Draw one picture");
  add_scene_options(*shot, scene);
  shot->add_option("--out", out, "Where the picture goes (default skerry.png)")
      ->type_name("FILE.png");
  shot->add_option("--stats", stats, "Write counts, times and a hash of the picture")
      ->type_name("FILE.json");
  shot->add_flag("--explain", explain, "Print what the frame ran, and what it left out and why");
  report.emplace(app);
  test.emplace(app);
  bench.emplace(app);
  stability.emplace(app);
  farm.emplace(app);
  vdb.emplace(app);
  devices = add("devices", "List the Vulkan devices");
  devices->add_flag("--json", json, "As JSON");
}

CLI::App* CommandLine::add(const char* name, const char* description) {
  CLI::App* command = app.add_subcommand(name, description);
  command->allow_extras();  // check_leftovers says what was meant
  command->footer("");      // not the one of all commands
  return command;
}

int CommandLine::run_play() {
  game::ReadPreferences read = game::load_preferences(game::preferences_path());
  for (const std::string& problem : read.problems) log_warning(problem);
  scene.usual = std::move(read.scene);
  const bool asked_auto = take_auto(scene);
  game::SceneOptions options;
  if (const auto refusal = resolve(scene, false, options)) return refuse(*refusal);
  options.quality_auto = asked_auto || !options.quality_named;
  options.pinned = game::pins_among(options.assigned);
  if (const auto refusal = check_draws_frames(options)) return refuse(*refusal);
  const bool asked_for =
      scene.text.seed || scene.text.world || scene.text.camera || scene.scene_file;
  return play_command(options, !asked_for, read.problems);
}

int CommandLine::run_shot() {
  ShotOptions options;
  if (const auto refusal = resolve(scene, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(out)) return refuse(*refusal);
  if (const auto refusal = check_output(stats)) return refuse(*refusal);
  options.out = out;
  if (stats) options.stats = *stats;
  options.explain = explain;
  return tools::shot(options);
}

int CommandLine::run() {
  const CLI::App* chosen = app.get_subcommands().front();
  if (chosen == bench->command()) return bench->run();
  if (chosen == report->command()) return report->run(typed);
  if (chosen == test->command()) return test->run(typed);
  if (chosen == stability->command()) return stability->run(typed);
  if (chosen == farm->command()) return farm->run();
  if (chosen == vdb->command()) return vdb->run();
  if (const auto refusal = check_leftovers(*chosen)) return refuse(*refusal);
  if (chosen == play) return run_play();
  if (chosen == shot) return run_shot();
  return tools::devices(json);
}

/// The first argument names a command, or is left out for play.
Result<std::vector<std::string>> with_command(const CLI::App& app,
                                              std::vector<std::string> arguments) {
  const std::string first = arguments.empty() ? "" : arguments.front();
  if (first == "-h" || first == "--help" || first == "--version") return arguments;
  if (first.empty() || first.starts_with("-")) {
    arguments.insert(arguments.begin(), "play");
    return arguments;
  }
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), first) != names.end()) return arguments;
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  return Error{fmt::format("there is no command {}: did you mean '{}'? See skerry --help",
                           game::quote_text(first), game::nearest_name(first, candidates))};
}

}  // namespace

int run_command_line(std::vector<std::string> typed) {
  CommandLine line;
  Result<std::vector<std::string>> arguments = with_command(line.app, std::move(typed));
  if (!arguments) return fail(kUsage, arguments.error());
  line.typed = *arguments;
  std::reverse(arguments->begin(), arguments->end());  // as CLI11 wants it
  try {
    line.app.parse(*arguments);
  } catch (const CLI::Success& asked) {  // for help, or the version
    return line.app.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    return fail(kUsage, {what + "; see skerry --help"});
  }
  return line.run();
}

}  // namespace skerry::tools
