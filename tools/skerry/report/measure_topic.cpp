#include "tools/skerry/report/measure_topic.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "tools/measure/flip.h"
#include "tools/measure/metrics.h"
#include "tools/measure/pareto.h"
#include "tools/skerry/bench/bench_upload.h"
#include "tools/skerry/scene/draw_scene.h"

namespace skerry::tools {
namespace {

constexpr int kSettlingFrames = 2, kTimedFrames = 3;  ///< of a point, before the next one's turn
constexpr int kMinRounds = 3, kMaxRounds = 10;
constexpr double kTimingMs = 1500.0;  ///< to spend on a scene's timing when frames are quick
constexpr int kDifferenceGain = 8;

/// By game::UploadMode.
constexpr gpu::UploadPath kUploadPaths[] = {gpu::UploadPath::kUpdateBuffer,
                                            gpu::UploadPath::kStaging, gpu::UploadPath::kMapped};

using Progress = std::function<void(double, std::string_view)>;

/// The points of a topic in one scene, each ready to be drawn again.
class Sweep {
 public:
  static Result<Sweep> create(ReportSession& session, const Topic& topic,
                              const game::SceneOptions& scene) {
    Sweep sweep;
    for (const TopicPoint& point : topic.points) {
      game::SceneOptions options = scene;
      if (Result<void> done = apply_point(point.settings, options.settings); !done)
        return done.error();
      if (topic.loads || sweep.drawers_.empty()) {
        Result<std::unique_ptr<SceneDrawer>> drawer =
            SceneDrawer::create(session.device(), options, &session.cache());
        if (!drawer) return drawer.error();
        sweep.drawers_.push_back(*std::move(drawer));
      }
      sweep.settings_.push_back(options.settings);
    }
    return sweep;
  }

  /// @param exposure_ev of the picture; none: as the point's settings say.
  Result<Shot> draw(std::size_t point, std::optional<double> exposure_ev) {
    SceneDrawer& chosen = drawer(point);
    if (exposure_ev) chosen.view().settings().exposure_ev = exposure_ev;
    Result<Drawn> drawn = chosen.draw(true);
    if (!drawn) return drawn.error();
    if (drawn->report.pixels.non_finite != 0)
      return Error{
          fmt::format("{} pixels were not finite in some pass; this is a bug in Skerry or "
                      "the driver",
                      drawn->report.pixels.non_finite)};
    return Shot{{drawn->size.width, drawn->size.height, std::move(drawn->rgba)},
                *std::move(drawn->radiance),
                drawn->report.exposure_ev};
  }

  /// Times of kTimedFrames frames. Those right after the change of setting are drawn and not
  /// counted: they draw anew what later ones keep.
  Result<std::vector<double>> settled_ms(std::size_t point, bool keep_shadows) {
    Result<std::vector<render::FrameReport>> reports =
        drawer(point).time(kSettlingFrames + kTimedFrames, keep_shadows);
    if (!reports) return reports.error();
    std::vector<double> ms;
    for (const render::FrameReport& report : std::span(*reports).subspan(kSettlingFrames))
      ms.push_back(report.gpu_ms);
    return ms;
  }

 private:
  SceneDrawer& drawer(std::size_t point) {
    SceneDrawer& chosen = *drawers_[drawers_.size() == 1 ? 0 : point];
    chosen.view().settings() = settings_[point];
    return chosen;
  }

