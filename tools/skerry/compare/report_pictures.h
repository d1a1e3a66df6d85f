// The pictures of a test's report, beside its page.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/core/result.h"
#include "engine/platform/image_file.h"
#include "tools/skerry/compare/verdict.h"

namespace skerry::tools {

/// Kinds of pictures in a report's folder.
enum class ReportPicture : std::uint8_t { kReference, kActual, kDifference, kFlip };
inline constexpr ReportPicture kReportPictures[] = {
    ReportPicture::kReference, ReportPicture::kActual, ReportPicture::kDifference,
    ReportPicture::kFlip};
/// "day.flip.png".
std::string report_picture_name(const std::string& scene, ReportPicture kind);

bool same_size(const platform::PngImage& a, const platform::PngImage& b);

/// Two pictures of one name as a report shows them.
struct ShownPair {
  const platform::PngImage* reference = nullptr;  ///< null: there is none
  const platform::PngImage* actual = nullptr;     ///< likewise
  const Comparison* compared = nullptr;           ///< null: sizes differ, or one is missing
};

/// Writes what a report shows of a pair, and removes what an older report has left of it.
/// @param folder none: nothing is written. Errors: the first picture that could not be written.
Result<void> write_report_pictures(const std::optional<std::filesystem::path>& folder,
                                   const std::string& scene, const ShownPair& pair);

}  // namespace skerry::tools
