#include "tools/skerry/report/report_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/platform/files.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/report/left_out_topic.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

std::string topic_list() {
  std::string text = "Topics (default: all):\n";
  for (const Topic& topic : topics())
    text += fmt::format("  {:<18} {}\n", topic.name, topic.meaning);
  text += fmt::format("  {:<18} {}\n", kLeftOutTopic, kLeftOutMeaning);
  return text +
         "Scenes are the topic's own unless --seed, --world, --scene, --cloud or --camera names "
         "one.";
}

/// Whether a scene file, if there is one, says a size. @pre resolve() could read it.
bool file_says_size(const std::optional<std::string>& file) {
  if (!file) return false;
  const Result<std::string> text = platform::read_text(*file, game::kMaxSceneBytes);
  if (!text) return false;
  const Result<game::SceneText> scene = game::parse_scene(*text);
  return scene && scene->size.has_value();
}

}  // namespace

ReportCommand::ReportCommand(CLI::App& app)
    : report_(app.add_subcommand("report", "Report error against run time, setting by setting")) {
  report_->allow_extras();
  report_->footer(topic_list());
  report_->add_option("topic", topics_, "What to measure (default: everything)")
      ->type_name("TOPIC");
  report_->add_option("--out", out_, "Folder for the report")->type_name("DIR");
  add_scene_options(*report_, scene_);
}

std::optional<Refusal> ReportCommand::read_topics(ReportRequest& request) const {
  std::vector<std::string_view> names;
  for (const Topic& topic : topics()) names.push_back(topic.name);
  names.push_back(kLeftOutTopic);
  request.left_out = topics_.empty();
  for (const std::string& name : topics_) {
    if (name == kLeftOutTopic) {
      request.left_out = true;
      continue;
    }
    const Topic* topic = find_topic(name);
    if (!topic)
      return Refusal{kUsage,
                     {fmt::format("there is no topic {}: did you mean '{}'? See skerry report "
                                  "--help",
                                  game::quote_text(name), game::nearest_name(name, names))}};
    if (std::ranges::find(request.topics, topic) == request.topics.end())
      request.topics.push_back(topic);
  }
  if (topics_.empty())
    for (const Topic& topic : topics()) request.topics.push_back(&topic);
  return std::nullopt;
}

std::optional<Refusal> ReportCommand::read(std::span<const std::string> typed,
                                           ReportRequest& request) const {
  if (auto refusal = check_leftovers(*report_)) return refusal;
  if (auto refusal = read_topics(request)) return refusal;
  if (!out_) return Refusal{kUsage, {"the report has no place: give --out DIR"}};
  request.out = *out_;
  if (auto refusal = resolve(scene_, false, request.scene)) return refusal;
  if (auto refusal = check_draws_frames(request.scene)) return refusal;
  request.typed = scene_.text;
  if (scene_.renderer) request.typed.settings.push_back("renderer=" + *scene_.renderer);
  if (scene_.shading) request.typed.settings.push_back("shading=" + *scene_.shading);
  request.own_scene = scene_.text.seed || scene_.text.world || scene_.text.camera ||
                      scene_.scene_file || !scene_.clouds.empty();
  request.own_size = scene_.text.size || file_says_size(scene_.scene_file);
  request.command = "skerry";
  for (const std::string& word : typed) request.command += " " + game::shell_word(word);
  return std::nullopt;
}

int ReportCommand::run(std::span<const std::string> typed) {
  ReportRequest request;
  if (const auto refusal = read(typed, request)) return fail(refusal->status, refusal->error);
  return report(request);
}

}  // namespace skerry::tools
