#include "tools/skerry/test/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/core/check.h"
#include "engine/platform/files.h"
#include "game/scene_file/json_text.h"
#include "game/scene_file/parse.h"
#include "tools/measure/html.h"

namespace skerry::tools {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr Verdict kVerdicts[] = {Verdict::kPass, Verdict::kFail, Verdict::kApproved};
constexpr std::uint64_t kMaxResultBytes = 64u << 20;

/// nlohmann writes infinity as null; reads come back through number_or_infinity.
ordered_json number_or_null(const std::optional<Difference>& found, double Difference::*member) {
  return found ? ordered_json((*found).*member) : ordered_json(nullptr);
}

double number_or_infinity(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

Difference difference_from_json(const json& row) {
  Difference found;
  found.flip_mean = row.at("flip_mean").get<double>();
  found.flip_p99 = row.at("flip_p99").get<double>();
  found.flip_max = row.at("flip_max").get<double>();
  found.psnr_db = number_or_infinity(row.at("psnr"));
  found.pixels_over = row.at("pixels_over").get<double>();
  found.largest = row.at("largest").get<int>();
  return found;
}

Verdict verdict_from_name(const std::string& name) {
  for (const Verdict verdict : kVerdicts) {
    if (verdict_name(verdict) == name) return verdict;
  }
  throw json::other_error::create(501, "unknown verdict", nullptr);
}

/// Throws nlohmann's errors.
Row row_or_throw(const json& from) {
  Row row;
  row.scene = from.at("scene").get<std::string>();
  row.verdict = verdict_from_name(from.at("verdict").get<std::string>());
  if (!from.at("hash_equal").is_null()) row.hash_equal = from.at("hash_equal").get<bool>();
  if (!from.at("flip_mean").is_null()) row.found = difference_from_json(from);
  row.seconds = from.at("seconds").get<double>();
  row.message = from.at("message").get<std::string>();
  row.driver = from.at("driver").get<std::string>();
  if (!from.at("device").is_null()) row.device = from.at("device").get<std::uint32_t>();
  row.command = from.at("command").get<std::string>();
  row.sound = from.at("sound").get<bool>();
  row.runs = from.at("runs").get<int>();
  row.failed_runs = from.at("failed_runs").get<int>();
  row.pictures = from.at("pictures").get<int>();
  return row;
}

Results results_or_throw(const json& from) {
  Results results;
  const Result<Shard> shard = parse_shard(from.at("shard").get<std::string>());
  if (!shard) throw json::other_error::create(501, shard.error().message, nullptr);
  results.shard = *shard;
  results.scenes_in_set = from.at("scenes_in_set").get<std::size_t>();
  results.html = from.at("html").get<std::string>();
  for (const json& row : from.at("rows")) results.rows.push_back(row_or_throw(row));
  return results;
}

Result<void> check_shards(std::span<const Results> shards) {
  std::set<std::size_t> seen;
  for (const Results& part : shards) {
    const std::string name = fmt::format("{}/{}", part.shard.index, part.shard.count);
    if (part.shard.count != shards.front().shard.count ||
        part.scenes_in_set != shards.front().scenes_in_set) {
      return Error{
          fmt::format("cannot merge shard {} of {} scenes with shard {}/{} of {}: give the "
                      "shards of one run",
                      name, part.scenes_in_set, shards.front().shard.index,
                      shards.front().shard.count, shards.front().scenes_in_set)};
    }
    if (!seen.insert(part.shard.index).second)
      return Error{fmt::format("cannot merge shard {} with itself: give each file once", name)};
  }
  for (std::size_t i = 1; i <= shards.front().shard.count; ++i) {
    if (!seen.count(i)) {
      return Error{fmt::format("cannot merge: shard {}/{} is missing; give the files of all shards",
                               i, shards.front().shard.count)};
    }
  }
  return {};
}

std::string junit_case(const Row& row) {
  const std::string head =
      fmt::format("    <testcase classname=\"scenes\" name=\"{}\" time=\"{:.3f}\"",
                  measure::escape(row.scene), row.seconds);
  if (!row.failed()) return head + "/>\n";
  return head + fmt::format(">\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n",
                            measure::escape(row.message), measure::escape(row.command));
}

}  // namespace

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kApproved:
      return "approved";
    default:
      return "fail";
  }
}

