#include "tools/skerry/report/reference_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <set>
#include <thread>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/scene_file/setting_keys.h"
#include "tests/folder.h"
#include "tools/reference/reference.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

KeptReference picture(float value) {
  KeptReference kept{{3, 2, {}}, 1.25, 0.5, 7.0};
  for (int i = 0; i < 6; ++i)
    kept.radiance.pixels.emplace_back(value, 1.0f / 3.0f, static_cast<float>(i));
  return kept;
}

void expect_equal(const Result<KeptReference>& found, const KeptReference& expected) {
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->radiance.width, expected.radiance.width);
  EXPECT_EQ(found->radiance.height, expected.radiance.height);
  EXPECT_EQ(found->radiance.pixels, expected.radiance.pixels);
  EXPECT_EQ(found->ev, expected.ev);
  EXPECT_EQ(found->mean_error, expected.mean_error);
  EXPECT_EQ(found->seconds, expected.seconds);
}

class Store : public testing::Test {
 protected:
  /// Makes picture(value) and counts, in a file that other processes add to as well.
  ReferenceStore::Make make(float value, std::chrono::milliseconds takes = 0ms) {
    return [this, value, takes]() -> Result<KeptReference> {
      const int log = ::open((folder_ / "made").c_str(), O_WRONLY | O_APPEND | O_CREAT, 0600);
      EXPECT_EQ(::write(log, "x", 1), 1);
      ::close(log);
      std::this_thread::sleep_for(takes);
      return picture(value);
    };
  }
  int times_made() const {
    std::error_code code;
    const auto size = fs::file_size(folder_ / "made", code);
    return code ? 0 : static_cast<int>(size);
  }
  /// Another process that asks for an entry. @return its id.
  pid_t ask_elsewhere(const ReferenceStore::Make& make) {
    const pid_t process = ::fork();
    if (process != 0) return process;
    const Result<KeptReference> found = store_.get("one", make);
    ::_exit(found && found->radiance.pixels == picture(1).radiance.pixels ? 0 : 1);
  }
  static int status_of(pid_t process) {
    int status = 0;
    ::waitpid(process, &status, 0);
    return status;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& file : fs::directory_iterator(folder_ / "shared"))
      names.insert(file.path().filename());
    return names;
  }
  void wait_until_made(int times) const {
    for (int i = 0; i < 1000 && times_made() < times; ++i) std::this_thread::sleep_for(5ms);
    ASSERT_EQ(times_made(), times);
  }

  Folder folder_;
  ReferenceStore store_{folder_ / "shared"};
};

TEST_F(Store, MakesAnEntryOnceAndReadsItFromThenOn) {
  expect_equal(store_.get("one", make(1)), picture(1));
  expect_equal(store_.get("one", make(2)), picture(1));
  expect_equal(ReferenceStore(folder_ / "shared").get("one", make(3)), picture(1));
  EXPECT_EQ(times_made(), 1);
  expect_equal(store_.get("another", make(4)), picture(4));
  EXPECT_EQ(times_made(), 2);
  EXPECT_EQ(files(), (std::set<std::string>{"another.reference", "one.reference"}));
}

TEST_F(Store, KeepsThatAnErrorIsNotKnown) {
  KeptReference kept = picture(1);
  kept.mean_error = std::nullopt;
  for (int i = 0; i < 2; ++i) expect_equal(store_.get("one", [&] { return kept; }), kept);
}

TEST_F(Store, KeepsNothingOfAFailure) {
  const auto fails = []() -> Result<KeptReference> { return Error{"no such scene"}; };
  const auto found = store_.get("one", fails);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "no such scene");
  EXPECT_EQ(files(), std::set<std::string>{});
  expect_equal(store_.get("one", make(1)), picture(1));
}

TEST_F(Store, FindsEveryDamageAndMakesTheEntryAgain) {
  expect_equal(store_.get("one", make(1)), picture(1));
  const std::string whole = *platform::read_text(store_.entry("one"), 1 << 20);
  ASSERT_EQ(whole.size(), 8u + 32 + 6 * 12 + 64);
  std::vector<std::string> damaged{"", whole + "x", whole + whole, std::string(whole.size(), '\0')};
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 11)
    damaged.push_back(whole.substr(0, bytes));
  for (std::size_t byte = 0; byte < whole.size(); byte += 3) {
    damaged.push_back(whole);
    damaged.back()[byte] = static_cast<char>(damaged.back()[byte] ^ (1 << (byte % 8)));
  }
  int made = 1;
  for (const std::string& text : damaged) {
    ASSERT_TRUE(write_text(store_.entry("one"), text));
    expect_equal(store_.get("one", make(1)), picture(1));
    EXPECT_EQ(times_made(), ++made) << "a damaged entry was taken";
    EXPECT_EQ(*platform::read_text(store_.entry("one"), 1 << 20), whole);
  }
}

