#include "tools/skerry/report/write_topic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/core/output.h"
#include "tools/measure/chart.h"
#include "tools/measure/html.h"

namespace skerry::tools {
namespace {

using measure::element;
using measure::escape;
using measure::labelled;
using nlohmann::ordered_json;

constexpr std::uint32_t kThumbnailWidth = 480;  ///< pixels, at most

std::string field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, " "));
}

std::string csv_line(std::string_view scene, int frames, const PointRow& row) {
  const PictureErrors& e = row.errors;
  const std::string from_reference =
      row.from_reference ? fmt::format("{}", *row.from_reference) : "";
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", field(scene),
                     field(row.point->label), field(row.point->settings), row.ms.median, row.ms.p10,
                     row.ms.p90, frames, e.flip_mean, e.flip_p99, e.hdr_flip_mean, e.rel_mse,
                     e.psnr_db, row.change, from_reference, row.same_bytes ? 1 : 0,
                     field(joined(row.defaults)), field(name_of(row.standing)));
}

ordered_json row_json(const PointRow& row) {
  const PictureErrors& e = row.errors;
  return {{"point", row.point->label},
          {"settings", row.point->settings},
          {"ms_median", row.ms.median},
          {"ms_p10", row.ms.p10},
          {"ms_p90", row.ms.p90},
          {"flip_mean", e.flip_mean},
          {"flip_p99", e.flip_p99},
          {"hdr_flip_mean", e.hdr_flip_mean},
          {"rel_mse", e.rel_mse},
          {"psnr_db", e.psnr_db},
          {"change_flip_mean", row.change},
          {"reference_flip_mean", row.from_reference ? ordered_json(*row.from_reference) : nullptr},
          {"same_bytes_as_last", row.same_bytes},
          {"default_of", row.defaults},
          {"standing", name_of(row.standing)}};
}

std::string_view judge_name(Judge judge) {
  switch (judge) {
    case Judge::kReference:
      return "the CPU reference";
    case Judge::kLimit:
    case Judge::kLimitAndReference:
      return "the most exact point of the sweep";
    case Judge::kEqual:
      return "the last point, to be equal";
  }
  return "";
}

std::string_view cost_name(CostOf cost) {
  switch (cost) {
    case CostOf::kFrame:
      return "GPU time of a frame [ms]";
    case CostOf::kShading:
      return "GPU time of a frame that keeps its shadow maps [ms]";
    case CostOf::kUpload:
      return "upload of 8 MiB of chunk meshes [ms]";
    case CostOf::kSkyTables:
      return "CPU time of the sky's tables [ms]";
    case CostOf::kStoredLight:
      return "CPU time of the light on surfaces [ms]";
  }
  return "";
}

/// Short where a default is that of all levels.
std::vector<std::string> chart_defaults(const PointRow& row) {
  constexpr std::size_t kLevels = 4;
  if (row.defaults.size() == kLevels) return {"all levels"};
  return row.defaults;
}

measure::Mark mark_of(Standing standing) {
  switch (standing) {
    case Standing::kOnFront:
      return measure::Mark::kGood;
    case Standing::kWithinNoise:
      return measure::Mark::kDoubtful;
    case Standing::kOffFront:
      return measure::Mark::kWrong;
  }
  return measure::Mark::kGood;
}

std::string number(double value) {
  if (std::isinf(value)) return "\xe2\x88\x9e";
  return fmt::format("{:.4g}", value);
}

std::string standing_cell(Standing standing) {
  switch (standing) {
    case Standing::kOnFront:
      return "on";
    case Standing::kWithinNoise:
      return "off?";
    case Standing::kOffFront:
      return "off";
  }
  return "";
}

std::string rows_table(const std::vector<PointRow>& rows) {
  constexpr std::string_view kHeadings[] = {
      "setting", "ms median", "p10",    "p90",       "FLIP mean", "FLIP p99",   "HDR-FLIP",
      "relMSE",  "PSNR dB",   "change", "reference", "bytes",     "default of", "front"};
  std::vector<measure::TableRow> lines;
  for (const PointRow& row : rows) {
    const PictureErrors& e = row.errors;
    measure::TableRow line;
    line.cells = {element("code", escape(row.point->label)),
                  fmt::format("{:.3f}", row.ms.median),
                  fmt::format("{:.3f}", row.ms.p10),
                  fmt::format("{:.3f}", row.ms.p90),
                  number(e.flip_mean),
                  number(e.flip_p99),
                  number(e.hdr_flip_mean),
                  number(e.rel_mse),
                  number(e.psnr_db),
                  number(row.change),
                  row.from_reference ? number(*row.from_reference) : "",
                  row.same_bytes ? "equal" : "differ",
                  escape(fmt::format("{}", fmt::join(row.defaults, ", "))),
                  standing_cell(row.standing)};
    if (!row.defaults.empty())
      line.css_class = row.standing == Standing::kOnFront    ? "mark good"
                       : row.standing == Standing::kOffFront ? "mark bad"
                                                             : "mark warn";
    lines.push_back(std::move(line));
  }
  return measure::table(kHeadings, lines);
}

