#include "engine/gpu/device/pipeline_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "engine/gpu/program/pipeline.h"
#include "tests/gpu/compile_glsl.h"
#include "tests/gpu/test_device.h"

namespace skerry::gpu {
namespace {

namespace fs = std::filesystem;

constexpr const char* kShader = R"(
  layout(local_size_x = 1) in;
  layout(binding = 0) buffer A { uint a; };
  void main() { a = 1; })";

class PipelineCacheTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A whole program start: compiles one pipeline and ends.
  void start() {
    DeviceOptions options;
    options.validate = true;
    options.pipeline_cache_path = path_;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    ASSERT_TRUE(device) << device.error().message;
    vkGetPhysicalDeviceProperties((*device)->physical(), &properties_);
    {
      const TestShader shader("one.comp", kShader);
      const EmbeddedShader table[] = {shader.embedded()};
      Pipelines pipelines(**device, table);
      EXPECT_NE(pipelines.get(ComputeDesc{"one.comp", {}}).made().handle, VK_NULL_HANDLE);
    }
    EXPECT_EQ((*device)->validation_message_count(), 0);
  }
  std::vector<std::byte> file() const {
    std::vector<std::byte> bytes(fs::file_size(path_));
    std::ifstream(path_, std::ios::binary)
        .read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return bytes;
  }
  void damage(const std::vector<std::byte>& bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  void expect_replaced() {
    start();
    EXPECT_TRUE(pipeline_cache_fits(load_pipeline_cache(path_, properties_), properties_));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  }
  const fs::path folder_ = fs::path(testing::TempDir()) /
                           (std::string("skerry_cache_") +
                            testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string path_ = (folder_ / "pipelines.bin").string();
  VkPhysicalDeviceProperties properties_{};
};

TEST_F(PipelineCacheTest, IsWrittenAtTheEndAndTakenAtTheStart) {
  start();
  const std::vector<std::byte> bytes = file(), body(bytes.begin() + 16, bytes.end());
  EXPECT_TRUE(pipeline_cache_fits(body, properties_));
  EXPECT_EQ(load_pipeline_cache(path_, properties_), body);
  expect_replaced();
}

TEST_F(PipelineCacheTest, KeepsWhatProcessesCompiledThatRanAtOnce) {
  const TestShader one("one.comp", kShader), two("two.comp", R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) buffer A { uint a; };
    void main() { a = a * 3 + 7; })");
  const EmbeddedShader table[] = {one.embedded(), two.embedded()};
  const auto open = [&] {
    DeviceOptions options;
    options.validate = true;
    options.pipeline_cache_path = path_;
    return *Device::create(options);
  };
  const auto compile = [&](Device& device, std::initializer_list<const char*> names) {
    Pipelines pipelines(device, table);
    for (const char* name : names) (void)pipelines.get(ComputeDesc{name, {}}).made();
  };
  compile(*open(), {"one.comp", "two.comp"});
  const std::uintmax_t both = fs::file_size(path_);
  fs::remove(path_);
  {
    const std::unique_ptr<Device> later = open(), sooner = open();
    compile(*later, {"one.comp"});
    compile(*sooner, {"two.comp"});
    EXPECT_EQ(sooner->validation_message_count() + later->validation_message_count(), 0);
  }
  EXPECT_EQ(fs::file_size(path_), both);  // a driver that caches nothing has its header alone
}

TEST_F(PipelineCacheTest, ATruncatedFileIsReplaced) {
  start();
  std::vector<std::byte> bytes = file();
  bytes.resize(31);
  damage(bytes);
  EXPECT_TRUE(load_pipeline_cache(path_, properties_).empty());
  expect_replaced();
}

TEST_F(PipelineCacheTest, ACutFileIsReplaced) {
  start();
  const std::vector<std::byte> bytes = file();
  std::vector<std::byte> cut = bytes;
  cut.resize(bytes.size() / 2);
  damage(cut);
  EXPECT_TRUE(load_pipeline_cache(path_, properties_).empty());
  expect_replaced();
  EXPECT_EQ(file().size(), bytes.size());
}

TEST_F(PipelineCacheTest, AnyFlippedBitOfTheFileIsNoticedBeforeTheDriverSeesIt) {
  start();
  const std::vector<std::byte> bytes = file();
  std::mt19937 random(1);
  const auto bits = static_cast<std::uint32_t>(8 * bytes.size());
  for (std::uint32_t i = 0; i < 500; ++i) {
    // Each half byte of the headers, then anywhere: a driver may have nothing to cache.
    const auto bit =
        static_cast<std::uint32_t>((i < 8 * 64 / 4 ? 4 * i + random() % 4 : random()) % bits);
    std::vector<std::byte> flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    damage(flipped);
    EXPECT_TRUE(load_pipeline_cache(path_, properties_).empty()) << "bit " << bit;
  }
  expect_replaced();
}

TEST_F(PipelineCacheTest, TheChecksumIsFnv1a) {
  // The 64-bit value of "foobar" that its authors publish.
  save_pipeline_cache(path_, std::as_bytes(std::span("foobar", 6)));
  const std::vector<std::byte> bytes = file();
  ASSERT_EQ(bytes.size(), 22u);
  std::uint64_t sum = 0;
  for (int i = 15; i >= 8; --i)
    sum = sum << 8 | std::to_integer<std::uint64_t>(bytes[static_cast<std::size_t>(i)]);
  EXPECT_EQ(sum, 0x85944171f73967e8u);
}

TEST_F(PipelineCacheTest, AnEmptyFileIsReplaced) {
  damage({});
  expect_replaced();
}

TEST_F(PipelineCacheTest, AnyFlippedBitOfTheHeaderIsNoticed) {
  start();
  const std::vector<std::byte> bytes = load_pipeline_cache(path_, properties_);
  for (std::size_t bit = 0; bit < 32 * 8; ++bit) {
    std::vector<std::byte> flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    EXPECT_FALSE(pipeline_cache_fits(flipped, properties_)) << "bit " << bit;
  }
  std::vector<std::byte> other = bytes;  // of another driver, and whole
  other[20] ^= std::byte{1};
  save_pipeline_cache(path_, other);
  EXPECT_TRUE(load_pipeline_cache(path_, properties_).empty());
  expect_replaced();
}

TEST_F(PipelineCacheTest, AFileThatCannotBeWrittenIsOnlyALogLine) {
  fs::create_directories(path_);  // a folder where the file should be
  testing::internal::CaptureStderr();
  start();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("compile shaders again: cannot write"), std::string::npos) << log;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace skerry::gpu