TEST_F(Store, RefusesAnEntryWhoseSizeIsWrongThoughItsSumIsRight) {
  KeptReference odd = picture(1);
  odd.radiance.width = 0xffffffff;
  ASSERT_TRUE(store_.get("one", [&] { return odd; }));
  expect_equal(store_.get("one", make(1)), picture(1));
  EXPECT_EQ(times_made(), 1);
}

TEST_F(Store, ComputesWhatItCannotKeep) {
  ASSERT_TRUE(write_text(folder_ / "shared", "a file"));
  expect_equal(store_.get("one", make(1)), picture(1));
  EXPECT_EQ(*platform::read_text(folder_ / "shared", 100), "a file");
}

TEST_F(Store, LetsOneOfManyProcessesCompute) {
  std::vector<pid_t> processes;
  for (int i = 0; i < 8; ++i) processes.push_back(ask_elsewhere(make(1, 200ms)));
  for (const pid_t process : processes) EXPECT_EQ(status_of(process), 0);
  EXPECT_EQ(times_made(), 1);
  EXPECT_EQ(files(), std::set<std::string>{"one.reference"});
}

TEST_F(Store, LetsTwoEntriesBeComputedAtOnce) {
  const pid_t slow = ask_elsewhere(make(1, 60s));
  wait_until_made(1);
  expect_equal(store_.get("another", make(2)), picture(2));
  ::kill(slow, SIGKILL);
  status_of(slow);
}

TEST_F(Store, TakesOverFromAProcessThatWasKilled) {
  const pid_t slow = ask_elsewhere(make(1, 60s));
  wait_until_made(1);
  const pid_t waiting = ask_elsewhere(make(1));
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(times_made(), 1) << "it computes what another process is at";
  ::kill(slow, SIGKILL);
  status_of(slow);
  EXPECT_EQ(status_of(waiting), 0);
  EXPECT_EQ(times_made(), 2);
  expect_equal(store_.get("one", make(3)), picture(1));
  EXPECT_EQ(times_made(), 2);
  EXPECT_EQ(files(), std::set<std::string>{"one.reference"});
}

TEST_F(Store, LosesNothingWhenProcessesAreKilledAtRandom) {
  std::mt19937 random(4);
  for (int round = 0; round < 30; ++round) {
    std::vector<pid_t> processes;
    for (int i = 0; i < 3; ++i) processes.push_back(ask_elsewhere(make(1, 3ms)));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 15000));
    ::kill(processes[random() % 3], SIGKILL);
    for (const pid_t process : processes) {
      const int status = status_of(process);
      EXPECT_TRUE(WIFSIGNALED(status) || status == 0) << "it got another picture";
    }
    expect_equal(store_.get("one", make(1)), picture(1));
    fs::remove(store_.entry("one"));
  }
}

game::SceneOptions scene() {
  game::SceneOptions options;
  options.size = {24, 14};
  options.time_of_day_s = 17 * 3600;
  options.settings.world_islands = 2;
  options.settings.view_distance = 200;
  options.settings.lights_random = 8;
  options.settings.reference_samples = 2;
  options.settings.render.clouds.coverage = 0.5f;
  return options;
}

std::string id_of(const game::SceneOptions& options) {
  const Result<std::string> id = reference_id(options);
  return id ? *id : id.error().message;
}

void set(game::SceneOptions& options, const std::string& assignment) {
  const Result<void> done = game::apply_setting(assignment, options.settings);
  EXPECT_TRUE(done) << assignment;
}

/// Settings that are left out of the hash, none as in scene().
constexpr const char* kUnread[] = {
    "view.detail=64",      "aa.samples=16",     "render.scale=0.5",      "shadow.size=256",
    "shadow.cascades=1",   "shadow.taps=1",     "shadow.samples=4",      "shadow.split=0.5",
    "shadow.blur=0",       "texture.taps=16",   "gbuffer.normal=oct8",   "gbuffer.position=rgba32f",
    "gbuffer.depth=d16",   "exposure.stride=1", "bloom.intensity=0.5",   "bloom.threshold=3",
    "bloom.levels=2",      "clouds.steps=100",  "clouds.shadow_steps=8", "clouds.resolution=full",
    "clouds.precision=32", "tone=agx",          "display.peak=0.5",      "display.black=0.1",
    "renderer=deferred",   "shading.rate=4",    "shading.tolerance=0.2", "lights.shadows=off",
    "lights.softness=8",   "lights.tile=64",    "lights.oracle=1",       "upload.path=mapped",
    "upload.budget=65536", "memory.budget=256", "jobs.threads=1",        "frames.cap=30",
    "water.layers=4",      "view.error=4"};

