#include "tools/skerry/test/pool.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "engine/core/processors.h"
#include "tests/folder.h"

namespace skerry::tools {
namespace {

/// Devices that draw nothing: each tells when two processes use it at once.
class FakeDevices {
 public:
  /// @param opened_together a device opens once so many processes are opening one.
  explicit FakeDevices(bool cpus, std::ptrdiff_t opened_together = 1)
      : cpus_(cpus), opened_together_(opened_together) {}

  /// @param killer index of a scene that ends the process, the first time it is drawn.
  Serve serve(std::optional<std::size_t> killer = {}) const {
    return [this, killer](int jobs, int results, const Seat& seat) {
      const std::string name = std::to_string(seat.device.value_or(99));
      const int lock = ::open((folder_ / name).c_str(), O_RDWR | O_CREAT, 0600);
      const bool alone = cpus_ || ::flock(lock, LOCK_EX | LOCK_NB) == 0;
      std::FILE* out = ::fdopen(results, "w");
      const auto say = [&](const std::string& line) {
        std::fputs(line.c_str(), out);
        std::fflush(out);
      };
      say(line_of(Greeting{others_come() ? "" : "the others did not come", cpus_}));
      std::FILE* in = ::fdopen(jobs, "r");
      for (unsigned long scene = 0; std::fscanf(in, "%lu", &scene) == 1;) {
        if (scene == killer) ::kill(::getpid(), SIGKILL);
        ::usleep(2000);
        Outcome outcome;
        outcome.row.scene = std::to_string(scene);
        outcome.row.verdict = alone ? Verdict::kPass : Verdict::kFail;
        outcome.row.device = seat.device;
        outcome.row.message = std::to_string(::getpid()) + " ";
        outcome.row.message += std::to_string(cpus_ ? seat.threads : seat.host_threads);
        say(line_of(outcome));
      }
      say(line_of(Farewell{1}));
    };
  }

 private:
  bool others_come() const {
    const std::filesystem::path mark = folder_ / ("opening" + std::to_string(::getpid()));
    ::close(::open(mark.c_str(), O_RDWR | O_CREAT, 0600));
    for (int tries = 0; tries < 10000; ++tries, ::usleep(1000)) {
      using Files = std::filesystem::directory_iterator;
      const auto opening = std::count_if(Files(folder_.path()), Files(), [](const auto& file) {
        return file.path().filename().string().starts_with("opening");
      });
      if (opening >= opened_together_) return true;
    }
    return false;
  }

