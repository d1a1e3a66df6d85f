#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/report/measure_topic.h"

namespace skerry::tools {

/// Every row of a topic, scene by scene and then for all scenes: a header, then numbers that read
/// back as the same doubles ("inf" for infinity). Fields as RFC 4180 has them.
std::string topic_csv(const TopicResult& result);
/// The same; infinity is null.
nlohmann::ordered_json topic_json(const TopicResult& result);
/// Error against time over all scenes.
std::string topic_svg(const TopicResult& result);

/// Something about a topic that should not be so.
struct Defect {
  std::string text;     ///< one line
  bool certain = true;  ///< false: the spread of the times may explain it
};
std::vector<Defect> defects_of(const TopicResult& result);

/// Writes a scene's pictures, NAME-SCENE-*.png, and says in `scene.files` what there is.
/// Errors: those of writing.
Result<void> write_pictures(const Topic& topic, SceneRows& scene, const std::filesystem::path& dir);
/// The names of the files that write_pictures wrote.
std::vector<std::string> picture_files(const Topic& topic, const SceneRows& scene);

/// Writes NAME.csv, NAME.json and NAME.svg below `dir`, where the scenes' pictures are.
/// @return the topic's part of the page, as markup. Errors: those of writing.
Result<std::string> write_topic(const TopicResult& result, const std::filesystem::path& dir);

}  // namespace skerry::tools
