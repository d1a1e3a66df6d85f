#include "tools/skerry/test/decisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/farm/plan.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/test/judge.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kMaxDecisionBytes = 16u << 20;

/// Throws nlohmann's errors.
Decision decision_from(const json& from) {
  Decision one{from.at("scene").get<std::string>(), from.at("driver").get<std::string>(),
               from.at("picture").get<std::string>(), false};
  const auto word = from.at("decision").get<std::string>();
  one.approve = word == "approve";
  if (!one.approve && word != "reject")
    throw json::other_error::create(501, "neither approve nor reject", nullptr);
  return one;
}

Error cannot(const std::string& scene, std::string_view why) {
  return {fmt::format("cannot approve {}: {}", game::quote_text(scene), why)};
}

/// What keeps a name from getting another file; empty if nothing does.
std::string not_replaceable(const fs::path& file) {
  std::error_code code;
  const fs::file_type type = fs::symlink_status(file, code).type();
  if (type == fs::file_type::not_found || type == fs::file_type::regular) return {};
  return fmt::format("{} is no regular file; remove it", game::quote_text(file.string()));
}

/// The same, of a reference.
std::string not_a_reference(const fs::path& file) {
  std::error_code code;
  if (std::string why = not_replaceable(file); !why.empty() || !fs::exists(file, code)) return why;
  const Result<platform::PngImage> picture = platform::read_png(file);
  if (!picture) return picture.error().message;
  const bool ours = std::ranges::any_of(picture->text, [](const platform::PngText& text) {
    return text.key == "Software" && text.text == "Skerry";
  });
  if (ours) return {};
  return fmt::format("{} is no picture of Skerry; remove it", game::quote_text(file.string()));
}

/// The row that a decision is about. Errors: the report has another one.
Result<const Row*> row_of(const Decision& decision, const Results& results) {
  const auto row = std::ranges::find(results.rows, decision.scene, &Row::scene);
  if (row == results.rows.end()) return cannot(decision.scene, "the report has no such scene");
  if (row->driver != decision.driver)
    return cannot(decision.scene, "the report is of another driver; give the one that was judged");
  if (!row->failed() || !row->sound)
    return cannot(decision.scene, "it did not fail, or its picture is black or not finite");
  if (row->driver.empty() || file_name_part(row->driver) != row->driver)
    return cannot(decision.scene, "the report names no driver; draw it again");
  return &*row;
}

Result<Approval> approval_of(const Decision& decision, const fs::path& report,
                             std::span<const TestScene> scenes) {
  const auto scene = std::ranges::find(scenes, decision.scene, &TestScene::name);
  if (scene == scenes.end())
    return cannot(decision.scene, "it is not among SCENES; give those that were judged");
  const fs::path file = report / report_picture_name(scene->name, ReportPicture::kActual);
  const Result<std::string> hash = file_hash(file);
  if (!hash) return hash.error();
  if (*hash != decision.picture)
    return cannot(decision.scene,
                  "the report's picture is not the one that was judged; look at "
                  "the report again");
  Result<platform::PngImage> picture = platform::read_png(file);
  if (!picture) return picture.error();
  const fs::path hashes = hash_file(scene->approved(decision.driver), decision.driver);
  for (const std::string& why :
       {not_replaceable(hashes), not_a_reference(scene->reference(decision.driver))})
    if (!why.empty()) return cannot(decision.scene, why);
  if (const Result<Hashes> approved = read_hashes(hashes); !approved) return approved.error();
  return Approval{*scene, decision.driver, *std::move(picture)};
}

}  // namespace

Result<std::vector<Decision>> read_decisions(const fs::path& file) {
  const Result<std::string> text = platform::read_text(file, kMaxDecisionBytes);
  if (!text) return text.error();
  const auto wrong = [&](std::string_view why) {
    return Error{
        fmt::format("cannot use the decisions {}: {}; give a file that the page of skerry "
                    "test saved",
                    game::quote_text(file.string()), why)};
  };
  const Result<json> from = game::parse_json(*text);
  if (!from) return wrong("it " + from.error().message);
  std::vector<Decision> decisions;
  std::set<std::string> scenes;
  try {
    for (const json& one : from->at("decisions")) {
      decisions.push_back(decision_from(one));
      if (!scenes.insert(decisions.back().scene).second)
        return wrong(fmt::format("it has {} twice", game::quote_text(decisions.back().scene)));
    }
  } catch (const json::exception& why) {
    return wrong(game::quote_text(why.what()));
  }
  return decisions;
}

Result<std::vector<Approval>> check_decisions(std::span<const Decision> decisions,
                                              const fs::path& report,
                                              std::span<const TestScene> scenes) {
  const Result<Results> results = read_results(report / kReportFile);
  if (!results) return results.error();
  std::vector<Approval> approvals;
  for (const Decision& decision : decisions) {
    if (!decision.approve) continue;
    if (const Result<const Row*> row = row_of(decision, *results); !row) return row.error();
    Result<Approval> approval = approval_of(decision, report, scenes);
    if (!approval) return approval.error();
    approvals.push_back(*std::move(approval));
  }
  return approvals;
}

Result<std::string> apply(const Approval& approval) {
  const TestScene& scene = approval.scene;
  const Result<Hashes> hashes =
      read_hashes(hash_file(scene.approved(approval.driver), approval.driver));
  if (!hashes) return hashes.error();
  JudgeOptions options;
  options.approve = true;
  const Outcome outcome = judge(scene, {approval.picture, 0, approval.driver}, *hashes, options);
  if (outcome.row.failed()) return cannot(scene.name, outcome.row.message);
  if (outcome.row.verdict != Verdict::kApproved) return std::string("it was approved already");
  if (const Result<void> stored = store_hash(scene, outcome); !stored) return stored.error();
  return outcome.row.message;
}

}  // namespace skerry::tools