/// A picture's file, and what stands below it.
struct Figure {
  std::string name;  ///< of the file, without ".png"
  std::string caption;
};

/// The pictures of a scene, kind by kind.
struct Figures {
  std::vector<Figure> shown, flips, differences;
};

Figures figures_of(const Topic& topic, const SceneRows& scene) {
  Figures out;
  const std::string stem = fmt::format("{}-{}", topic.name, scene.scene);
  if (scene.files.reference) out.shown.push_back({stem + "-reference", "CPU reference"});
  for (std::size_t p = 0; p < scene.rows.size(); ++p) {
    const PointRow& row = scene.rows[p];
    const std::string note =
        row.defaults.empty() ? "" : fmt::format(" (default: {})", fmt::join(row.defaults, ", "));
    const std::string label = std::string(row.point->label) + note;
    const std::string name = fmt::format("{}-{}", stem, p);
    out.shown.push_back({name, label});
    out.flips.push_back(
        {name + "-flip", fmt::format("{}: FLIP {:.4f}", label, row.errors.flip_mean)});
    out.differences.push_back({name + "-difference", label});
  }
  return out;
}

std::string small_name(const std::string& name) {
  return name + "-small.png";
}

/// Writes a picture and, when it is large, a smaller one to show on the page.
Result<void> write_picture(const std::filesystem::path& dir, const std::string& name,
                           const measure::Image& picture) {
  if (Result<void> done = measure::write_image(dir / (name + ".png"), picture); !done) return done;
  if (picture.width <= kThumbnailWidth) return {};
  const std::uint32_t factor = (picture.width + kThumbnailWidth - 1) / kThumbnailWidth;
  return measure::write_image(dir / small_name(name), measure::shrink(picture, factor));
}

std::string pictures_grid(const SceneRows& scene, const std::vector<Figure>& figures) {
  std::string out;
  for (const Figure& one : figures) {
    const std::string file = one.name + ".png";
    out += measure::figure(scene.files.width <= kThumbnailWidth ? file : small_name(one.name), file,
                           one.caption);
  }
  return element("div", {{"class", "pictures"}}, out) + "\n";
}

std::string scene_part(const Topic& topic, const SceneRows& scene) {
  const ReportScene* known = find_report_scene(scene.scene);
  std::string out = element("h3", escape(fmt::format("Scene {}{}{}", scene.scene, known ? ": " : "",
                                                     known ? known->meaning : "")));
  out += element("p", element("code", escape(scene.command)));
  if (scene.files.reference)
    out += labelled("p", "faint",
                    fmt::format("Standard error of the reference: {:.3g} of its mean radiance.",
                                scene.reference_standard_error));
  out += rows_table(scene.rows);
  const Figures figures = figures_of(topic, scene);
  out += pictures_grid(scene, figures.shown);
  if (scene.files.all_equal) return out + labelled("p", "good", "No picture differs in any byte.");
  out += labelled("p", "faint", "FLIP: black 0, white 1") + pictures_grid(scene, figures.flips);
  return out + labelled("p", "faint", "Difference of the encoded bytes, 8 times") +
         pictures_grid(scene, figures.differences);
}

}  // namespace

std::string topic_csv(const TopicResult& result) {
  std::string out =
      "scene,point,settings,ms_median,ms_p10,ms_p90,frames,flip_mean,flip_p99,hdr_flip_mean,"
      "rel_mse,psnr_db,change_flip_mean,reference_flip_mean,same_bytes_as_last,default_of,"
      "standing\n";
  int frames = 0;
  for (const SceneRows& scene : result.scenes) {
    for (const PointRow& row : scene.rows) out += csv_line(scene.scene, scene.frames, row);
    frames += scene.frames;
  }
  for (const PointRow& row : result.rows) out += csv_line("all", frames, row);
  return out;
}

ordered_json topic_json(const TopicResult& result) {
  const Topic& topic = *result.topic;
  ordered_json j{{"topic", topic.name},
                 {"meaning", topic.meaning},
                 {"judged_by", judge_name(topic.judge)},
                 {"time", cost_name(topic.cost)}};
  j["rows"] = ordered_json::array();
  for (const PointRow& row : result.rows) j["rows"].push_back(row_json(row));
  j["scenes"] = ordered_json::array();
  for (const SceneRows& scene : result.scenes) {
    ordered_json s{{"scene", scene.scene},
                   {"command", scene.command},
                   {"frames", scene.frames},
                   {"reference_standard_error",
                    scene.files.reference ? ordered_json(scene.reference_standard_error) : nullptr},
                   {"rows", ordered_json::array()}};
    for (const PointRow& row : scene.rows) s["rows"].push_back(row_json(row));
    j["scenes"].push_back(std::move(s));
  }
  j["defects"] = ordered_json::array();
  for (const Defect& defect : defects_of(result))
    j["defects"].push_back({{"text", defect.text}, {"certain", defect.certain}});
  return j;
}

