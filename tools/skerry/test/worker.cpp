#include "tools/skerry/test/worker.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/core/check.h"
#include "engine/core/clock.h"
#include "game/view/scene_cache.h"
#include "tools/skerry/scene/draw_scene.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/test/cause.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

std::string dumped(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

/// One device for many scenes.
class Artist {
 public:
  Artist(gpu::Device& device, const PoolOptions& options, int threads)
      : device_(device),
        options_(options.judge),
        threads_(threads),
        driver_(driver_key(device.info())) {
    // A scene that is drawn again is to show what differs when all of it is made again.
    if (options.runs == 1) cache_.emplace(device);
  }

  Outcome draw_and_judge(const TestScene& scene) {
    const Stopwatch watch;
    Outcome outcome = outcome_of_scene(scene);
    outcome.row.driver = driver_;
    outcome.row.device = device_.info().index;
    outcome.row.seconds = watch.seconds();
    return outcome;
  }

 private:
  Outcome outcome_of_scene(const TestScene& scene) {
    const Result<Hashes> approved =
        read_hashes(hash_file(scene.approved(driver_), driver_), scene.unpacked);
    if (!approved) return {failed_row(scene, approved.error().message), {}, false};
    game::SceneOptions options = scene.scene;
    if (options.settings.jobs_threads == 0)
      options.settings.jobs_threads = static_cast<std::uint32_t>(threads_);
    Result<std::unique_ptr<SceneDrawer>> drawer =
        SceneDrawer::create(device_, options, cache_ ? &*cache_ : nullptr);
    if (!drawer) return {failed_row(scene, drawer.error().message), {}, false};
    Result<Drawn> drawn = (*drawer)->draw();
    if (!drawn) return {failed_row(scene, drawn.error().message), {}, false};
    Shown shown;
    shown.picture = {drawn->size.width, drawn->size.height, std::move(drawn->rgba), {}};
    shown.non_finite = drawn->report.pixels.non_finite;
    shown.driver = driver_;
    Outcome outcome = judge(scene, shown, *approved, options_);
    if (const Result<void> done = explain(scene, *approved, **drawer, outcome); !done) {
      outcome.row.verdict = Verdict::kFail;
      outcome.row.failed_runs = 1;
      outcome.row.message = done.error().message;
    }
    return outcome;
  }

  /// Finds the cause of a failure, or keeps the channels that it will be found by.
  Result<void> explain(const TestScene& scene, const Hashes& approved, SceneDrawer& drawer,
                       Outcome& outcome) {
    if (!scene.baseline) return {};
    const auto draw = [&](render::DebugView view) -> Result<platform::PngImage> {
      drawer.view().settings().render.debug_view = view;
      Result<Drawn> drawn = drawer.draw();
      if (!drawn) return drawn.error();
      return platform::PngImage{drawn->size.width, drawn->size.height, std::move(drawn->rgba), {}};
    };
    if (outcome.row.failed()) {
      const auto known = approved.find(scene.name);
      if (known == approved.end() || !outcome.row.found) return {};
      const Result<std::optional<Cause>> cause = find_cause(scene, driver_, known->second, draw);
      if (!cause) return cause.error();
      outcome.row.cause = *cause;
      return {};
    }
    if (!options_.approve || has_channels(scene, driver_, outcome.hash)) return {};
    return keep_channels(scene, driver_, outcome.hash, draw);
  }

  gpu::Device& device_;
  const JudgeOptions& options_;
  int threads_;
  std::string driver_;
  std::optional<game::SceneCache> cache_;  // none: each scene is made from nothing
};

class Lines {
 public:
  explicit Lines(int descriptor) : file_(::fdopen(descriptor, "w")) { SKERRY_ASSERT(file_); }
  ~Lines() { std::fclose(file_); }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;
  void write(const std::string& line) {
    std::fputs(line.c_str(), file_);
    std::fflush(file_);
  }

 private:
  std::FILE* file_;
};

}  // namespace

void serve(int jobs, int results, std::span<const TestScene> scenes, const PoolOptions& options,
           const Seat& seat) {
  Lines out(results);
  // Mesa's CPU driver asks this; what the user has set stays.
  ::setenv("LP_NUM_THREADS", std::to_string(seat.threads).c_str(), 0);
  game::SceneOptions wanted;
  wanted.device = seat.device;
  wanted.validate = options.validate;
  Result<std::unique_ptr<gpu::Device>> device = open_device(wanted);
  if (!device) {
    out.write(line_of(Greeting{device.error().message, false}));
    return;
  }
  const bool on_cpu = (*device)->info().type == VK_PHYSICAL_DEVICE_TYPE_CPU;
  out.write(line_of(Greeting{{}, on_cpu}));
  Artist artist(**device, options, on_cpu ? seat.threads : seat.host_threads);
  std::FILE* in = ::fdopen(jobs, "r");
  SKERRY_ASSERT(in);
  for (unsigned long index = 0; std::fscanf(in, "%lu", &index) == 1;) {
    SKERRY_ASSERT(index < scenes.size());
    out.write(line_of(artist.draw_and_judge(scenes[index])));
  }
  std::fclose(in);
  out.write(line_of(Farewell{(*device)->validation_message_count()}));
}

std::string line_of(const Greeting& greeting) {
  return dumped({{"error", greeting.error}, {"on_cpu", greeting.on_cpu}});
}

std::string line_of(const Outcome& outcome) {
  return dumped(
      {{"row", row_json(outcome.row)}, {"hash", outcome.hash}, {"replaced", outcome.replaced}});
}

std::string line_of(const Farewell& farewell) {
  return dumped({{"validation_messages", farewell.validation_messages}});
}

Greeting greeting_of(const std::string& line) {
  const json from = json::parse(line);
  return {from.at("error").get<std::string>(), from.at("on_cpu").get<bool>()};
}

Outcome outcome_of(const std::string& line) {
  const json from = json::parse(line);
  Result<Row> row = row_from_json(from.at("row"));
  SKERRY_ASSERT(row);
  return {*std::move(row), from.at("hash").get<std::string>(), from.at("replaced").get<bool>()};
}

Farewell farewell_of(const std::string& line) {
  return {json::parse(line).at("validation_messages").get<int>()};
}

}  // namespace skerry::tools
