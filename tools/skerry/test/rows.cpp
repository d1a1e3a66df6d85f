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
#include "tools/skerry/farm/record.h"

namespace skerry::tools {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr Verdict kVerdicts[] = {Verdict::kPass, Verdict::kFail, Verdict::kApproved};
constexpr std::uint64_t kMaxResultBytes = 64u << 20;

/// Adds the numbers of a difference, which are null if there is none. The PSNR of equal pictures,
/// infinity, is null as well; reads come back through number_or_infinity.
void add_numbers(ordered_json& out, const std::optional<Difference>& found) {
  const auto number = [&](double Difference::*member) {
    const bool known = found && std::isfinite((*found).*member);
    return known ? ordered_json((*found).*member) : ordered_json(nullptr);
  };
  out["flip_mean"] = number(&Difference::flip_mean);
  out["flip_p99"] = number(&Difference::flip_p99);
  out["flip_max"] = number(&Difference::flip_max);
  out["psnr"] = number(&Difference::psnr_db);
  out["pixels_over"] = number(&Difference::pixels_over);
  out["pixels_rounded"] = number(&Difference::pixels_rounded);
  out["bias"] = number(&Difference::bias);
  out["largest"] = found ? ordered_json(found->largest) : ordered_json(nullptr);
}

ordered_json regions_json(const std::vector<PartDifference>& parts) {
  ordered_json out = ordered_json::array();
  for (const PartDifference& part : parts) {
    ordered_json region{{"name", part.name}};
    add_numbers(region, part.difference);
    out.push_back(std::move(region));
  }
  return out;
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
  found.pixels_rounded = row.at("pixels_rounded").get<double>();
  found.bias = row.at("bias").get<double>();
  found.largest = row.at("largest").get<int>();
  return found;
}

Verdict verdict_from_name(const std::string& name) {
  if (const std::optional<Verdict> verdict = verdict_of_name(name)) return *verdict;
  throw json::other_error::create(501, "unknown verdict", nullptr);
}

Cause cause_or_throw(const json& from) {
  const auto corner = [&](std::size_t i) {
    return from.at("rectangle").at(i).get<std::uint32_t>();
  };
  return {from.at("channel").get<std::string>(),
          from.at("pass").get<std::string>(),
          from.at("pixels").get<std::uint64_t>(),
          {corner(0), corner(1), corner(2), corner(3)},
          from.at("largest").get<int>()};
}

/// Throws nlohmann's errors.
Row row_or_throw(const json& from) {
  Row row;
  row.scene = from.at("scene").get<std::string>();
  row.verdict = verdict_from_name(from.at("verdict").get<std::string>());
  if (!from.at("hash_equal").is_null()) row.hash_equal = from.at("hash_equal").get<bool>();
  if (!from.at("flip_mean").is_null()) row.found = difference_from_json(from);
  for (const json& region : from.at("regions").get_ref<const json::array_t&>())
    row.parts.push_back({region.at("name").get<std::string>(), difference_from_json(region)});
  if (const json& shift = from.at("shift"); !shift.is_null())
    row.shift = Shift{shift.at(0).get<int>(), shift.at(1).get<int>()};
  if (!from.at("cause").is_null()) row.cause = cause_or_throw(from.at("cause"));
  row.seconds = from.at("seconds").get<double>();
  row.message = from.at("message").get<std::string>();
  row.driver = from.at("driver").get<std::string>();
  if (!from.at("device").is_null()) row.device = from.at("device").get<std::uint32_t>();
  row.command = from.at("command").get<std::string>();
  row.sound = from.at("sound").get<bool>();
  row.runs = from.at("runs").get<int>();
  row.failed_runs = from.at("failed_runs").get<int>();
  row.pictures = from.at("pictures").get<int>();
  row.picture = from.at("picture").get<std::string>();
  return row;
}

ordered_json cause_json(const Cause& cause) {
  const game::Mask& around = cause.around;
  return {{"channel", cause.channel},
          {"pass", cause.pass},
          {"pixels", cause.pixels},
          {"rectangle", {around.x, around.y, around.width, around.height}},
          {"largest", cause.largest}};
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
                            measure::escape(row.explanation()), measure::escape(row.command));
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

std::optional<Verdict> verdict_of_name(std::string_view name) {
  for (const Verdict verdict : kVerdicts) {
    if (verdict_name(verdict) == name) return verdict;
  }
  return std::nullopt;
}

std::string Row::explanation() const {
  if (!cause) return message;
  return fmt::format("{}; {}", message, text_of(*cause));
}

void Row::take(const Comparison& compared) {
  found = compared.difference;
  parts = compared.parts;
  shift = compared.shift;
}

ordered_json row_json(const Row& row) {
  ordered_json out;
  out["scene"] = row.scene;
  out["verdict"] = verdict_name(row.verdict);
  out["hash_equal"] = row.hash_equal ? ordered_json(*row.hash_equal) : ordered_json(nullptr);
  add_numbers(out, row.found);
  out["regions"] = regions_json(row.parts);
  out["shift"] = row.shift ? ordered_json({row.shift->dx, row.shift->dy}) : ordered_json(nullptr);
  out["cause"] = row.cause ? cause_json(*row.cause) : ordered_json(nullptr);
  out["seconds"] = row.seconds;
  out["message"] = row.message;
  out["driver"] = row.driver;
  out["device"] = row.device ? ordered_json(*row.device) : ordered_json(nullptr);
  out["command"] = row.command;
  out["sound"] = row.sound;
  out["runs"] = row.runs;
  out["failed_runs"] = row.failed_runs;
  out["pictures"] = row.pictures;
  out["picture"] = row.picture;
  return out;
}

Result<Row> row_from_json(const json& from) {
  try {
    return row_or_throw(from);
  } catch (const json::exception& why) {
    return Error{
        fmt::format("cannot use a row: {}; plan and run its task again", fault_of_row(why))};
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
    return Error{fmt::format("cannot merge {}: {}; give files that this version of skerry wrote",
                             game::quote_text(file.string()), why)};
  };
  const Result<json> from = game::parse_json(*text);
  if (!from) return wrong("it " + from.error().message);
  try {
    return results_or_throw(*from);
  } catch (const json::exception& why) {
    return wrong(fault_of_row(why));
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
