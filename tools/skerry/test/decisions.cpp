#include "tools/skerry/test/decisions.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <set>

#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/farm/plan.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/test/judge.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kMaxDecisionBytes = 128u << 20;  // more than a page's pictures as base64

/// None: the text is no base64.
std::optional<std::string> from_base64(const std::string& text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  // OpenSSL takes white space and fillers in more places.
  const std::size_t fillers = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
  const std::string_view digits = std::string_view(text).substr(0, text.size() - fillers);
  if (text.empty() || text.size() % 4 != 0 ||
      digits.find_first_not_of(kDigits) != std::string_view::npos)
    return std::nullopt;
  std::string bytes(text.size() / 4 * 3, '\0');
  const int got = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                                  reinterpret_cast<const unsigned char*>(text.data()),
                                  static_cast<int>(text.size()));
  if (got < 0) return std::nullopt;
  bytes.resize(bytes.size() - fillers);
  return bytes;
}

/// Throws nlohmann's errors.
Decision decision_from(const json& from) {
  Decision one{from.at("scene").get<std::string>(), from.at("driver").get<std::string>(),
               from.at("picture").get<std::string>(), false, std::nullopt};
  if (from.contains("png")) {
    one.png = from_base64(from.at("png").get<std::string>());
    if (!one.png) throw json::other_error::create(501, "a picture is no base64", nullptr);
  }
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
std::string not_replaceable(const fs::path& file, const std::optional<Unpacked>& from) {
  std::error_code code;
  const fs::file_type type = fs::symlink_status(file, code).type();
  if (type == fs::file_type::not_found || type == fs::file_type::regular) return {};
  return fmt::format("{} is no regular file; remove it", known_as(file, from));
}

/// The same, of a reference.
std::string not_a_reference(const TestScene& scene, const std::string& driver) {
  std::error_code code;
  const fs::path file = scene.reference(driver);
  std::string why = not_replaceable(file, scene.unpacked);
  if (!why.empty() || !fs::exists(file, code)) return why;
  const Result<platform::PngImage> picture = scene.read_reference(driver);
  if (!picture) return picture.error().message;
  const bool ours = std::ranges::any_of(picture->text, [](const platform::PngText& text) {
    return text.key == "Software" && text.text == "Skerry";
  });
  if (ours) return {};
  return fmt::format("{} is no picture of Skerry; remove it", known_as(file, scene.unpacked));
}

/// The row that a decision is about. Errors: the report has another one.
Result<const Row*> row_of(const Decision& decision, const Results& results) {
  const auto row = std::ranges::find(results.rows, decision.scene, &Row::scene);
  if (row == results.rows.end()) return cannot(decision.scene, "the report has no such scene");
  if (row->driver != decision.driver)
    return cannot(decision.scene, "the report is of another driver; give the one that was judged");
  if (!row->failed() || !row->sound)
    return cannot(decision.scene, "it did not fail, or its picture is black or not finite");
  return &*row;
}

/// The file of the picture that was looked at.
Result<std::string> picture_file(const Decision& decision, const std::optional<fs::path>& report) {
  if (!report && !decision.png)
    return cannot(decision.scene, "the decisions have no picture of it; give --report DIR");
  if (!report) return *decision.png;
  return platform::read_text(*report / report_picture_name(decision.scene, ReportPicture::kActual),
                             platform::kMaxPngFileBytes);
}

Result<Approval> approval_of(const Decision& decision, const std::optional<fs::path>& report,
                             std::span<const TestScene> scenes) {
  if (decision.driver.empty() || file_name_part(decision.driver) != decision.driver)
    return cannot(decision.scene, "it names no driver; draw it again");
  const auto scene = std::ranges::find(scenes, decision.scene, &TestScene::name);
  if (scene == scenes.end())
    return cannot(decision.scene, "it is not among SCENES; give those that were judged");
  const Result<std::string> file = picture_file(decision, report);
  if (!file) return file.error();
  if (sha256_hex({reinterpret_cast<const std::uint8_t*>(file->data()), file->size()}) !=
      decision.picture)
    return cannot(
        decision.scene,
        fmt::format("the {} picture is not the one that was judged; look at the page again",
                    report ? "report's" : "decisions'"));
  Result<platform::PngImage> picture = platform::decode_png(*file, "its picture");
  if (!picture) return cannot(decision.scene, picture.error().message);
  const fs::path hashes = hash_file(scene->approved(decision.driver), decision.driver);
  for (const std::string& why :
       {not_replaceable(hashes, scene->unpacked), not_a_reference(*scene, decision.driver)})
    if (!why.empty()) return cannot(decision.scene, why);
  if (const Result<Hashes> approved = read_hashes(hashes, scene->unpacked); !approved)
    return approved.error();
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
                                              const std::optional<fs::path>& report,
                                              std::span<const TestScene> scenes) {
  Results results;
  if (report) {
    Result<Results> read = read_results(*report / kReportFile);
    if (!read) return read.error();
    results = *std::move(read);
  }
  std::vector<Approval> approvals;
  for (const Decision& decision : decisions) {
    if (!decision.approve) continue;
    if (report)
      if (const auto row = row_of(decision, results); !row) return row.error();
    Result<Approval> approval = approval_of(decision, report, scenes);
    if (!approval) return approval.error();
    approvals.push_back(*std::move(approval));
  }
  return approvals;
}

Result<std::string> apply(const Approval& approval) {
  const TestScene& scene = approval.scene;
  const Result<Hashes> hashes =
      read_hashes(hash_file(scene.approved(approval.driver), approval.driver), scene.unpacked);
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
