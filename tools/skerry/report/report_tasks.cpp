#include "tools/skerry/report/report_tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "engine/core/clock.h"
#include "game/panorama/load_panorama.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/report/left_out_topic.h"
#include "tools/skerry/report/sky_topic.h"
#include "tools/skerry/report/stored_light_topic.h"
#include "tools/skerry/report/write_topic.h"

namespace skerry::tools {
namespace {

using nlohmann::ordered_json;

Error not_a_record(const Record& record, std::string_view why) {
  return {fmt::format("cannot use the row {}: {}; plan and run its task again", record.task, why)};
}

/// What decides the row of a topic in a scene, but for the topic, which is part of the program.
Result<std::vector<std::string>> inputs_of(const ReportRequest& request, const std::string& name) {
  const Result<game::SceneOptions> scene = requested_scene(request, name);
  if (!scene) return scene.error();
  std::vector<std::string> inputs{game::shot_command(*scene),
                                  request.own_size ? "sized" : "size of the device"};
  std::vector<std::string> files;
  for (const game::CloudFile& cloud : scene->clouds) files.push_back(cloud.path);
  if (const auto panorama = game::panorama_file(*scene)) files.push_back(*panorama);
  if (scene->world) files.push_back(*scene->world);
  if (scene->scene_file) files.push_back(*scene->scene_file);
  for (const std::string& file : files) {
    Result<std::string> hash = file_hash(file);
    if (!hash) return hash.error();
    inputs.push_back(*std::move(hash));
  }
  return inputs;
}

Result<void> add_task(const Topic* topic, const std::string& scene,
                      std::span<const std::string> inputs, ReportTasks& out) {
  const std::string name = fmt::format("{}/{}", topic ? topic->name : kLeftOutTopic, scene);
  Result<std::string> id = task_id("report", name, inputs);
  if (!id) return id.error();
  out.tasks.push_back({{*std::move(id), name}, topic, scene});
  return {};
}

ordered_json point_json(const PointRow& row) {
  const PictureErrors& e = row.errors;
  return {{"flip_mean", any_number(e.flip_mean)},
          {"flip_p99", any_number(e.flip_p99)},
          {"hdr_flip_mean", any_number(e.hdr_flip_mean)},
          {"rel_mse", any_number(e.rel_mse)},
          {"psnr_db", any_number(e.psnr_db)},
          {"change", any_number(row.change)},
          {"from_reference",
           row.from_reference ? any_number(*row.from_reference) : ordered_json(nullptr)},
          {"same_bytes", row.same_bytes}};
}

/// Throws nlohmann's errors.
PointRow point_from(const TopicPoint& point, const ordered_json& from, const ordered_json& ms) {
  PointRow row;
  row.point = &point;
  row.ms.p10 = ms.at("p10").get<double>();
  row.ms.median = ms.at("median").get<double>();
  row.ms.p90 = ms.at("p90").get<double>();
  row.errors = {any_number_from(from.at("flip_mean")), any_number_from(from.at("flip_p99")),
                any_number_from(from.at("hdr_flip_mean")), any_number_from(from.at("rel_mse")),
                any_number_from(from.at("psnr_db"))};
  row.change = any_number_from(from.at("change"));
  if (!from.at("from_reference").is_null())
    row.from_reference = any_number_from(from.at("from_reference"));
  row.same_bytes = from.at("same_bytes").get<bool>();
  row.defaults = levels_with_default(point);
  return row;
}

Result<SceneRows> measured_scene(ReportSession& session, const ReportTask& task,
                                 const std::function<void(double, std::string_view)>& progress) {
  const CostOf cost = task.topic->cost;
  if (cost != CostOf::kSkyTables && cost != CostOf::kStoredLight)
    return measure_scene(session, *task.topic, task.scene, progress);
  const Result<game::SceneOptions> scene = session.scene(task.scene);
  if (!scene) return scene.error();
  if (cost == CostOf::kStoredLight)
    return measure_stored_light(*task.topic, task.scene, *scene, progress);
  return measure_sky(*task.topic, task.scene, *scene, progress);
}

Result<Record> run_scene(ReportSession& session, const ReportTask& task,
                         const std::filesystem::path& pictures,
                         const std::function<void(double, std::string_view)>& progress) {
  Result<SceneRows> scene = measured_scene(session, task, progress);
  if (!scene) return scene.error();
  if (Result<void> done = write_pictures(*task.topic, *scene, pictures); !done) return done.error();
  Record record;
  record.result = {{"scene", scene->scene},
                   {"command", scene->command},
                   {"width", scene->files.width},
                   {"reference", scene->files.reference},
                   {"reference_standard_error", any_number(scene->reference_standard_error)},
                   {"all_equal", scene->files.all_equal},
                   {"points", ordered_json::array()}};
  record.measured = {{"frames", scene->frames}, {"ms", ordered_json::array()}};
  for (const PointRow& row : scene->rows) {
    record.result["points"].push_back(point_json(row));
    record.measured["ms"].push_back(
        {{"p10", row.ms.p10}, {"median", row.ms.median}, {"p90", row.ms.p90}});
  }
  return record;
}

constexpr std::pair<const char*, std::uint32_t gpu::FrameCounts::*> kCountFields[] = {
    {"passes", &gpu::FrameCounts::passes},
    {"render_passes", &gpu::FrameCounts::render_passes},
    {"barriers", &gpu::FrameCounts::barriers},
    {"dispatches", &gpu::FrameCounts::dispatches},
    {"draws", &gpu::FrameCounts::draws},
    {"copies", &gpu::FrameCounts::copies},
    {"descriptor_writes", &gpu::FrameCounts::descriptor_writes},
    {"images", &gpu::FrameCounts::images},
    {"buffers", &gpu::FrameCounts::buffers}};

ordered_json kept_side(const LeftOutSide& side) {
  ordered_json out{{"ms", side.ms},
                   {"start_ms", side.start_ms},
                   {"pipelines_created", side.pipelines_created},
                   {"memory_bytes", side.memory_bytes},
                   {"transient_bytes", side.counts.transient_bytes}};
  for (const auto& [name, member] : kCountFields) out[name] = side.counts.*member;
  return out;
}

/// Throws nlohmann's errors.
LeftOutSide side_from(const ordered_json& from) {
  LeftOutSide side;
  side.ms = from.at("ms").get<double>();
  side.start_ms = from.at("start_ms").get<double>();
  side.pipelines_created = from.at("pipelines_created").get<int>();
  side.memory_bytes = from.at("memory_bytes").get<std::uint64_t>();
  side.counts.transient_bytes = from.at("transient_bytes").get<std::uint64_t>();
  for (const auto& [name, member] : kCountFields)
    side.counts.*member = from.at(name).get<std::uint32_t>();
  return side;
}

Result<Record> run_left_out(gpu::Device& device, const ReportTask& task) {
  const Result<std::vector<LackingScene>> scenes = lacking_scenes();
  if (!scenes) return scenes.error();
  const auto lacking = std::ranges::find(*scenes, task.scene, &LackingScene::feature);
  if (lacking == scenes->end()) return Error{"there is no such feature; make the plan again"};
  const Result<LeftOutRow> row = measure_left_out(device, *lacking, kLeftOutFrames);
  if (!row) return row.error();
  Record record;
  record.result = {{"feature", row->feature},
                   {"why", row->why},
                   {"same_picture", row->same_picture},
                   {"same_counts", row->same_counts()}};
  record.measured = {{"as_is", kept_side(row->as_is)}, {"without", kept_side(row->without)}};
  return record;
}

}  // namespace

Result<ReportTasks> tasks_of(const ReportRequest& request) {
  ReportTasks out;
  for (const Topic* topic : request.topics) {
    if (const std::optional<std::string> why = why_not(request, *topic)) {
      out.left_out.push_back(fmt::format("{}: left out: {}", topic->name, *why));
      continue;
    }
    for (const std::string& scene : scenes_of(request, *topic)) {
      const Result<std::vector<std::string>> inputs = inputs_of(request, scene);
      if (!inputs) return inputs.error();
      if (Result<void> added = add_task(topic, scene, *inputs, out); !added) return added.error();
    }
  }
  if (request.left_out) {
    const Result<std::vector<LackingScene>> scenes = lacking_scenes();
    if (!scenes) return scenes.error();
    for (const LackingScene& one : *scenes)
      if (Result<void> added = add_task(nullptr, one.feature, {}, out); !added)
        return added.error();
  }
  return out;
}

Result<Record> run_task(ReportSession& session, const ReportTask& task,
                        const std::filesystem::path& pictures,
                        const std::function<void(double, std::string_view)>& progress) {
  const Stopwatch watch;
  Result<Record> record = task.topic ? run_scene(session, task, pictures, progress)
                                     : run_left_out(session.device(), task);
  if (!record) return Error{fmt::format("{}: {}", task.task.name, record.error().message)};
  record->task = task.task.id;
  record->device = session.device().info().name;
  record->driver = session.device().info().driver;
  record->measured["seconds"] = watch.seconds();
  return record;
}

Result<SceneRows> scene_from(const Record& record, const Topic& topic) {
  try {
    const ordered_json& from = record.result;
    SceneRows scene{from.at("scene").get<std::string>(),
                    from.at("command").get<std::string>(),
                    record.measured.at("frames").get<int>(),
                    {},
                    {},
                    {},
                    any_number_from(from.at("reference_standard_error")),
                    {from.at("width").get<std::uint32_t>(), from.at("reference").get<bool>(),
                     from.at("all_equal").get<bool>()}};
    const ordered_json& points = from.at("points");
    const ordered_json& ms = record.measured.at("ms");
    if (points.size() != topic.points.size() || ms.size() != points.size())
      return not_a_record(record, "it has not the points of its topic");
    for (std::size_t p = 0; p < points.size(); ++p)
      scene.rows.push_back(point_from(topic.points[p], points.at(p), ms.at(p)));
    judge_standing(scene.rows);
    return scene;
  } catch (const ordered_json::exception& why) {
    return not_a_record(record, fault_of_row(why));
  }
}

Result<LeftOutRow> left_out_from(const Record& record) {
  try {
    return LeftOutRow{
        record.result.at("feature").get<std::string>(), record.result.at("why").get<std::string>(),
        record.result.at("same_picture").get<bool>(), side_from(record.measured.at("as_is")),
        side_from(record.measured.at("without"))};
  } catch (const ordered_json::exception& why) {
    return not_a_record(record, fault_of_row(why));
  }
}

}  // namespace skerry::tools