TEST(ReferenceId, LeavesOutWhatTheReferenceDoesNotRead) {
  const game::SceneOptions plain = scene();
  game::SceneOptions all = plain;
  for (const char* assignment : kUnread) {
    game::SceneOptions changed = plain;
    set(changed, assignment);
    set(all, assignment);
    EXPECT_FALSE(changed.settings == plain.settings) << assignment;
    EXPECT_EQ(id_of(changed), id_of(plain)) << assignment;
  }
  all.device = 1;
  all.validate = true;
  all.quality = game::Quality::kHigh;
  EXPECT_EQ(id_of(all), id_of(plain));
  // And so it is.
  const auto a = reference::render_reference(plain, reference::settings_from(plain));
  const auto b = reference::render_reference(all, reference::settings_from(all));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->radiance.pixels, b->radiance.pixels);
  EXPECT_EQ(a->ev, b->ev);
  EXPECT_EQ(a->mean_error, b->mean_error);
}

TEST(ReferenceId, DependsOnTheSceneAndOnWhatTheReferenceReads) {
  std::set<std::string> ids{id_of(scene())};
  std::size_t count = 1;
  const auto expect_another = [&](const game::SceneOptions& options, const std::string& what) {
    ids.insert(id_of(options));
    EXPECT_EQ(ids.size(), ++count) << what;
  };
  for (const char* assignment : {"world.offset=1,0,0",
                                 "world.islands=3",
                                 "world.time=1",
                                 "sky.moon_phase=0.25",
                                 "view.distance=300",
                                 "shadow.enabled=0",
                                 "lights.random=9",
                                 "lights.held=1",
                                 "ao.strength=0.25",
                                 "indirect=off",
                                 "exposure=1",
                                 "exposure.key=0.5",
                                 "exposure.min=-2",
                                 "exposure.max=2",
                                 "clouds.coverage=0.25",
                                 "clouds.altitude=100",
                                 "clouds.thickness=100",
                                 "clouds.density=0.5",
                                 "clouds.file_density=0.5",
                                 "clouds.file_emission=0.5",
                                 "shading=flat",
                                 "debug.view=depth",
                                 "reference.samples=3",
                                 "reference.filter=centre"}) {
    game::SceneOptions changed = scene();
    set(changed, assignment);
    expect_another(changed, assignment);
  }
  const auto expect_changed = [&](const char* what, auto change) {
    game::SceneOptions changed = scene();
    change(changed);
    expect_another(changed, what);
  };
  expect_changed("seed", [](auto& s) { s.seed_text = "2"; });
  expect_changed("fov", [](auto& s) { s.fov_deg = 70.5; });
  expect_changed("time", [](auto& s) { s.time_of_day_s += 1; });
  expect_changed("size", [](auto& s) { s.size = {14, 24}; });
  expect_changed("camera", [](auto& s) { s.camera = game::CameraPlace{}; });
  expect_changed("light", [](auto& s) { s.lights.emplace_back(); });
  expect_changed("its range", [](auto& s) { s.lights.emplace_back().light.range = 3; });
  expect_changed("its place", [](auto& s) { s.lights.emplace_back().position.z = 1; });
}

TEST(ReferenceId, DependsOnContentsOfFilesAndNotOnTheirNames) {
  const Folder folder;
  for (const char* name : {"a", "b"}) ASSERT_TRUE(write_text(folder / name, "alike"));
  ASSERT_TRUE(write_text(folder / "c", "unlike"));
  const auto with = [&](const std::string& world, const std::string& cloud) {
    game::SceneOptions options = scene();
    options.world = (folder / world).string();
    options.clouds.push_back({(folder / cloud).string()});
    return id_of(options);
  };
  EXPECT_EQ(with("a", "a"), with("b", "b"));
  EXPECT_EQ(std::set({with("a", "a"), with("c", "a"), with("a", "c")}).size(), 3u);
}

}  // namespace
}  // namespace skerry::tools
