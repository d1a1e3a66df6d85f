#include "tools/skerry/test/judge.h"

#include <fmt/format.h>

#include <array>

#include "tools/measure/image.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDriverText = "Driver";
constexpr int kAmplification = 8;

std::string driver_of(const platform::PngImage& picture) {
  for (const platform::PngText& text : picture.text) {
    if (text.key == kDriverText) return text.text;
  }
  return {};
}

bool same_size(const platform::PngImage& a, const platform::PngImage& b) {
  return a.width == b.width && a.height == b.height;
}

platform::PixelView view_of(const platform::PngImage& picture) {
  return {picture.width, picture.height, 4, picture.pixels};
}

measure::Image image_of(const platform::PngImage& picture) {
  return {picture.width, picture.height, picture.pixels};
}

/// Writes what a report shows of a scene, and takes away what an older report has left.
class ReportWriter {
 public:
  ReportWriter(const std::optional<fs::path>& folder, std::string scene)
      : folder_(folder), scene_(std::move(scene)) {
    std::error_code code;
    for (const ReportPicture kind : kReportPictures) {
      if (folder_) fs::remove(path(kind), code);
    }
  }

  void write(ReportPicture kind, const platform::PixelView& picture) {
    if (!folder_) return;
    const Result<void> written = platform::write_png(path(kind), picture);
    if (!written && error_.empty()) error_ = written.error().message;
  }
  const std::string& error() const { return error_; }

 private:
  fs::path path(ReportPicture kind) const { return *folder_ / report_picture_name(scene_, kind); }

  const std::optional<fs::path>& folder_;
  std::string scene_;
  std::string error_;
};

/// What keeps a picture from being right whatever the reference shows; empty if nothing does.
std::string flaw(const TestScene& scene, const Shown& shown) {
  if (shown.non_finite != 0)
    return fmt::format("{} pixels were not finite in some pass", shown.non_finite);
  if (is_black(shown.picture) && !scene.expected.expects_dark)
    return "the picture is black; if it should be, declare expects_dark in the scene";
  return {};
}

/// Fills in the row's verdict from the reference. @param reference of the picture's size.
void pass_or_fail(Row& row, const TestScene& scene, const Result<platform::PngImage>& reference,
                  const platform::PngImage& picture) {
  if (!reference) {
    std::error_code code;
    row.message = fs::exists(scene.reference(), code)
                      ? reference.error().message
                      : "there is no reference yet; look at the picture, then approve it";
    return;
  }
  if (!same_size(*reference, picture)) {
    row.message = fmt::format("the reference has {}x{} pixels, the picture {}x{}", reference->width,
                              reference->height, picture.width, picture.height);
    return;
  }
  if (row.hash_equal != true) row.message = beyond(*row.found, scene.expected.tolerance);
  if (row.message.empty()) row.verdict = Verdict::kPass;
}

/// Makes the picture the reference. @return what was done, or why not.
Result<std::string> approve(const TestScene& scene, const Shown& shown,
                            const Result<platform::PngImage>& reference, const Row& row,
                            Outcome& outcome) {
  const bool comparable = reference && same_size(*reference, shown.picture);
  if (comparable && row.found->equal()) return std::string("its hash is approved");
  const std::string driver = reference ? driver_of(*reference) : std::string();
  const bool foreign = comparable && !driver.empty() && driver != shown.driver;
  if (foreign && beyond(*row.found, scene.expected.tolerance).empty())
    return std::string("within the tolerance of another driver's reference; its hash is approved");
  const std::array<platform::PngText, 3> text{{{"Software", "Skerry"},
                                               {"Command", game::shot_command(scene.scene)},
                                               {std::string(kDriverText), shown.driver}}};
  const Result<void> written = platform::write_png(scene.reference(), view_of(shown.picture), text);
  if (!written) return written.error();
  outcome.replaced = true;
  if (!comparable) return std::string("a new reference");
  return fmt::format("a changed reference, off by up to {} of 255", row.found->largest);
}

void write_report(ReportWriter& writer, const platform::PngImage* reference,
                  const platform::PngImage& picture, const std::optional<Comparison>& compared) {
  writer.write(ReportPicture::kActual, view_of(picture));
  if (reference) writer.write(ReportPicture::kReference, view_of(*reference));
  if (!compared || compared->difference.equal()) return;
  const measure::Image difference =
      measure::amplified_difference(image_of(*reference), image_of(picture), kAmplification);
  const measure::Image heat = measure::heat_map(compared->flip);
  writer.write(ReportPicture::kDifference, {picture.width, picture.height, 4, difference.rgba});
  writer.write(ReportPicture::kFlip, {picture.width, picture.height, 4, heat.rgba});
}

}  // namespace

std::string report_picture_name(const std::string& scene, ReportPicture kind) {
  constexpr const char* kEndings[] = {"reference", "actual", "difference", "flip"};
  return fmt::format("{}.{}.png", scene, kEndings[static_cast<std::size_t>(kind)]);
}

Row failed_row(const TestScene& scene, std::string why) {
  Row row;
  row.scene = scene.name;
  row.message = std::move(why);
  row.command = game::shot_command(scene.scene);
  row.failed_runs = 1;
  return row;
}

Outcome judge(const TestScene& scene, const Shown& shown, const Hashes& approved,
              const JudgeOptions& options) {
  Outcome outcome{failed_row(scene, {}), sha256_hex(shown.picture.pixels), false};
  Row& row = outcome.row;
  row.driver = shown.driver;
  row.pictures = 1;
  const auto known = approved.find(scene.name);
  if (known != approved.end()) row.hash_equal = known->second == outcome.hash;

  const Result<platform::PngImage> reference = platform::read_png(scene.reference());
  std::optional<Comparison> compared;
  if (reference && same_size(*reference, shown.picture)) {
    compared = compare(*reference, shown.picture, scene.expected);
    row.found = compared->difference;
  }
  ReportWriter writer(options.html, scene.name);
  write_report(writer, reference ? &*reference : nullptr, shown.picture, compared);

  row.message = flaw(scene, shown);
  if (row.message.empty()) pass_or_fail(row, scene, reference, shown.picture);
  const bool sound = flaw(scene, shown).empty();
  if (options.approve && sound && (row.failed() || row.hash_equal != true)) {
    const Result<std::string> done = approve(scene, shown, reference, row, outcome);
    row.verdict = done ? Verdict::kApproved : Verdict::kFail;
    row.message = done ? *done : done.error().message;
  }
  if (!writer.error().empty()) {
    row.verdict = Verdict::kFail;
    row.message = writer.error();
  }
  row.failed_runs = row.failed() ? 1 : 0;
  return outcome;
}

}  // namespace skerry::tools
