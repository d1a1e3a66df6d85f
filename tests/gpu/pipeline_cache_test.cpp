#include "engine/gpu/device/pipeline_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

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
      EXPECT_NE(pipelines.get(ComputeDesc{"one.comp", {}}).handle, VK_NULL_HANDLE);
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
    EXPECT_TRUE(pipeline_cache_fits(file(), properties_));
    EXPECT_FALSE(fs::exists(path_ + ".tmp"));
  }
  const fs::path folder_ = fs::path(testing::TempDir()) /
                           (std::string("skerry_cache_") +
                            testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string path_ = (folder_ / "pipelines.bin").string();
  VkPhysicalDeviceProperties properties_{};
};

TEST_F(PipelineCacheTest, IsWrittenAtTheEndAndTakenAtTheStart) {
  start();
  const std::vector<std::byte> bytes = file();
  EXPECT_TRUE(pipeline_cache_fits(bytes, properties_));
  EXPECT_EQ(load_pipeline_cache(path_, properties_), bytes);
  expect_replaced();
}

TEST_F(PipelineCacheTest, ATruncatedFileIsReplaced) {
  start();
  std::vector<std::byte> bytes = file();
  bytes.resize(31);
  damage(bytes);
  EXPECT_TRUE(load_pipeline_cache(path_, properties_).empty());
  expect_replaced();
}

TEST_F(PipelineCacheTest, DamageBehindTheHeaderIsSurvivedAndReplaced) {
  start();
  const std::vector<std::byte> bytes = file();
  std::vector<std::byte> cut = bytes;
  cut.resize(bytes.size() / 2);
  damage(cut);
  expect_replaced();
  EXPECT_EQ(file().size(), bytes.size());
}

TEST_F(PipelineCacheTest, AnEmptyFileIsReplaced) {
  damage({});
  expect_replaced();
}

TEST_F(PipelineCacheTest, AnyFlippedBitOfTheHeaderIsNoticed) {
  start();
  const std::vector<std::byte> bytes = file();
  for (std::size_t bit = 0; bit < 32 * 8; ++bit) {
    std::vector<std::byte> flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    EXPECT_FALSE(pipeline_cache_fits(flipped, properties_)) << "bit " << bit;
  }
  std::vector<std::byte> flipped = bytes;
  flipped[20] ^= std::byte{1};
  damage(flipped);
  expect_replaced();
}

TEST_F(PipelineCacheTest, AFileThatCannotBeWrittenIsOnlyALogLine) {
  fs::create_directories(path_);  // a folder where the file should be
  testing::internal::CaptureStderr();
  start();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("cannot write the pipeline cache"), std::string::npos) << log;
  EXPECT_FALSE(fs::exists(path_ + ".tmp"));
}

}  // namespace
}  // namespace skerry::gpu
