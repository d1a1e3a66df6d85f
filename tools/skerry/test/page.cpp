#include "tools/skerry/test/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/platform/files.h"
#include "engine/platform/image_file.h"
#include "tools/measure/html.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/farm/plan.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// Pictures in the page, before base64 makes four bytes of three.
constexpr std::uint64_t kMostInlinedBytes = 48u << 20;

// What measure's pages do not have: two pictures in turn.
constexpr std::string_view kStyle = R"(
.blink { position: relative; }
.inlined { cursor: zoom-in; }
.full { cursor: zoom-out; grid-column: 1 / -1; overflow-x: auto; }
.full img { width: auto; }
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

// Scripts are well-formed as XML, too: without the characters that markup begins with. Pictures in
// turn are those that the page has; a click shows one in all its pixels, as a link to its file does
// where it is not in the page.
constexpr std::string_view kShowScript = R"(
"use strict";
for (const box of document.querySelectorAll(".blink"))
  for (const kind of [".reference", ".actual"])
    box.append(box.closest(".pictures").querySelector(kind + " img").cloneNode());
for (const figure of document.querySelectorAll(".inlined"))
  figure.addEventListener("click", () => figure.classList.toggle("full"));
)";

// What was decided is kept by the page alone until it is saved: with the pictures that are
// approved, if the page has them, so that the file is all that `skerry test approve` needs.
constexpr std::string_view kDecideScript = R"(
"use strict";
const decisions = new Map();
const count = document.querySelector(".decisions output");
const save = document.querySelector(".decisions button");
function png(box, decision) {
  const [head, bytes] = box.closest("section").querySelector(".actual img").src.split(";base64,");
  return decision === "approve" ? { png: bytes } : {};
}
function decide(box, button) {
  const { scene, driver, picture } = box.dataset;
  const decision = button.dataset.decision;
  const withdrawn = decisions.get(scene)?.decision === decision;
  if (withdrawn) decisions.delete(scene);
  else decisions.set(scene, { scene, driver, picture, decision, ...png(box, decision) });
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

/// What of a page's size is left for pictures.
class Room {
 public:
  /// @return whether these bytes have room as well.
  bool take(std::uint64_t bytes) {
    if (bytes == 0) return false;
    const bool fits = bytes <= left_;
    if (fits) left_ -= bytes;
    ++(fits ? inside_ : beside_);
    return fits;
  }
  /// What a reader has to know before the page is sent elsewhere; empty: nothing.
  std::string note() const {
    if (beside_ == 0) return {};
    return measure::labelled(
        "p", "faint",
        fmt::format("The pictures of {} scenes are in this file; those of {} lie beside it.",
                    inside_, beside_));
  }

 private:
  std::uint64_t left_ = kMostInlinedBytes;
  std::size_t inside_ = 0, beside_ = 0;  // scenes
};

/// The pictures of a scene: in the page, or files beside it where there is no room.
class Figures {
 public:
  Figures(const fs::path& folder, const std::string& scene, Room& room)
      : folder_(folder), scene_(scene) {
    std::uint64_t bytes = 0;
    for (const ReportPicture kind : kReportPictures) bytes += bytes_of(kind);
    same_ = has(ReportPicture::kActual) &&
            bytes_of(ReportPicture::kReference) == bytes_of(ReportPicture::kActual) &&
            content(ReportPicture::kReference) == content(ReportPicture::kActual);
    if (same_) bytes /= 2;
    inlined_ = room.take(bytes);
  }

  bool has(ReportPicture kind) const { return bytes_of(kind) > 0; }
  /// Whether the picture is its reference in every byte, so that one is enough.
  bool same() const { return same_; }
  std::string figure(ReportPicture kind, std::string_view caption) const {
    if (!has(kind)) return {};
    const std::string file = address(report_picture_name(scene_, kind));
    std::string css_class(kind == ReportPicture::kReference ? "reference"
                          : kind == ReportPicture::kActual  ? "actual"
                                                            : "error");
    if (!inlined_)
      return with_caption(css_class, link(file, measure::image(file, caption)), caption);
    const std::string bytes = measure::data_address("image/png", content(kind));
    return with_caption(css_class + " inlined", measure::image(bytes, caption), caption);
  }
  /// The two pictures in turn.
  static std::string blink() {
    return with_caption("both", measure::element("div", {{"class", "blink"}}, ""), "blink");
  }

 private:
  fs::path file(ReportPicture kind) const { return folder_ / report_picture_name(scene_, kind); }
  /// 0: there is none.
  std::uint64_t bytes_of(ReportPicture kind) const {
    std::error_code code;
    const std::uintmax_t bytes = fs::file_size(file(kind), code);
    return code ? 0 : bytes;
  }
  std::string content(ReportPicture kind) const {
    Result<std::string> bytes = platform::read_text(file(kind), platform::kMaxPngFileBytes);
    return bytes ? *std::move(bytes) : std::string();
  }
  static std::string with_caption(const std::string& css_class, const std::string& markup,
                                  std::string_view caption) {
    return measure::element("figure", {{"class", css_class}},
                            markup + measure::element("figcaption", measure::escape(caption)));
  }

  const fs::path& folder_;
  const std::string& scene_;
  bool same_ = false, inlined_ = false;
};

std::string pictures_of(const Row& row, const fs::path& folder, Room& room) {
  const Figures figures(folder, row.scene, room);
  const bool approved = row.verdict == Verdict::kApproved;
  std::string out;
  if (figures.same()) {
    out = figures.figure(ReportPicture::kActual, "reference and actual, which are equal");
  } else {
    out = figures.figure(ReportPicture::kReference, approved ? "reference before" : "reference") +
          figures.figure(ReportPicture::kActual, approved ? "reference now" : "actual");
  }
  out += figures.figure(ReportPicture::kDifference, "difference, 8 times");
  out += figures.figure(ReportPicture::kFlip, "FLIP");
  if (figures.has(ReportPicture::kDifference)) out += Figures::blink();
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
         measure::element("script", kDecideScript);
}

/// What pictures need to be looked at, if there are any.
std::string show_script(std::string_view sections) {
  if (sections.find("<figure") == std::string_view::npos) return {};
  return measure::element("script", kShowScript);
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

std::string section(const Row& row, const fs::path& folder, const History* history, Room& room) {
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
  out += pictures_of(row, folder, room);
  if (!row.command.empty())
    out += measure::element("p", measure::element("code", measure::escape(row.command)) + " on " +
                                     measure::escape(row.driver));
  return measure::element("section", out) + "\n";
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
  Room room;
  for (const Row* row : rows) {
    table.push_back(table_row(*row, history));
    sections += section(*row, folder, history, room);
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
                                  measure::table(headings, table) + room.note() + sections +
                                  show_script(sections) + decisions_bar(sections));
}

}  // namespace skerry::tools
