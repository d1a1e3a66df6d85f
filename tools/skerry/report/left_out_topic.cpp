#include "tools/skerry/report/left_out_topic.h"

#include <fmt/format.h>

#include "engine/core/output.h"
#include "tools/measure/html.h"

namespace skerry::tools {
namespace {

using measure::element;
using measure::escape;
using measure::labelled;
using nlohmann::ordered_json;

/// What both sides must agree in.
struct Count {
  const char* name;
  std::uint64_t (*of)(const LeftOutSide&);
};
constexpr Count kCounts[] = {
    {"passes", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.passes; }},
    {"dispatches", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.dispatches; }},
    {"draws", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.draws; }},
    {"copies", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.copies; }},
    {"barriers", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.barriers; }},
    {"descriptor_writes",
     [](const LeftOutSide& s) -> std::uint64_t { return s.counts.descriptor_writes; }},
    {"images", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.images; }},
    {"buffers", [](const LeftOutSide& s) -> std::uint64_t { return s.counts.buffers; }},
    {"transient_bytes", [](const LeftOutSide& s) { return s.counts.transient_bytes; }},
    {"pipelines",
     [](const LeftOutSide& s) { return static_cast<std::uint64_t>(s.pipelines_created); }},
    {"memory_bytes", [](const LeftOutSide& s) { return s.memory_bytes; }}};

ordered_json side_json(const LeftOutSide& side) {
  ordered_json j{{"ms_median", side.ms}, {"start_ms_median", side.start_ms}};
  for (const Count& count : kCounts) j[count.name] = count.of(side);
  return j;
}

/// One number where both agree, else both.
std::string cell(const Count& count, const LeftOutRow& row) {
  const std::uint64_t a = count.of(row.as_is), b = count.of(row.without);
  if (a == b) return fmt::format("{}", a);
  return labelled("span", "bad", fmt::format("{} \xe2\x89\xa0 {}", a, b));
}

}  // namespace

std::vector<Defect> defects_of(const std::vector<LeftOutRow>& rows) {
  std::vector<Defect> defects;
  for (const LeftOutRow& row : rows)
    if (!row.same_picture || !row.same_counts())
      defects.push_back({fmt::format(
          "{}: a scene without {} {} a renderer that has none", kLeftOutTopic, row.feature,
          row.same_picture ? "costs more than with" : "looks different from that of")});
  return defects;
}

std::string left_out_csv(const std::vector<LeftOutRow>& rows) {
  std::string out = "feature,renderer,same_picture,ms_median,start_ms_median";
  for (const Count& count : kCounts) out += fmt::format(",{}", count.name);
  out += "\n";
  for (const LeftOutRow& row : rows) {
    for (const LeftOutSide* side : {&row.as_is, &row.without}) {
      out += fmt::format("{},{},{},{},{}", row.feature, side == &row.as_is ? "as_is" : "without",
                         row.same_picture ? 1 : 0, side->ms, side->start_ms);
      for (const Count& count : kCounts) out += fmt::format(",{}", count.of(*side));
      out += "\n";
    }
  }
  return out;
}

ordered_json left_out_json(const std::vector<LeftOutRow>& rows) {
  ordered_json j{{"topic", kLeftOutTopic}, {"meaning", kLeftOutMeaning}};
  j["rows"] = ordered_json::array();
  for (const LeftOutRow& row : rows)
    j["rows"].push_back({{"feature", row.feature},
                         {"why", row.why},
                         {"same_picture", row.same_picture},
                         {"same_counts", row.same_counts()},
                         {"as_is", side_json(row.as_is)},
                         {"without", side_json(row.without)}});
  return j;
}

Result<std::string> write_left_out(const std::vector<LeftOutRow>& rows,
                                   const std::filesystem::path& dir) {
  if (Result<void> done = write_text(dir / "left_out.csv", left_out_csv(rows)); !done)
    return done.error();
  if (Result<void> done = write_text(dir / "left_out.json", left_out_json(rows).dump(2) + "\n");
      !done)
    return done.error();
  std::vector<std::string_view> headings{"feature", "left out because", "picture"};
  for (const Count& count : kCounts) headings.emplace_back(count.name);
  headings.insert(headings.end(), {"frame ms", "without", "start ms", "without"});
  std::vector<measure::TableRow> lines;
  for (const LeftOutRow& row : rows) {
    const bool equal = row.same_picture && row.same_counts();
    measure::TableRow line{{escape(row.feature), escape(row.why),
                            row.same_picture ? "equal" : labelled("span", "bad", "differs")},
                           equal ? "good" : "bad"};
    for (const Count& count : kCounts) line.cells.push_back(cell(count, row));
    line.cells.push_back(fmt::format("{:.3f}", row.as_is.ms));
    line.cells.push_back(fmt::format("{:.3f}", row.without.ms));
    line.cells.push_back(fmt::format("{:.1f}", row.as_is.start_ms));
    line.cells.push_back(fmt::format("{:.1f}", row.without.start_ms));
    lines.push_back(std::move(line));
  }
  std::string out = element("h2", {{"id", std::string(kLeftOutTopic)}}, kLeftOutTopic) + "\n";
  out += labelled("p", "",
                  fmt::format("{}: each row is a scene without a feature, drawn by the renderer as "
                              "it is, and by one told to have none of it. Pictures and counts must "
                              "be equal; a count that is not shows both.",
                              kLeftOutMeaning));
  for (const Defect& defect : defects_of(rows)) out += labelled("p", "bad", defect.text) + "\n";
  return out + measure::table(headings, lines);
}

}  // namespace skerry::tools
