#include "tools/skerry/test/judge.h"

#include <fmt/format.h>

#include <array>

#include "engine/platform/files.h"
#include "tools/skerry/compare/report_pictures.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDriverText = "Driver";

std::string driver_of(const platform::PngImage& picture) {
  for (const platform::PngText& text : picture.text) {
    if (text.key == kDriverText) return text.text;
  }
  return {};
}

platform::PixelView view_of(const platform::PngImage& picture) {
  return {picture.width, picture.height, 4, picture.pixels};
}

/// What keeps a picture from being right whatever the reference shows; empty if nothing does.
std::string flaw(const TestScene& scene, const Shown& shown) {
  if (shown.non_finite != 0)
    return fmt::format("{} pixels were not finite in some pass", shown.non_finite);
  if (is_black(shown.picture) && !scene.expected.expects_dark)
    return "the picture is black; if it should be, declare expects_dark in the scene";
  return {};
}

/// Fills in the row's verdict from the reference.
void pass_or_fail(Row& row, const TestScene& scene, const Result<platform::PngImage>& reference,
                  const Shown& shown) {
  const platform::PngImage& picture = shown.picture;
  if (!reference) {
    std::error_code code;
    row.message = fs::exists(scene.reference(shown.driver), code)
                      ? reference.error().message
                      : "there is no reference yet; look at the picture, then approve it";
    return;
  }
  if (!same_size(*reference, picture)) {
    row.message = fmt::format("the reference has {}x{} pixels, the picture {}x{}", reference->width,
                              reference->height, picture.width, picture.height);
    return;
  }
  if (row.hash_equal != true) row.message = beyond(*row.found, row.parts, scene.expected);
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
  if (foreign && beyond(*row.found, row.parts, scene.expected).empty())
    return std::string("within the tolerance of another driver's reference; its hash is approved");
  const std::array<platform::PngText, 3> text{{{"Software", "Skerry"},
                                               {"Command", game::shot_command(scene.scene)},
                                               {std::string(kDriverText), shown.driver}}};
  if (const auto made = platform::make_dirs(scene.approved(shown.driver)); !made)
    return made.error();
  const Result<void> written =
      platform::write_png(scene.reference(shown.driver), view_of(shown.picture), text);
  if (!written) return written.error();
  outcome.replaced = true;
  if (!comparable) return std::string("a new reference");
  return fmt::format("a changed reference, off by up to {} of 255", row.found->largest);
}

}  // namespace

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
  row.picture = outcome.hash;
  const auto known = approved.find(scene.name);
  if (known != approved.end()) row.hash_equal = known->second == outcome.hash;

  const Result<platform::PngImage> reference = scene.read_reference(shown.driver);
  std::optional<Comparison> compared;
  if (reference && same_size(*reference, shown.picture)) {
    compared = compare(*reference, shown.picture, scene.expected);
    row.take(*compared);
  }
  const Result<void> written = write_report_pictures(
      options.html, scene.name,
      {reference ? &*reference : nullptr, &shown.picture, compared ? &*compared : nullptr});

  row.message = flaw(scene, shown);
  if (row.message.empty()) pass_or_fail(row, scene, reference, shown);
  row.sound = flaw(scene, shown).empty();
  if (options.approve && row.sound && (row.failed() || row.hash_equal != true)) {
    const Result<std::string> done = approve(scene, shown, reference, row, outcome);
    row.verdict = done ? Verdict::kApproved : Verdict::kFail;
    row.message = done ? *done : done.error().message;
  }
  if (!written) {
    row.verdict = Verdict::kFail;
    row.message = written.error().message;
  }
  row.failed_runs = row.failed() ? 1 : 0;
  return outcome;
}

Result<void> store_hash(const TestScene& scene, const Outcome& outcome) {
  const fs::path folder = scene.approved(outcome.row.driver);
  const fs::path file = hash_file(folder, outcome.row.driver);
  Result<Hashes> hashes = read_hashes(file, scene.unpacked);
  if (!hashes) return hashes.error();
  (*hashes)[scene.name] = outcome.hash;
  if (const auto written = write_hashes(file, *hashes); !written) return written;
  if (!outcome.replaced) return {};
  return remove_others(folder, outcome.row.driver, scene.name, scene.unpacked);
}

}  // namespace skerry::tools
