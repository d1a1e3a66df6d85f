#include "tools/skerry/bench/bench_commands.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <string_view>

#include "game/scene_file/parse.h"
#include "tools/skerry/bench/bench_cull.h"
#include "tools/skerry/bench/bench_device.h"
#include "tools/skerry/bench/bench_edit.h"
#include "tools/skerry/bench/bench_flicker.h"
#include "tools/skerry/bench/bench_fly.h"
#include "tools/skerry/bench/bench_frame.h"
#include "tools/skerry/bench/bench_generate.h"
#include "tools/skerry/bench/bench_lights.h"
#include "tools/skerry/bench/bench_mesh.h"
#include "tools/skerry/bench/bench_pops.h"
#include "tools/skerry/bench/bench_shade.h"
#include "tools/skerry/bench/bench_upload.h"
#include "tools/skerry/bench/bench_world.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

std::optional<std::filesystem::path> path_of(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  return *text;
}

}  // namespace

BenchCommands::BenchCommands(CLI::App& app)
    : bench_(app.add_subcommand("bench", "Measure how fast a part of the program is")) {
  bench_->allow_extras();
  bench_->footer("");
  mesh_ = add("mesh", "Time the mesher");
  mesh_->add_option("--input", input_, "Folder of .bin voxel sets (default: chunks of seed 1)")
      ->type_name("DIR");
  generate_ = add("generate", "Time the world generator");
  world_ = add("world", "Time saving, breaking and moving islands");
  upload_ = add("upload", "Time the three ways of sending data to the GPU");
  add_device_options(*upload_);
  cull_ = add("cull", "Time culling on the GPU");
  add_device_options(*cull_);
  costs_ = add("device", "Time loads, branches, loops, textures, quads and passes on the GPU");
  add_device_options(*costs_);
  lights_ = add("lights", "Time sorting and shading of 64 to 16,384 lights in a scene");
  add_scene_options(*lights_, scene_);
  shade_ =
      add("shade", "Compare the light that stays on surfaces with the reference, in 14 scenes");
  add_scene_options(*shade_, scene_);
  shade_->add_option("--only", only_, "These of the scenes")->type_name("NAME");
  frame_ = add("frame", "Time whole frames of a scene with a slowly turning camera");
  add_scene_options(*frame_, scene_);
  frame_
      ->add_option("--clock", clock_rate_,
                   "Seconds of the day that pass in one, as 24 in play (default 0)")
      ->check(CLI::Range(0.0, 86400.0));
  flicker_ = add(
      "flicker",
      "Measure how much of the picture flickers in a turn, a walk, a drift, the way of the sun");
  add_scene_options(*flicker_, scene_);
  flicker_->add_option("--frames", frames_, "Frames of each motion (default 120)")
      ->check(CLI::Range(2, 10000));
  pops_ = add("pops", "Measure how much of the picture changes of level move, in a flight");
  add_scene_options(*pops_, scene_);
  pops_->add_option("--frames", frames_, "Frames of the flight (default 600)")
      ->check(CLI::Range(2, 100000));
  pops_->add_option("--speed", speed_, "Blocks a second, of 60 frames (default 48)")
      ->check(CLI::Range(1.0, 10000.0));
  edit_ = add("edit", "Time from an edit to the first picture that shows it");
  add_scene_options(*edit_, scene_);
  fly_ = add("fly", "Time every frame of a flight through islands not seen before");
  add_scene_options(*fly_, scene_);
  fly_->add_option("--speed", speed_, "Blocks a second (default 48)")
      ->check(CLI::Range(1.0, 10000.0));
  fly_->add_option("--seconds", seconds_, "How long (default 60)")->check(CLI::Range(1.0, 3600.0));
  start_ = add("start", "Time from the start until a world can be played");
  add_scene_options(*start_, scene_);
}

CLI::App* BenchCommands::add(const char* name, const char* description) {
  CLI::App* command = bench_->add_subcommand(name, description);
  command->allow_extras();
  command->footer("");
  command->add_option("--json", json_, "Write the rows as JSON")->type_name("FILE");
  return command;
}

void BenchCommands::add_device_options(CLI::App& command) {
  command.add_option("--device", device_, "Vulkan device, as 'skerry devices' counts")
      ->type_name("N");
  command.add_flag("--validate", validate_, "Turn the Vulkan validation layer on");
}

