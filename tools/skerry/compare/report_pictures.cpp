#include "tools/skerry/compare/report_pictures.h"

#include <fmt/format.h>

#include "tools/measure/image.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr int kAmplification = 8;

measure::Image image_of(const platform::PngImage& picture) {
  return {picture.width, picture.height, picture.pixels};
}

}  // namespace

std::string report_picture_name(const std::string& scene, ReportPicture kind) {
  constexpr const char* kEndings[] = {"reference", "actual", "difference", "flip"};
  return fmt::format("{}.{}.png", scene, kEndings[static_cast<std::size_t>(kind)]);
}

bool same_size(const platform::PngImage& a, const platform::PngImage& b) {
  return a.width == b.width && a.height == b.height;
}

Result<void> write_report_pictures(const std::optional<fs::path>& folder, const std::string& scene,
                                   const ShownPair& pair) {
  if (!folder) return {};
  const auto path = [&](ReportPicture kind) { return *folder / report_picture_name(scene, kind); };
  std::error_code code;
  for (const ReportPicture kind : kReportPictures) fs::remove(path(kind), code);
  const auto write = [&](ReportPicture kind, std::uint32_t width, std::uint32_t height,
                         const std::vector<std::uint8_t>& rgba) {
    return platform::write_png(path(kind), {width, height, 4, rgba});
  };
  const auto copy = [&](ReportPicture kind, const platform::PngImage* picture) {
    return picture ? write(kind, picture->width, picture->height, picture->pixels) : Result<void>();
  };
  if (auto done = copy(ReportPicture::kActual, pair.actual); !done) return done;
  if (auto done = copy(ReportPicture::kReference, pair.reference); !done) return done;
  if (!pair.compared || pair.compared->difference.equal()) return {};
  const Shift shift = pair.compared->shift.value_or(Shift{});
  const measure::Image difference = measure::amplified_difference(
      image_of(*pair.reference), image_of(moved(*pair.actual, shift)), kAmplification);
  if (auto done =
          write(ReportPicture::kDifference, difference.width, difference.height, difference.rgba);
      !done)
    return done;
  const measure::Image heat = measure::heat_map(pair.compared->flip);
  return write(ReportPicture::kFlip, heat.width, heat.height, heat.rgba);
}

}  // namespace skerry::tools
