#include "tools/skerry/test/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/skerry/test/judge.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStyle = R"(
body { font: 15px/1.4 system-ui, sans-serif; margin: 2em auto; max-width: 90em; padding: 0 1em;
       background: #16181c; color: #e4e4e4; }
h2 { margin: 2em 0 .2em; }
.fail { color: #ff7b6b; } .pass { color: #7fd18b; } .approved { color: #f2c55c; }
figure { display: inline-block; margin: .5em 1em .5em 0; vertical-align: top; }
figcaption { color: #a0a4ab; font-size: 13px; }
img { display: block; image-rendering: pixelated; max-width: 100%; background: #000; }
.blink { position: relative; } .blink img + img { position: absolute; left: 0; top: 0;
         animation: blink 1s steps(1) infinite; }
@keyframes blink { 50% { opacity: 0; } }
code { background: #23262c; padding: .1em .4em; overflow-wrap: anywhere; }
td, th { padding: .1em 1em .1em 0; text-align: left; font-variant-numeric: tabular-nums; }
a { color: inherit; }
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
  return std::isfinite(value) ? fmt::format("{:.5f}", value) : std::string("&infin;");
}

std::string numbers(const Row& row) {
  if (!row.found) return "<td colspan=5>nothing to compare</td>";
  const Difference& d = *row.found;
  return fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>", number(d.flip_mean),
                     number(d.flip_p99), number(d.flip_max), number(d.psnr_db),
                     number(d.pixels_over));
}

std::string_view hash_word(const Row& row) {
  if (!row.hash_equal) return "none approved";
  return *row.hash_equal ? "equal" : "different";
}

std::string table_row(const Row& row) {
  return fmt::format(
      "<tr><td><a href=\"#{}\">{}</a></td><td class={}>{}</td><td>{}</td>{}<td>{:.2f} "
      "s</td></tr>\n",
      address(row.scene), escape_markup(row.scene), verdict_name(row.verdict),
      verdict_name(row.verdict), hash_word(row), numbers(row), row.seconds);
}

class Figures {
 public:
  Figures(const fs::path& folder, const std::string& scene) : folder_(folder), scene_(scene) {}

  bool has(ReportPicture kind) const {
    std::error_code code;
    return fs::exists(folder_ / report_picture_name(scene_, kind), code);
  }
  std::string image(ReportPicture kind) const {
    const std::string source = address(report_picture_name(scene_, kind));
    return fmt::format("<a href=\"{}\"><img src=\"{}\" alt=\"\"></a>", source, source);
  }
  std::string figure(ReportPicture kind, std::string_view caption) const {
    if (!has(kind)) return {};
    return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", image(kind), caption);
  }
  /// The two pictures in turn, one second each way.
  std::string blink() const {
    const auto bare = [this](ReportPicture kind) {
      return fmt::format("<img src=\"{}\" alt=\"\">", address(report_picture_name(scene_, kind)));
    };
    return fmt::format(
        "<figure><div class=blink>{}{}</div><figcaption>blink</figcaption></figure>\n",
        bare(ReportPicture::kReference), bare(ReportPicture::kActual));
  }

 private:
  const fs::path& folder_;
  const std::string& scene_;
};

std::string section(const Row& row, const fs::path& folder) {
  const Figures figures(folder, row.scene);
  std::string out =
      fmt::format("<h2 id=\"{}\">{} <span class={}>{}</span></h2>\n", address(row.scene),
                  escape_markup(row.scene), verdict_name(row.verdict), verdict_name(row.verdict));
  if (!row.message.empty()) out += fmt::format("<p>{}</p>\n", escape_markup(row.message));
  if (row.runs > 1) {
    out += fmt::format("<p>{} of {} runs failed; {} different pictures</p>\n", row.failed_runs,
                       row.runs, row.pictures);
  }
  const bool approved = row.verdict == Verdict::kApproved;
  out += figures.figure(ReportPicture::kReference, approved ? "reference before" : "reference");
  out += figures.figure(ReportPicture::kActual, approved ? "reference now" : "actual");
  out += figures.figure(ReportPicture::kDifference, "difference, 8 times");
  out += figures.figure(ReportPicture::kFlip, "FLIP");
  if (figures.has(ReportPicture::kDifference)) out += figures.blink();
  return out + fmt::format("<p><code>{}</code> on {}</p>\n", escape_markup(row.command),
                           escape_markup(row.driver));
}

int rank(const Row& row) {
  if (row.failed()) return 0;
  return row.verdict == Verdict::kApproved ? 1 : 2;
}

}  // namespace

std::string test_page(const Results& results, const fs::path& folder) {
  std::vector<const Row*> rows;
  for (const Row& row : results.rows) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row* a, const Row* b) { return rank(*a) < rank(*b); });
  std::string table, sections;
  for (const Row* row : rows) {
    table += table_row(*row);
    sections += section(*row, folder);
  }
  const auto failures =
      std::count_if(rows.begin(), rows.end(), [](const Row* row) { return row->failed(); });
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=en><meta charset=utf-8><title>skerry test</title>\n"
      "<style>{}</style>\n<h1>skerry test: {} of {} scenes failed</h1>\n<table>\n"
      "<tr><th>scene<th>verdict<th>hash<th>FLIP mean<th>p99<th>max<th>PSNR<th>pixels over<th>time"
      "</tr>\n{}</table>\n{}</html>\n",
      kStyle, failures, rows.size(), table, sections);
}

}  // namespace skerry::tools