int BenchCommands::run() {
  if (bench_->get_subcommands().empty()) return refuse_unknown();
  const CLI::App* chosen = bench_->get_subcommands().front();
  if (const auto refusal = check_leftovers(*bench_)) return refuse(*refusal);
  if (const auto refusal = check_leftovers(*chosen)) return refuse(*refusal);
  if (chosen == lights_) return run_lights();
  if (chosen == shade_) return run_shade();
  if (chosen == frame_) return run_frame();
  if (chosen == flicker_) return run_flicker();
  if (chosen == pops_) return run_pops();
  if (chosen == edit_) return run_edit();
  if (chosen == fly_ || chosen == start_) return run_flight(*chosen);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  if (chosen == mesh_) return run_mesh();
  if (chosen == generate_) return bench_generate({path_of(json_)});
  if (chosen == world_) return bench_world({path_of(json_)});
  return run_on_device(*chosen);
}

int BenchCommands::refuse_unknown() const {
  constexpr std::string_view kNames[] = {"mesh",   "generate", "world", "upload", "cull",
                                         "device", "lights",   "shade", "frame",  "flicker",
                                         "pops",   "edit",     "fly",   "start"};
  const std::vector<std::string> leftovers = bench_->remaining();
  if (leftovers.empty()) {
    return fail(
        kUsage,
        {"bench does not say what: give mesh, generate, world, upload, cull, device, lights, "
         "shade, frame, flicker, pops, edit, fly or start"});
  }
  return fail(kUsage,
              {fmt::format("there is no bench {}: did you mean '{}'? See skerry bench --help",
                           game::quote_text(leftovers.front()),
                           game::nearest_name(leftovers.front(), kNames))});
}

int BenchCommands::run_mesh() {
  if (input_ && !std::filesystem::is_directory(*input_)) {
    return fail(kFailed, {fmt::format("cannot read the voxel sets in {}: it is no folder; give the "
                                      "folder that bench/mesh/gen.cpp filled",
                                      game::quote_text(*input_))});
  }
  return bench_mesh({path_of(input_), path_of(json_)});
}

int BenchCommands::run_on_device(const CLI::App& chosen) {
  std::optional<std::uint32_t> device;
  if (const auto refusal = parse_device(device_, device)) return refuse(*refusal);
  if (&chosen == upload_) return bench_upload({device, validate_, path_of(json_)});
  if (&chosen == costs_) return bench_device({device, validate_, path_of(json_)});
  return bench_cull({device, validate_, path_of(json_)});
}

int BenchCommands::run_lights() {
  BenchLightsOptions options;
  if (const auto refusal = resolve(scene_, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  options.json = path_of(json_);
  return bench_lights(options);
}

int BenchCommands::run_shade() {
  game::SceneOptions resolved;
  if (const auto refusal = resolve(scene_, false, resolved)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(resolved)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  return bench_shade({scene_.text, only_, resolved.device, path_of(json_)});
}

int BenchCommands::run_frame() {
  BenchFrameOptions options;
  if (const auto refusal = resolve(scene_, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  options.json = path_of(json_);
  options.clock_rate = clock_rate_;
  return bench_frame(options);
}

int BenchCommands::run_flicker() {
  BenchFlickerOptions options;
  if (const auto refusal = resolve(scene_, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  options.frames = frames_;
  options.json = path_of(json_);
  return bench_flicker(options);
}

int BenchCommands::run_pops() {
  BenchPopsOptions options;
  if (const auto refusal = resolve(scene_, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  options.frames = frames_;
  options.speed = speed_;
  options.json = path_of(json_);
  return bench_pops(options);
}

int BenchCommands::run_edit() {
  BenchEditOptions options;
  if (const auto refusal = resolve(scene_, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  options.json = path_of(json_);
  return bench_edit(options);
}

int BenchCommands::run_flight(const CLI::App& chosen) {
  BenchFlyOptions options;
  if (const auto refusal = resolve(scene_, true, options.scene)) return refuse(*refusal);
  if (const auto refusal = check_draws_frames(options.scene)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  options.speed = speed_;
  options.seconds = seconds_;
  options.json = path_of(json_);
  return &chosen == fly_ ? bench_fly(options) : bench_start(options);
}

}  // namespace skerry::tools
