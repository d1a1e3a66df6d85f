#include "tools/skerry/test/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/measure/html.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/farm/plan.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

// What measure's pages do not have: two pictures in turn.
constexpr std::string_view kStyle = R"(
.blink { position: relative; }
.blink img + img { position: absolute; left: 0; top: 0; animation: blink 1s steps(1) infinite; }
@keyframes blink { 50% { opacity: 0; } }
.pictures { grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); }
.decide [aria-pressed=true] { font-weight: 700; outline: 2px solid var(--link); }
.strip { white-space: nowrap; line-height: 1; }
.strip i { display: inline-block; width: .5rem; height: 1rem; margin-right: 1px; background: currentColor; }
.strip i.changed { border-left: 3px solid var(--link); }
.strip i.differs { background: none; border: 2px dashed currentColor; box-sizing: border-box; }
.decisions { position: sticky; bottom: 0; padding: .5rem; background: var(--soft); }
)";

// What was decided is kept by the page alone until it is saved. Well-formed as XML, too: without
// the characters that markup begins with.
constexpr std::string_view kScript = R"(
"use strict";
const decisions = new Map();
const count = document.querySelector(".decisions output");
const save = document.querySelector(".decisions button");
function decide(box, button) {
  const { scene, driver, picture } = box.dataset;
  const decision = button.dataset.decision;
  const withdrawn = decisions.get(scene)?.decision === decision;
  if (withdrawn) decisions.delete(scene);
  else decisions.set(scene, { scene, driver, picture, decision });
  for (const other of box.querySelectorAll("button"))
    other.setAttribute("aria-pressed", String(other === button ? !withdrawn : false));
  count.textContent = decisions.size + " decided";
  save.disabled = decisions.size === 0;
}
for (const box of document.querySelectorAll(".decide"))
  for (const button of box.querySelectorAll("button"))
    button.addEventListener("click", () => decide(box, button));
save.addEventListener("click", () => {
  const text = JSON.stringify({ decisions: [...decisions.values()] }, null, 1) + "\n";
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  link.download = "decisions.json";
  link.click();
});
)";

/// A file name as a relative address.
std::string address(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '.' || c == '_' || c == '-';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.5f}", value) : std::string("equal");
}

/// As tables of differences list them.
constexpr double Difference::*kQuantities[] = {
    &Difference::flip_mean, &Difference::flip_p99,    &Difference::flip_max,
    &Difference::psnr_db,   &Difference::pixels_over, &Difference::pixels_rounded,
    &Difference::bias};

std::string_view hash_word(const Row& row) {
  if (!row.hash_equal) return "none approved";
  return *row.hash_equal ? "equal" : "different";
}

std::string css_class(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "good";
    case Verdict::kApproved:
      return "warn";
    default:
      return "bad";
  }
}

std::string link(const std::string& target, std::string_view markup) {
  return measure::element("a", {{"href", target}}, markup);
}

/// Earlier runs and this one as a strip of the last kShownRuns: one is marked where its picture is
/// another one than before, and where it gave several.
std::string strip(std::span<const PastRun> runs) {
  constexpr std::size_t kShownRuns = 60;
  std::string marks;
  for (std::size_t i = runs.size() - std::min(runs.size(), kShownRuns); i < runs.size(); ++i) {
    const PastRun& run = runs[i];
    const bool changed = i > 0 && run.picture != runs[i - 1].picture;
    const std::string says = fmt::format("{}: {}, {} of {} failed, {} {}{}", run.date,
                                         verdict_name(run.verdict), run.failed_runs, run.runs,
                                         run.pictures, run.pictures == 1 ? "picture" : "pictures",
                                         changed ? ", another one than before" : "");
    marks += measure::element(
        "i",
        {{"class", fmt::format("{}{}{}", css_class(run.verdict), changed ? " changed" : "",
                               run.pictures > 1 ? " differs" : "")},
         {"title", says}},
        "");
  }
  return measure::element(
      "span", {{"class", "strip"}, {"role", "img"}, {"aria-label", summary_of(runs)}}, marks);
}

measure::TableRow table_row(const Row& row, const History* history) {
  measure::TableRow out{{link(fmt::format("#{}", address(row.scene)), measure::escape(row.scene)),
                         std::string(verdict_name(row.verdict)), std::string(hash_word(row))},
                        css_class(row.verdict)};
  for (double Difference::*quantity : kQuantities)
    out.cells.push_back(row.found ? number((*row.found).*quantity) : std::string());
  out.cells.push_back(fmt::format("{:.2f} s", row.seconds));
  if (history) out.cells.push_back(strip(history->of(row.scene, row.driver)));
  return out;
}

class Figures {
 public:
  Figures(const fs::path& folder, const std::string& scene) : folder_(folder), scene_(scene) {}

  bool has(ReportPicture kind) const {
    std::error_code code;
    return fs::exists(folder_ / report_picture_name(scene_, kind), code);
  }
  std::string figure(ReportPicture kind, std::string_view caption) const {
    if (!has(kind)) return {};
    const std::string source = address(report_picture_name(scene_, kind));
    return with_caption(link(source, measure::image(source, caption)), caption);
  }
  /// The two pictures in turn.
  std::string blink() const {
    return with_caption(
        measure::element("div", {{"class", "blink"}},
                         image(ReportPicture::kReference) + image(ReportPicture::kActual)),
        "blink");
  }

