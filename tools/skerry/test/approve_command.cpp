#include "tools/skerry/test/approve_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "engine/core/log.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/test/decisions.h"

namespace skerry::tools {

ApproveCommand::ApproveCommand(CLI::App& test)
    : approve_(test.add_subcommand("approve", "Apply decisions that the page of a test saved")) {
  approve_->allow_extras();
  approve_->footer("");
  approve_->add_option("DECISIONS", file_, "File that the page saved")
      ->type_name("FILE")
      ->required();
  approve_->add_option("SCENES", paths_, "Scene files, or folders of them, as they were judged");
  approve_
      ->add_option("--report", report_,
                   "Folder of the page; needed for pictures that it had no room for")
      ->type_name("DIR");
  approve_->add_option("--baseline", baseline_, "As the scenes were judged")
      ->type_name("DIR|FILE.tar");
}

std::optional<Refusal> ApproveCommand::read_scenes(const std::optional<Baseline>& baseline,
                                                   std::vector<TestScene>& scenes) const {
  if (paths_.empty())
    return Refusal{kUsage, {"there is no scene: give SCENES behind the decisions"}};
  const Result<std::vector<std::filesystem::path>> files = find_scenes(paths_);
  if (!files) return Refusal{kFailed, files.error()};
  for (const std::filesystem::path& file : *files) {
    Result<TestScene> scene = read_scene(file);
    if (!scene) return Refusal{kUsage, scene.error()};
    if (baseline) {
      scene->baseline = baseline->folder();
      scene->unpacked = baseline->unpacked();
    }
    scenes.push_back(*std::move(scene));
  }
  return std::nullopt;
}

int ApproveCommand::run() const {
  const Result<std::vector<Decision>> decisions = read_decisions(file_);
  if (!decisions) return fail(kFailed, decisions.error());
  std::optional<Baseline> baseline;
  if (baseline_) {
    Result<Baseline> opened = Baseline::open(*baseline_, true);
    if (!opened) return fail(kUsage, opened.error());
    baseline.emplace(*std::move(opened));
  }
  std::vector<TestScene> scenes;
  if (const auto refusal = read_scenes(baseline, scenes)) return refuse(*refusal);
  const Result<std::vector<Approval>> approvals = check_decisions(*decisions, report_, scenes);
  if (!approvals) return fail(kFailed, approvals.error());
  std::vector<std::string> lines;
  std::optional<Error> failure;
  for (const Approval& approval : *approvals) {
    const Result<std::string> done = apply(approval);
    if (!done) failure = done.error();
    if (!done) break;
    lines.push_back(
        fmt::format("approved: {}: {}\n", one_line(approval.scene.name), one_line(*done)));
  }
  // An archive keeps what was approved before another one failed, as a folder does.
  if (baseline && !lines.empty())
    if (const Result<void> saved = baseline->save(); !saved) return fail(kFailed, saved.error());
  for (const std::string& line : lines) fmt::print("{}", line);
  if (failure) return fail(kFailed, *failure);
  for (const Decision& decision : *decisions)
    if (!decision.approve) fmt::print("rejected: {}\n", one_line(decision.scene));
  return kDone;
}

}  // namespace skerry::tools
