#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "tools/measure/image.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/report/report_session.h"
#include "tools/skerry/report/topics.h"

namespace skerry::tools {

/// How far a picture is from the one it is judged by.
struct PictureErrors {
  double flip_mean = 0.0, flip_p99 = 0.0;  ///< of the pictures as shown
  double hdr_flip_mean = 0.0;              ///< of radiance
  double rel_mse = 0.0, psnr_db = 0.0;     ///< of radiance; psnr_db is infinite for equal ones
};

/// Whether a setting is worth its time.
enum class Standing : std::uint8_t {
  kOnFront,      ///< nothing is both faster and no worse, or better and no slower
  kWithinNoise,  ///< something is, but the spreads of their times overlap
  kOffFront      ///< something is, beyond the spread of the times
};

/// One point in one scene, or in all of them.
struct PointRow {
  const TopicPoint* point = nullptr;
  Spread ms;
  PictureErrors errors;
  double change = 0.0;                   ///< FLIP mean against the sweep's last point
  std::optional<double> from_reference;  ///< FLIP mean against the CPU reference, if there is one
  bool same_bytes = false;               ///< as the last point's picture
  Standing standing = Standing::kOnFront;
  std::vector<std::string> defaults;  ///< quality levels
};

struct PointPictures {
  measure::Image shown, flip, difference;
};

/// What files a scene's pictures are in (write_pictures).
struct PictureFiles {
  std::uint32_t width = 0;  ///< pixels
  bool reference = false;
  bool all_equal = false;  ///< no picture differs in any byte from its judge's
};

struct SceneRows {
  std::string scene;
  std::string command;                  ///< draws the scene with its own settings
  int frames = 0;                       ///< timed for each point
  std::vector<PointRow> rows;           ///< in the topic's order
  std::vector<PointPictures> pictures;  ///< alike
  std::optional<measure::Image> reference;
  double reference_standard_error = 0.0;  ///< of its radiance
  PictureFiles files;                     ///< of the pictures, once they are written
};

struct TopicResult {
  const Topic* topic = nullptr;
  std::vector<SceneRows> scenes;
  /// Over the scenes: times and errors are means, flip_p99 the largest, psnr_db the least.
  std::vector<PointRow> rows;
};

/// The last picture of a point, and what it took.
struct Shot {
  measure::Image shown;
  measure::Picture radiance;
  double exposure_ev = 0.0;
};

/// Adds a row and pictures a point. @param shots, ms in the topic's order. @param reference what
/// Judge::kReference and kLimitAndReference compare with; else nullptr.
void finish_rows(const Topic& topic, const std::vector<Shot>& shots,
                 const std::vector<std::vector<double>>& ms, const Judged* reference,
                 SceneRows& out);

/// Draws every point of a topic in a scene, times them in turns, so that what else the machine does
/// hits all alike, and compares. @param name of scenes_of(). @param progress receives 0..1 and what
/// is being done.
Result<SceneRows> measure_scene(ReportSession& session, const Topic& topic, const std::string& name,
                                const std::function<void(double, std::string_view)>& progress);

/// Adds what holds over all scenes. @pre there is one.
TopicResult over_scenes(const Topic& topic, std::vector<SceneRows> scenes);

/// Fills in `standing` of rows that compete with each other.
void judge_standing(std::vector<PointRow>& rows);

/// "on the front", ...
std::string_view name_of(Standing standing);

}  // namespace skerry::tools