  bool cpus_;
  std::ptrdiff_t opened_together_;
  Folder folder_;
};

struct Ran {
  std::map<std::size_t, int> times;                                         // by scene
  std::map<std::optional<std::uint32_t>, std::set<std::string>> processes;  // by device
  int failures = 0;
  PoolResult result;
};

Ran run(const Serve& serve, const PoolOptions& options, std::size_t count) {
  std::vector<TestScene> scenes(count);
  Ran ran;
  ran.result = run_pool(
      scenes, options,
      [&](std::size_t scene, const Outcome& outcome) {
        ++ran.times[scene];
        if (outcome.row.failed()) ++ran.failures;
        ran.processes[outcome.row.device].insert(outcome.row.message);
      },
      serve);
  EXPECT_FALSE(ran.result.refusal);
  EXPECT_EQ(ran.times.size(), count);
  for (const auto& [scene, times] : ran.times) EXPECT_EQ(times, options.runs) << scene;
  return ran;
}

TEST(Pool, GivesEachDeviceOneTaskAtATime) {
  const FakeDevices gpus(false, 4);  // or a late one would find nothing left
  PoolOptions options;
  options.devices = {0, 2, 3, 7};
  const Ran ran = run(gpus.serve(), options, 60);
  EXPECT_EQ(ran.failures, 0) << "two processes used one device";
  ASSERT_EQ(ran.processes.size(), 4u);
  for (const std::uint32_t device : options.devices)
    EXPECT_EQ(ran.processes.at(device).size(), 1u) << device;
  EXPECT_EQ(ran.result.validation_messages, 4) << "each says farewell";
}

TEST(Pool, DrawsWhatTakesLongestFirst) {
  // Scene i takes as long as i says, once it has been drawn; before, as it is expected to.
  const std::vector<double> took{2.0, 9.0, 4.0, 7.0};
  const Serve serve = [&](int jobs, int results, const Seat&) {
    std::FILE* out = ::fdopen(results, "w");
    std::FILE* in = ::fdopen(jobs, "r");
    const auto say = [&](const std::string& line) {
      std::fputs(line.c_str(), out);
      std::fflush(out);
    };
    say(line_of(Greeting{"", false}));
    for (unsigned long scene = 0; std::fscanf(in, "%lu", &scene) == 1;) {
      Outcome outcome;
      outcome.row.seconds = took[scene];
      say(line_of(outcome));
    }
    say(line_of(Farewell{0}));
  };
  const std::vector<TestScene> scenes(took.size());
  PoolOptions options;
  options.runs = 2;
  std::vector<std::size_t> drawn;
  const auto note = [&](std::size_t scene, const Outcome&) { drawn.push_back(scene); };
  run_pool(scenes, options, note, serve);
  EXPECT_EQ(drawn, (std::vector<std::size_t>{0, 1, 2, 3, 1, 3, 2, 0}));
  drawn.clear();
  options.expected_s = {1.0, {}, 3.0, 3.0};
  run_pool(scenes, options, note, serve);
  EXPECT_EQ(drawn, (std::vector<std::size_t>{1, 2, 3, 0, 1, 3, 2, 0}));
}

TEST(Pool, OpensItsDevicesAtOnce) {
  PoolOptions options;
  options.devices = {0, 1, 2};
  EXPECT_EQ(run(FakeDevices(false, 3).serve(), options, 9).failures, 0);
  options.processes = 2;
  EXPECT_EQ(run(FakeDevices(true, 6).serve(), options, 9).failures, 0);
}

// A process that has drawn scenes of a world is given the others of it.
TEST(Pool, KeepsWorldsApart) {
  const Folder folder;
  // Both draw their n-th scenes at the same time.
  const Serve in_step = [&](int jobs, int results, const Seat& seat) {
    std::FILE* out = ::fdopen(results, "w");
    std::FILE* in = ::fdopen(jobs, "r");
    const auto say = [&](const std::string& line) {
      std::fputs(line.c_str(), out);
      std::fflush(out);
    };
    const auto mark = [&](int drawn, std::uint32_t device) {
      return folder / (std::to_string(drawn) + "." + std::to_string(device));
    };
    say(line_of(Greeting{"", false}));
    int drawn = 0;
    for (unsigned long scene = 0; std::fscanf(in, "%lu", &scene) == 1; ++drawn) {
      ::close(::open(mark(drawn, *seat.device).c_str(), O_RDWR | O_CREAT, 0600));
      for (int tries = 0; tries < 10000; ++tries, ::usleep(1000))
        if (std::filesystem::exists(mark(drawn, 1 - *seat.device))) break;
      Outcome outcome;
      outcome.row.device = seat.device;
      say(line_of(outcome));
    }
    say(line_of(Farewell{0}));
  };
  std::vector<TestScene> scenes(24);
  for (std::size_t i = 0; i < scenes.size(); ++i)
    scenes[i].scene.seed_text = i / 2 % 2 == 0 ? "one" : "other";
  PoolOptions options;
  options.devices = {0, 1};
  std::map<std::string, std::multiset<std::uint32_t>> devices;
  run_pool(
      scenes, options,
      [&](std::size_t scene, const Outcome& outcome) {
        devices[scenes[scene].scene.seed_text].insert(*outcome.row.device);
      },
      in_step);
  for (const auto& [world, drew] : devices) {
    EXPECT_EQ(drew.size(), 12u);
    EXPECT_EQ(std::set<std::uint32_t>(drew.begin(), drew.end()).size(), 1u) << world;
  }

  // One alone draws all of both.
  for (TestScene& scene : scenes) scene.scene.seed_text = "one";
  scenes.front().scene.seed_text = "other";
  options.devices = {5};
  std::set<std::size_t> drawn;
  const FakeDevices alone(false);
  run_pool(
      scenes, options, [&](std::size_t scene, const Outcome&) { drawn.insert(scene); },
      alone.serve());
  EXPECT_EQ(drawn.size(), scenes.size());
}

TEST(Pool, OpensNoMoreDevicesThanThereAreScenes) {
  const FakeDevices gpus(false);
  PoolOptions options;
  options.devices = {0, 1, 2, 3};
  const Ran ran = run(gpus.serve(), options, 2);
  EXPECT_EQ(ran.result.validation_messages, 2);
  EXPECT_EQ(ran.failures, 0);
}

TEST(Pool, ReplacesAProcessThatDiesOnItsOwnDevice) {
  const FakeDevices gpus(false);
  PoolOptions options;
  options.devices = {4, 5};
  for (const std::size_t killer : {0u, 1u, 9u, 39u}) {
    const Ran ran = run(gpus.serve(killer), options, 40);
    EXPECT_EQ(ran.failures, 1) << "one died, and no two used one device";
    for (const auto& [device, processes] : ran.processes)
      EXPECT_TRUE(device == 4u || device == 5u) << "a failure says on which device, too";
  }
}

TEST(Pool, WithoutDevicesUsesTheBest) {
  const FakeDevices gpus(false);
  const Ran ran = run(gpus.serve(), {}, 5);
  ASSERT_EQ(ran.processes.size(), 1u);
  EXPECT_FALSE(ran.processes.begin()->first);
}

TEST(Pool, StartsAsManyProcessesADeviceAsAreWanted) {
  const FakeDevices gpus(true);  // which may be shared
  PoolOptions options;
  options.devices = {0, 1};
  options.processes = 3;
  options.runs = 2;
  const Ran ran = run(gpus.serve(), options, 40);
  EXPECT_EQ(ran.result.validation_messages, 6);
  EXPECT_EQ(ran.processes.size(), 2u);
}

TEST(Pool, SharesTheCoresAmongItsProcesses) {
  const auto cores = static_cast<unsigned>(usable_cpus());
  const auto expect_threads = [](const Ran& ran, unsigned threads) {
    for (const auto& [device, processes] : ran.processes)
      for (const std::string& process : processes)
        EXPECT_EQ(process.substr(process.find(' ') + 1), std::to_string(std::max(1u, threads)));
  };
  PoolOptions options;
  options.devices = {0};
  expect_threads(run(FakeDevices(false).serve(), options, 9), cores);
  expect_threads(run(FakeDevices(true).serve(), options, 9), cores / std::min(cores, 9u));
  options.devices = {0, 1};
  expect_threads(run(FakeDevices(false).serve(), options, 9), cores / 2);
  options.processes = 2;
  expect_threads(run(FakeDevices(true).serve(), options, 9), cores / 4);
}

}  // namespace
}  // namespace skerry::tools