std::string topic_svg(const TopicResult& result) {
  const Topic& topic = *result.topic;
  measure::Chart chart;
  chart.title = fmt::format("{}: {}", topic.name, topic.meaning);
  chart.time_label = fmt::format("{}, median and p10 to p90", cost_name(topic.cost));
  chart.error_label = fmt::format("mean FLIP against {}", judge_name(topic.judge));
  for (const PointRow& row : result.rows)
    chart.points.push_back({std::string(row.point->label), row.ms.median, row.ms.p10, row.ms.p90,
                            row.errors.flip_mean, chart_defaults(row), mark_of(row.standing)});
  return measure::svg_chart(chart);
}

std::vector<Defect> defects_of(const TopicResult& result) {
  std::vector<Defect> defects;
  for (const PointRow& row : result.rows) {
    if (!row.defaults.empty() && row.standing != Standing::kOnFront) {
      const PointRow& better =
          *std::ranges::min_element(result.rows, {}, [&row](const PointRow& other) {
            const bool beats = other.ms.median <= row.ms.median &&
                               other.errors.flip_mean <= row.errors.flip_mean && &other != &row;
            return std::tuple(!beats, other.errors.flip_mean, other.ms.median);
          });
      defects.push_back(
          {fmt::format("{}: the default '{}' of {} is {}: {:.3f} ms and FLIP {:.5f}, while '{}' "
                       "takes {:.3f} ms at FLIP {:.5f}",
                       result.topic->name, row.point->label, fmt::join(row.defaults, ", "),
                       name_of(row.standing), row.ms.median, row.errors.flip_mean,
                       better.point->label, better.ms.median, better.errors.flip_mean),
           row.standing == Standing::kOffFront});
    }
    if (result.topic->judge == Judge::kEqual && !row.same_bytes)
      defects.push_back(
          {fmt::format("{}: the picture of '{}' must equal that of '{}' and does not",
                       result.topic->name, row.point->label, result.rows.back().point->label)});
  }
  return defects;
}

Result<void> write_pictures(const Topic& topic, SceneRows& scene,
                            const std::filesystem::path& dir) {
  scene.files.width = scene.pictures.front().shown.width;
  scene.files.reference = scene.reference.has_value();
  scene.files.all_equal = std::ranges::all_of(scene.pictures, [](const PointPictures& pictures) {
    return std::ranges::all_of(pictures.difference.rgba, [i = 0u](std::uint8_t byte) mutable {
      return i++ % 4 == 3 || byte == 0;
    });
  });
  const Figures figures = figures_of(topic, scene);
  const std::size_t first = scene.reference ? 1 : 0;
  if (scene.reference)
    if (Result<void> done = write_picture(dir, figures.shown[0].name, *scene.reference); !done)
      return done;
  for (std::size_t p = 0; p < scene.pictures.size(); ++p) {
    const PointPictures& pictures = scene.pictures[p];
    const std::pair<const std::string&, const measure::Image&> files[] = {
        {figures.shown[first + p].name, pictures.shown},
        {figures.flips[p].name, pictures.flip},
        {figures.differences[p].name, pictures.difference}};
    for (const auto& [name, picture] : files)
      if (Result<void> done = write_picture(dir, name, picture); !done) return done;
  }
  return {};
}

std::vector<std::string> picture_files(const Topic& topic, const SceneRows& scene) {
  const Figures figures = figures_of(topic, scene);
  std::vector<std::string> files;
  for (const auto* kind : {&figures.shown, &figures.flips, &figures.differences}) {
    for (const Figure& one : *kind) {
      files.push_back(one.name + ".png");
      if (scene.files.width > kThumbnailWidth) files.push_back(small_name(one.name));
    }
  }
  return files;
}

Result<std::string> write_topic(const TopicResult& result, const std::filesystem::path& dir) {
  const Topic& topic = *result.topic;
  const std::string name(topic.name);
  if (Result<void> done = write_text(dir / (name + ".csv"), topic_csv(result)); !done)
    return done.error();
  if (Result<void> done = write_text(dir / (name + ".json"), topic_json(result).dump(2) + "\n");
      !done)
    return done.error();
  const std::string chart = topic_svg(result);
  if (Result<void> done = write_text(dir / (name + ".svg"), chart); !done) return done.error();

  std::string out = element("h2", {{"id", name}}, escape(name)) + "\n";
  out +=
      element("p", escape(fmt::format("{}. Errors are against {}; times are the {}.", topic.meaning,
                                      judge_name(topic.judge), cost_name(topic.cost))));
  for (const Defect& defect : defects_of(result))
    out += labelled("p", defect.certain ? "bad" : "warn", defect.text) + "\n";
  out +=
      measure::image(measure::data_address("image/svg+xml", chart), name + ": error against time") +
      "\n";
  if (result.scenes.size() > 1) out += rows_table(result.rows);
  out += fmt::format(
      "<p class=\"faint\"><a href=\"{0}.csv\">{0}.csv</a>, <a href=\"{0}.json\">{0}.json</a>. "
      "Change: mean FLIP "
      "against the last setting. Front off?: something beats it, but their times overlap.</p>\n",
      escape(name));
  for (const SceneRows& scene : result.scenes) out += scene_part(topic, scene);
  return out;
}

}  // namespace skerry::tools