  std::vector<std::unique_ptr<SceneDrawer>> drawers_;  // one a point, or one for all
  std::vector<game::Settings> settings_;               // by point
};

/// Every point's picture, all at one exposure: a stop's thousandth between two would blur what the
/// topic measures. It is the judge's: the reference's, or the last point's.
Result<std::vector<Shot>> take_shots(Sweep& sweep, const Topic& topic, const Judged* reference,
                                     const std::function<void(double)>& progress) {
  const std::size_t points = topic.points.size();
  std::optional<double> ev;
  if (!topic.own_exposures) {
    if (reference) {
      ev = reference->ev;
    } else {
      const Result<Shot> last = sweep.draw(points - 1, {});
      if (!last) return last.error();
      ev = last->exposure_ev;
    }
  }
  std::vector<Shot> shots;
  for (std::size_t p = 0; p < points; ++p) {
    progress(static_cast<double>(p) / static_cast<double>(points));
    Result<Shot> shot = sweep.draw(p, ev);
    if (!shot) return shot.error();
    shots.push_back(*std::move(shot));
  }
  return shots;
}

/// Frame times of every point, measured in turns.
Result<std::vector<std::vector<double>>> time_frames(Sweep& sweep, const Topic& topic,
                                                     const std::function<void(double)>& progress) {
  const std::size_t points = topic.points.size();
  std::vector<std::vector<double>> ms(points);
  double round_ms = 0.0;  // of the round that warms up
  int rounds = 0;
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t p = 0; p < points; ++p) {
      const Result<std::vector<double>> frames =
          sweep.settled_ms(p, topic.cost == CostOf::kShading);
      if (!frames) return frames.error();
      if (round < 0)
        round_ms += frames->front() * (kSettlingFrames + kTimedFrames);
      else
        ms[p].insert(ms[p].end(), frames->begin(), frames->end());
    }
    if (round < 0)
      rounds =
          std::clamp(static_cast<int>(kTimingMs / std::max(round_ms, 1.0)), kMinRounds, kMaxRounds);
    progress((round + 1.0) / (rounds + 1.0));
  }
  return ms;
}

Result<std::vector<std::vector<double>>> time_uploads(gpu::Device& device, const Topic& topic) {
  std::vector<std::vector<double>> ms;
  for (const TopicPoint& point : topic.points) {
    game::Settings settings;
    if (Result<void> done = apply_point(point.settings, settings); !done) return done.error();
    Result<std::vector<double>> times =
        upload_times(device, kUploadPaths[static_cast<std::size_t>(settings.upload_path)]);
    if (!times) return times.error();
    ms.push_back(*std::move(times));
  }
  return ms;
}

PictureErrors errors_of(const measure::ErrorMap& flip, const measure::Picture& judge,
                        const measure::Picture& radiance) {
  PictureErrors errors;
  errors.flip_mean = measure::mean_of(flip);
  errors.flip_p99 = measure::quantile_of(flip, 0.99);
  errors.hdr_flip_mean = measure::mean_of(
      measure::flip_hdr(judge, radiance, measure::exposure_range(judge, radiance)));
  errors.rel_mse = measure::rel_mse(judge, radiance);
  errors.psnr_db = measure::psnr(judge, radiance);
  return errors;
}

/// Compares every shot with its judge, the reference or the last shot.
/// @param reference nullptr: there is none.
void compare(const std::vector<Shot>& shots, Judge by, const Judged* reference, SceneRows& out) {
  const Shot& limit = shots.back();
  const bool by_reference = by == Judge::kReference;
  const measure::Picture limit_shown = measure::picture_from(limit.shown);
  const measure::Image& judge = by_reference ? reference->shown : limit.shown;
  const measure::Picture judge_shown = measure::picture_from(judge);
  for (std::size_t p = 0; p < shots.size(); ++p) {
    const measure::Picture shown = measure::picture_from(shots[p].shown);
    const measure::ErrorMap flip = measure::flip_ldr(judge_shown, shown);
    PointRow& row = out.rows[p];
    row.errors =
        errors_of(flip, by_reference ? reference->radiance : limit.radiance, shots[p].radiance);
    const auto flip_mean = [&shown](const measure::Picture& from) {
      return measure::mean_of(measure::flip_ldr(from, shown));
    };
    row.change = by_reference ? flip_mean(limit_shown) : row.errors.flip_mean;
    if (reference)
      row.from_reference =
          by_reference ? row.errors.flip_mean : flip_mean(measure::picture_from(reference->shown));
    row.same_bytes = shots[p].shown.rgba == limit.shown.rgba;
    out.pictures.push_back({shots[p].shown, measure::heat_map(flip),
                            measure::amplified_difference(judge, shots[p].shown, kDifferenceGain)});
  }
}

