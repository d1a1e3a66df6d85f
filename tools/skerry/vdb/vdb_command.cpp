#include "tools/skerry/vdb/vdb_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <string_view>
#include <utility>
#include <vector>

#include "game/scene_file/parse.h"
#include "game/scene_file/vdb_options.h"
#include "game/worlds/file_sum.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/vdb/vdb_info.h"
#include "tools/skerry/vdb/vdb_transfer.h"

namespace skerry::tools {
namespace {

using Typed = std::pair<const char*, std::optional<std::string>>;

Result<world::ImportOptions> import_options(const std::vector<Typed>& typed) {
  world::ImportOptions out;
  for (const auto& [key, value] : typed) {
    if (!value) continue;
    const auto set = game::set_import(key, *value, fmt::format("--{}", key), out);
    if (!set) return set.error();
  }
  return out;
}

Result<world::BlockBox> parse_box(const std::string& text) {
  const std::vector<std::string> parts = game::split(text, ',');
  if (parts.size() != 6)
    return Error{fmt::format("--box has {} parts: give X0,Y0,Z0,X1,Y1,Z1", parts.size())};
  world::BlockBox box;
  for (std::size_t i = 0; i < 6; ++i) {
    const Result<std::int64_t> value =
        game::parse_integer(parts[i], "--box", -world::kMaxBlock, world::kMaxBlock);
    if (!value) return value.error();
    (i < 3 ? box.low[i] : box.high[i - 3]) = *value;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.low[axis] >= box.high[axis])
      return Error{"--box is empty: X1, Y1 and Z1 must be above X0, Y0 and Z0"};
  return box;
}

}  // namespace

VdbCommand::VdbCommand(CLI::App& app)
    : vdb_(app.add_subcommand("vdb", "Look into, import and export OpenVDB files")) {
  vdb_->allow_extras();
  vdb_->footer("");
  info_ = add("info", "Tell what a .vdb file holds and what Skerry does with it");
  info_->add_option("file", file_, "The file")->type_name("FILE.vdb")->required();
  info_->add_flag("--json", json_, "As JSON");
  add_expect(*info_);
  add_import();
  add_export();
}

CLI::App* VdbCommand::add(const char* name, const char* description) {
  CLI::App* command = vdb_->add_subcommand(name, description);
  command->allow_extras();
  command->footer("");
  return command;
}

void VdbCommand::add_expect(CLI::App& command) {
  command.add_option("--expect", expect_, "Read the file only if this is its SHA-256")
      ->type_name("SHA256");
}

void VdbCommand::add_import() {
  import_ = add("import", "Make a world of a .vdb file (docs/openvdb.md)");
  import_->add_option("file", file_, "The file")->type_name("FILE.vdb")->required();
  import_->add_option("--out", out_, "Where the world goes")->type_name("WORLD")->required();
  import_->add_option("--grid", grid_, "Only the grid of this name (default: see vdb info)")
      ->type_name("NAME");
  import_->add_option("--scale", scale_, "Blocks along a voxel's edge (default 1)")
      ->type_name("BLOCKS");
  import_->add_option("--size", size_, "Blocks along the longest side of it all")
      ->type_name("BLOCKS");
  import_
      ->add_option(
          "--threshold", threshold_,
          "Fog is solid from this density on (default: half the mean of what is not empty); a "
          "level set below this distance (default 0)")
      ->type_name("VALUE");
  import_->add_option("--up", up_, "Which axis of the file points up (default y)")
      ->type_name("y|z");
  import_->add_flag("--json", json_, "Print the outcome as JSON");
  add_expect(*import_);
}

void VdbCommand::add_export() {
  export_ = add("export", "Write islands as block ids and density");
  export_->add_option("--seed", seed_, "World seed: a number or any text");
  export_->add_option("--world", world_, "Saved world or .vdb file; excludes --seed")
      ->type_name("PATH");
  export_
      ->add_option("--box", box_,
                   "Blocks of the world, the upper ones not included (default: all islands of a "
                   "world without a seed)")
      ->type_name("X0,Y0,Z0,X1,Y1,Z1");
  export_->add_option("--out", out_, "Where the volumes go")->type_name("FILE.vdb")->required();
  export_->add_flag("--partial", partial_, "Export what is left of a damaged world");
}

int VdbCommand::run() {
  if (vdb_->get_subcommands().empty()) return refuse_unknown();
  const CLI::App* chosen = vdb_->get_subcommands().front();
  if (const auto refusal = check_leftovers(*vdb_)) return refuse(*refusal);
  if (const auto refusal = check_leftovers(*chosen)) return refuse(*refusal);
  if (const auto refusal = check_output(out_)) return refuse(*refusal);
  if (chosen == info_) return run_info();
  return chosen == import_ ? run_import() : run_export();
}

int VdbCommand::run_info() {
  if (!expect_) return vdb_info(file_, json_);
  const Result<std::string> sum = game::parse_sha256(*expect_, "--expect");
  if (!sum) return fail(kUsage, sum.error());
  if (const Result<void> same = game::check_sum(file_, *sum); !same)
    return fail(kFailed, same.error());
  return vdb_info(file_, json_);
}

int VdbCommand::run_import() {
  const Result<world::ImportOptions> how = import_options({{"grid", grid_},
                                                           {"scale", scale_},
                                                           {"size", size_},
                                                           {"threshold", threshold_},
                                                           {"up", up_},
                                                           {"expect", expect_}});
  if (!how) return fail(kUsage, how.error());
  return vdb_import({file_, *out_, *how, json_});
}

int VdbCommand::run_export() {
  if (seed_ && world_) return fail(kUsage, {"--seed and --world exclude each other: give one"});
  if (!seed_ && !world_)
    return fail(kUsage, {"there is nothing to export: give --seed N or --world PATH"});
  VdbExportOptions options;
  if (seed_) options.seed_text = *seed_;
  options.world = world_;
  options.out = *out_;
  options.partial = partial_;
  if (box_) {
    const Result<world::BlockBox> box = parse_box(*box_);
    if (!box) return fail(kUsage, box.error());
    options.box = *box;
  }
  return vdb_export(options);
}

int VdbCommand::refuse_unknown() const {
  constexpr std::string_view kNames[] = {"info", "import", "export"};
  const std::vector<std::string> leftovers = vdb_->remaining();
  if (leftovers.empty())
    return fail(kUsage, {"vdb does not say what: give info, import or export"});
  return fail(kUsage, {fmt::format("there is no vdb {}: did you mean '{}'? See skerry vdb --help",
                                   game::quote_text(leftovers.front()),
                                   game::nearest_name(leftovers.front(), kNames))});
}

}  // namespace skerry::tools
