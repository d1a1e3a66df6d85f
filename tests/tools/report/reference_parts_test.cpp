#include "tools/skerry/report/reference_parts.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <set>
#include <thread>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using reference::ReferenceBatches;

class Parts : public testing::Test {
 protected:
  /// Draws parts of a picture of 3x2 pixels and logs each, in a file that all processes add to.
  auto draw(std::chrono::milliseconds takes = 0ms) {
    return [this, takes](const BatchRange& range) -> Result<ReferenceBatches> {
      const int log = ::open((folder_ / "drawn").c_str(), O_WRONLY | O_APPEND | O_CREAT, 0600);
      const char name = static_cast<char>('0' + range.first);
      EXPECT_EQ(::write(log, &name, 1), 1);
      ::close(log);
      std::this_thread::sleep_for(takes);
      ReferenceBatches part{3, 2, range.first, range.count, {}, 1.0};
      for (std::uint32_t i = 0; i < 6 * range.count; ++i)
        part.means.emplace_back(range.first * 0.1 + i, 1.0 / (1.0 + i), range.count);
      return part;
    };
  }
  Result<KeptReference> get(std::chrono::milliseconds takes = 0ms) {
    return get_in_parts(
        store_, "one", parts_, draw(takes), [](std::span<const ReferenceBatches> all) {
          reference::ReferencePicture made = reference::merge_batches(all);
          return KeptReference{std::move(made.radiance), 0.5, made.mean_error, made.seconds};
        });
  }
  pid_t get_elsewhere(std::chrono::milliseconds takes) {
    const pid_t process = ::fork();
    if (process != 0) return process;
    ::_exit(get(takes) ? 0 : 1);
  }
  std::string drawn() const {
    Result<std::string> log = platform::read_text(folder_ / "drawn", 1000);
    if (!log) return {};
    std::ranges::sort(*log);
    return *log;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& file : fs::directory_iterator(folder_ / "shared"))
      names.insert(file.path().filename());
    return names;
  }
  /// The picture that one process draws alone.
  measure::Picture alone() {
    std::vector<ReferenceBatches> all;
    for (const BatchRange& range : parts_) all.push_back(*draw()(range));
    fs::remove(folder_ / "drawn");
    return reference::merge_batches(all).radiance;
  }

  Folder folder_;
  ReferenceStore store_{folder_ / "shared"};
  std::vector<BatchRange> parts_ = split_batches(8, 4);
};

TEST(SplitBatches, GivesEachBatchToOnePartOfAFairSize) {
  for (std::uint32_t batches = 1; batches <= 8; ++batches) {
    for (std::uint32_t parts = 1; parts <= 9; ++parts) {
      const std::vector<BatchRange> ranges = split_batches(batches, parts);
      EXPECT_EQ(ranges.size(), std::min(batches, parts));
      std::uint32_t next = 0;
      for (const BatchRange& range : ranges) {
        EXPECT_EQ(range.first, next);
        EXPECT_GE(range.count, batches / ranges.size());
        EXPECT_LE(range.count, batches / ranges.size() + 1);
        next += range.count;
      }
      EXPECT_EQ(next, batches);
    }
  }
}

TEST_F(Parts, AreDrawnOnceAndGoWhenTheEntryIsWritten) {
  const measure::Picture expected = alone();
  for (int i = 0; i < 2; ++i) {
    const Result<KeptReference> found = get();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->radiance.pixels, expected.pixels);
    EXPECT_EQ(found->seconds, 4.0);
    EXPECT_EQ(drawn(), "0246");
    EXPECT_EQ(files(), std::set<std::string>{"one.reference"});
  }
}

TEST_F(Parts, AreSharedAmongProcesses) {
  const measure::Picture expected = alone();
  std::vector<pid_t> processes;
  for (int i = 0; i < 4; ++i) processes.push_back(get_elsewhere(150ms));
  for (const pid_t process : processes) {
    int status = 1;
    ::waitpid(process, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(drawn(), "0246");  // each part by one of them
  EXPECT_EQ(get()->radiance.pixels, expected.pixels);
  EXPECT_EQ(files(), std::set<std::string>{"one.reference"});
}

TEST_F(Parts, ThatAKilledProcessLeavesAreDrawnByTheNext) {
  const measure::Picture expected = alone();
  const pid_t process = get_elsewhere(200ms);
  for (int i = 0; i < 1000 && drawn().size() < 2; ++i) std::this_thread::sleep_for(5ms);
  ::kill(process, SIGKILL);
  int status = 0;
  ::waitpid(process, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(get()->radiance.pixels, expected.pixels);
  EXPECT_EQ(drawn(), "02246");  // the first was kept, the second was not finished
  EXPECT_EQ(files(), std::set<std::string>{"one.reference"});
}

TEST_F(Parts, ThatAreDamagedAreDrawnAgain) {
  const measure::Picture expected = alone();
  fs::create_directories(folder_ / "shared");
  for (const std::string& text : {std::string(), std::string("SKERPRT1"), std::string(400, 'x')}) {
    fs::remove(store_.entry("one"));
    ASSERT_TRUE(write_text(folder_ / "shared" / "one.2-2.part", text));
    const Result<KeptReference> found = get();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->radiance.pixels, expected.pixels);
  }
  EXPECT_EQ(drawn(), "000222444666");
}

TEST_F(Parts, AreDrawnHereWhereNothingCanBeKept) {
  const measure::Picture expected = alone();
  ASSERT_TRUE(write_text(folder_ / "shared", "a file"));
  EXPECT_EQ(get()->radiance.pixels, expected.pixels);
}

TEST_F(Parts, PassErrorsOfDrawingOn) {
  const auto found = get_in_parts(
      store_, "one", parts_,
      [](const BatchRange&) -> Result<ReferenceBatches> { return Error{"no such scene"}; },
      [](std::span<const ReferenceBatches>) { return KeptReference(); });
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "no such scene");
}

}  // namespace
}  // namespace skerry::tools
