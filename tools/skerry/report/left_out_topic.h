#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "tools/skerry/report/write_topic.h"
#include "tools/skerry/scene/left_out.h"

namespace skerry::tools {

/// The topic that sweeps nothing: scenes without a feature, drawn by the renderer as it is and by
/// one that has none of the feature. Its scenes and sizes are its own.
inline constexpr std::string_view kLeftOutTopic = "left_out";
inline constexpr std::string_view kLeftOutMeaning = "what a scene does not have must cost nothing";

/// How many frames each side of a row is timed for.
inline constexpr int kLeftOutFrames = 9;

/// A row that is not equal in picture and counts on both sides.
std::vector<Defect> defects_of(const std::vector<LeftOutRow>& rows);

std::string left_out_csv(const std::vector<LeftOutRow>& rows);
nlohmann::ordered_json left_out_json(const std::vector<LeftOutRow>& rows);
/// Writes left_out.csv and left_out.json. @return the page's part, as markup.
Result<std::string> write_left_out(const std::vector<LeftOutRow>& rows,
                                   const std::filesystem::path& dir);

}  // namespace skerry::tools