ordered_json row_json(const Row& row) {
  ordered_json out;
  out["scene"] = row.scene;
  out["verdict"] = verdict_name(row.verdict);
  out["hash_equal"] = row.hash_equal ? ordered_json(*row.hash_equal) : ordered_json(nullptr);
  out["flip_mean"] = number_or_null(row.found, &Difference::flip_mean);
  out["flip_p99"] = number_or_null(row.found, &Difference::flip_p99);
  out["flip_max"] = number_or_null(row.found, &Difference::flip_max);
  out["psnr"] = row.found && std::isfinite(row.found->psnr_db) ? ordered_json(row.found->psnr_db)
                                                               : ordered_json(nullptr);
  out["pixels_over"] = number_or_null(row.found, &Difference::pixels_over);
  out["largest"] = row.found ? ordered_json(row.found->largest) : ordered_json(nullptr);
  out["seconds"] = row.seconds;
  out["message"] = row.message;
  out["driver"] = row.driver;
  out["device"] = row.device ? ordered_json(*row.device) : ordered_json(nullptr);
  out["command"] = row.command;
  out["sound"] = row.sound;
  out["runs"] = row.runs;
  out["failed_runs"] = row.failed_runs;
  out["pictures"] = row.pictures;
  return out;
}

Result<Row> row_from_json(const json& from) {
  try {
    return row_or_throw(from);
  } catch (const json::exception& why) {
    return Error{fmt::format("it holds no row of skerry test ({})", why.what())};
  }
}

ordered_json results_json(const Results& results) {
  ordered_json rows = ordered_json::array();
  for (const Row& row : results.rows) rows.push_back(row_json(row));
  return {{"shard", fmt::format("{}/{}", results.shard.index, results.shard.count)},
          {"scenes_in_set", results.scenes_in_set},
          {"html", results.html},
          {"rows", std::move(rows)}};
}

Result<Results> read_results(const std::filesystem::path& file) {
  const Result<std::string> text = platform::read_text(file, kMaxResultBytes);
  if (!text) return text.error();
  const auto wrong = [&](std::string_view why) {
    return Error{fmt::format("cannot merge {}: {}; give files that skerry test --json wrote",
                             game::quote_text(file.string()), why)};
  };
  const Result<json> from = game::parse_json(*text);
  if (!from) return wrong("it " + from.error().message);
  try {
    return results_or_throw(*from);
  } catch (const json::exception& why) {
    return wrong(game::quote_text(why.what()));
  }
}

Result<Results> merge(std::span<const Results> shards) {
  SKERRY_ASSERT(!shards.empty());
  if (const Result<void> checked = check_shards(shards); !checked) return checked.error();
  Results all;
  all.scenes_in_set = shards.front().scenes_in_set;
  for (const Results& part : shards)
    all.rows.insert(all.rows.end(), part.rows.begin(), part.rows.end());
  std::sort(all.rows.begin(), all.rows.end(),
            [](const Row& a, const Row& b) { return a.scene < b.scene; });
  for (std::size_t i = 1; i < all.rows.size(); ++i) {
    if (all.rows[i - 1].scene != all.rows[i].scene) continue;
    return Error{
        fmt::format("cannot merge: two shards hold the scene {}; give the shards of one run",
                    game::quote_text(all.rows[i].scene))};
  }
  if (all.rows.size() == all.scenes_in_set) return all;
  return Error{fmt::format("cannot merge: the shards hold {} of {} scenes; run them again",
                           all.rows.size(), all.scenes_in_set)};
}

std::string junit_xml(const Results& results) {
  const auto failures = std::count_if(results.rows.begin(), results.rows.end(),
                                      [](const Row& row) { return row.failed(); });
  double seconds = 0.0;
  std::string cases;
  for (const Row& row : results.rows) {
    seconds += row.seconds;
    cases += junit_case(row);
  }
  const std::string counts = fmt::format("name=\"skerry test\" tests=\"{}\" failures=\"{}\"",
                                         results.rows.size(), failures);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite {} errors=\"0\" "
      "skipped=\"0\" time=\"{:.3f}\">\n{}  </testsuite>\n</testsuites>\n",
      counts, counts, seconds, cases);
}

}  // namespace skerry::tools