 private:
  std::string image(ReportPicture kind) const {
    return measure::image(address(report_picture_name(scene_, kind)), "blink");
  }
  static std::string with_caption(const std::string& markup, std::string_view caption) {
    return measure::element("figure",
                            markup + measure::element("figcaption", measure::escape(caption)));
  }

  const fs::path& folder_;
  const std::string& scene_;
};

std::string pictures_of(const Row& row, const fs::path& folder) {
  const Figures figures(folder, row.scene);
  const bool approved = row.verdict == Verdict::kApproved;
  std::string out;
  out += figures.figure(ReportPicture::kReference, approved ? "reference before" : "reference");
  out += figures.figure(ReportPicture::kActual, approved ? "reference now" : "actual");
  out += figures.figure(ReportPicture::kDifference, "difference, 8 times");
  out += figures.figure(ReportPicture::kFlip, "FLIP");
  if (figures.has(ReportPicture::kDifference)) out += figures.blink();
  return measure::element("div", {{"class", "pictures"}}, out);
}

/// Approve and reject, for a failure whose picture could be approved; else nothing.
std::string buttons(const Row& row, const fs::path& folder) {
  const std::string picture = report_picture_name(row.scene, ReportPicture::kActual);
  if (!row.failed() || !row.sound || row.driver.empty()) return {};
  const Result<std::string> hash = file_hash(folder / picture);
  if (!hash || *hash == "none") return {};
  std::string both;
  for (const char* decision : {"approve", "reject"})
    both += measure::element(
        "button", {{"type", "button"}, {"data-decision", decision}, {"aria-pressed", "false"}},
        decision);
  return measure::element("p",
                          {{"class", "decide"},
                           {"data-scene", row.scene},
                           {"data-driver", row.driver},
                           {"data-picture", *hash}},
                          both);
}

/// Where decisions are saved, if there is anything to decide.
std::string decisions_bar(std::string_view sections) {
  if (sections.find("class=\"decide\"") == std::string_view::npos) return {};
  return measure::element(
             "p", {{"class", "decisions"}},
             measure::element("output", "0 decided") + " " +
                 measure::element("button", {{"type", "button"}, {"disabled", "disabled"}},
                                  "save decisions.json") +
                 " " + measure::labelled("span", "faint", "then: skerry test approve")) +
         measure::element("script", kScript);
}

/// What a scene's own tolerances found: regions, and where the picture lies.
std::string measured_parts(const Row& row) {
  std::string out;
  if (row.shift && *row.shift != Shift{})
    out += measure::element(
        "p", fmt::format("compared at an offset of ({}, {}) pixels", row.shift->dx, row.shift->dy));
  if (row.parts.empty()) return out;
  constexpr std::string_view kHeadings[] = {"region", "FLIP mean",   "p99",     "max",
                                            "PSNR",   "pixels over", "rounded", "bias"};
  std::vector<measure::TableRow> table;
  for (const PartDifference& part : row.parts) {
    measure::TableRow line{{measure::escape(part.name)}, {}};
    for (double Difference::*quantity : kQuantities)
      line.cells.push_back(number(part.difference.*quantity));
    table.push_back(std::move(line));
  }
  return out + measure::table(kHeadings, table);
}

std::string section(const Row& row, const fs::path& folder, const History* history) {
  std::string out = measure::element(
      "h2", {{"id", address(row.scene)}},
      measure::escape(row.scene) + " " +
          measure::labelled("span", css_class(row.verdict), verdict_name(row.verdict)));
  out += buttons(row, folder);
  if (!row.message.empty()) out += measure::element("p", measure::escape(row.explanation()));
  out += measured_parts(row);
  if (row.runs > 1) {
    out += measure::element("p", fmt::format("{} of {} runs failed; {} different pictures",
                                             row.failed_runs, row.runs, row.pictures));
  }
  if (history) {
    const std::span<const PastRun> runs = history->of(row.scene, row.driver);
    out += measure::element("p", strip(runs) + " " + measure::escape(summary_of(runs)));
  }
  out += pictures_of(row, folder);
  if (!row.command.empty())
    out += measure::element("p", measure::element("code", measure::escape(row.command)) + " on " +
                                     measure::escape(row.driver));
  return out + "\n";
}

int rank(const Row& row) {
  if (row.failed()) return 0;
  return row.verdict == Verdict::kApproved ? 1 : 2;
}

}  // namespace

std::string test_page(const Results& results, const fs::path& folder, const History* history) {
  std::vector<const Row*> rows;
  for (const Row& row : results.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row* a, const Row* b) { return rank(*a) < rank(*b); });
  std::vector<measure::TableRow> table;
  std::string sections;
  for (const Row* row : rows) {
    table.push_back(table_row(*row, history));
    sections += section(*row, folder, history);
  }
  const auto failures =
      std::count_if(rows.begin(), rows.end(), [](const Row* row) { return row->failed(); });
  const std::string title =
      fmt::format("skerry test: {} of {} scenes failed", failures, rows.size());
  std::vector<std::string_view> headings{"scene",   "verdict", "hash", "FLIP mean",
                                         "p99",     "max",     "PSNR", "pixels over",
                                         "rounded", "bias",    "time"};
  if (history) headings.push_back("history");
  return measure::page(title, measure::element("style", kStyle) + measure::element("h1", title) +
                                  measure::table(headings, table) + sections +
                                  decisions_bar(sections));
}

}  // namespace skerry::tools