/// One row for all scenes of a point.
PointRow row_over(const std::vector<SceneRows>& scenes, std::size_t p) {
  PointRow sum = scenes.front().rows[p];
  const double share = 1.0 / static_cast<double>(scenes.size());
  for (std::size_t s = 1; s < scenes.size(); ++s) {
    const PointRow& row = scenes[s].rows[p];
    sum.ms.p10 += row.ms.p10;
    sum.ms.median += row.ms.median;
    sum.ms.p90 += row.ms.p90;
    sum.errors.flip_mean += row.errors.flip_mean;
    sum.errors.hdr_flip_mean += row.errors.hdr_flip_mean;
    sum.errors.rel_mse += row.errors.rel_mse;
    sum.errors.flip_p99 = std::max(sum.errors.flip_p99, row.errors.flip_p99);
    sum.errors.psnr_db = std::min(sum.errors.psnr_db, row.errors.psnr_db);
    sum.change += row.change;
    if (sum.from_reference) *sum.from_reference += row.from_reference.value_or(0.0);
    sum.same_bytes = sum.same_bytes && row.same_bytes;
  }
  for (double* value : {&sum.ms.p10, &sum.ms.median, &sum.ms.p90, &sum.errors.flip_mean,
                        &sum.errors.hdr_flip_mean, &sum.errors.rel_mse, &sum.change})
    *value *= share;
  if (sum.from_reference) *sum.from_reference *= share;
  return sum;
}

}  // namespace

Result<SceneRows> measure_scene(ReportSession& session, const Topic& topic, const std::string& name,
                                const Progress& progress) {
  Result<game::SceneOptions> scene = session.scene(name);
  if (!scene) return scene.error();
  SceneRows out{name, game::shot_command(*scene), 0, {}, {}, {}, 0.0, {}};
  const std::string what = fmt::format("{} in {}", topic.name, name);

  const Judged* reference = nullptr;
  if (topic.judge == Judge::kReference || topic.judge == Judge::kLimitAndReference) {
    game::SceneOptions exact = *scene;
    // The renderer samples geometry at pixel centres; smoother edges would drown every other error.
    exact.settings.reference_filter = game::ReferenceFilter::kCentre;
    if (!topic.reference_settings.empty())
      if (Result<void> done = apply_point(topic.reference_settings, exact.settings); !done)
        return done.error();
    Result<const Judged*> made = session.reference(
        exact, [&](double share) { progress(0.3 * share, what + ": reference"); });
    if (!made) return made.error();
    reference = *made;
    out.reference = reference->shown;
    out.reference_standard_error = reference->mean_standard_error;
  }

  Result<Sweep> sweep = Sweep::create(session, topic, *scene);
  if (!sweep) return sweep.error();
  Result<std::vector<Shot>> shots = take_shots(*sweep, topic, reference, [&](double share) {
    progress(0.3 + 0.2 * share, what + ": pictures");
  });
  if (!shots) return shots.error();
  Result<std::vector<std::vector<double>>> ms =
      topic.cost == CostOf::kUpload ? time_uploads(session.device(), topic)
                                    : time_frames(*sweep, topic, [&](double share) {
                                        progress(0.5 + 0.4 * share, what + ": times");
                                      });
  if (!ms) return ms.error();
  progress(0.9, what + ": errors");
  finish_rows(topic, *shots, *ms, reference, out);
  return out;
}

void finish_rows(const Topic& topic, const std::vector<Shot>& shots,
                 const std::vector<std::vector<double>>& ms, const Judged* reference,
                 SceneRows& out) {
  out.frames = static_cast<int>(ms.front().size());
  for (std::size_t p = 0; p < topic.points.size(); ++p) {
    PointRow row;
    row.point = &topic.points[p];
    row.ms = spread_of(ms[p]);
    row.defaults = levels_with_default(topic.points[p]);
    out.rows.push_back(row);
  }
  compare(shots, topic.judge, reference, out);
  judge_standing(out.rows);
}

TopicResult over_scenes(const Topic& topic, std::vector<SceneRows> scenes) {
  TopicResult result{&topic, std::move(scenes), {}};
  for (std::size_t p = 0; p < topic.points.size(); ++p)
    result.rows.push_back(row_over(result.scenes, p));
  judge_standing(result.rows);
  return result;
}

void judge_standing(std::vector<PointRow>& rows) {
  for (PointRow& row : rows) {
    row.standing = Standing::kOnFront;
    for (const PointRow& other : rows) {
      if (!measure::dominates({other.ms.median, other.errors.flip_mean},
                              {row.ms.median, row.errors.flip_mean}))
        continue;
      const Standing found =
          other.ms.p90 < row.ms.p10 ? Standing::kOffFront : Standing::kWithinNoise;
      row.standing = std::max(row.standing, found);
    }
  }
}

std::string_view name_of(Standing standing) {
  switch (standing) {
    case Standing::kOnFront:
      return "on the front";
    case Standing::kWithinNoise:
      return "off the front, within the spread of the times";
    case Standing::kOffFront:
      return "off the front";
  }
  return "";
}

}  // namespace skerry::tools
