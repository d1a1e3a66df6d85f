#pragma once
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/transfer/readback.h"
#include "tests/long_tests.h"

namespace skerry::gpu {

/// What the validation layer checks: all, or in short runs of tests synchronisation alone. Core
/// checks take half of the time of whole frames, which image.scenes draws with all of them.
enum class Checks { kAll, kAllInLongRuns };

/// A device under the validation layer; a test fails if the layer says anything.
class GpuTest : public testing::Test {
 protected:
  explicit GpuTest(Checks checks = Checks::kAll) : checks_(checks) {}
  void SetUp() override {
    DeviceOptions options;
    options.validate = true;
    options.core_checks = checks_ == Checks::kAll || long_tests();
    Result<std::unique_ptr<Device>> made = Device::create(options);
    ASSERT_TRUE(made) << made.error().message;
    device_ = *std::move(made);
  }
  void TearDown() override {
    if (!device_) return;
    EXPECT_EQ(device_->validation_message_count(), 0);
  }
  Device& device() { return *device_; }
  Buffer buffer(std::string name, std::uint64_t bytes, VkBufferUsageFlags usage,
                Memory memory = Memory::kDevice) {
    return made(device_->create_buffer({std::move(name), bytes, usage, memory}));
  }
  /// One that shaders fetch texels of.
  Buffer texel_buffer(std::string name, std::uint64_t bytes) {
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return made(device_->create_buffer({std::move(name), bytes, kUsage, Memory::kDevice, true}));
  }
  Image image(const ImageDesc& desc) { return made(device_->create_image(desc)); }
  /// All of a buffer, as values of one type.
  template <class T>
  std::vector<T> contents(Buffer& from) {
    const Result<std::vector<std::byte>> bytes = read_back(device(), from, 0, from.size_bytes());
    if (!bytes) {
      ADD_FAILURE() << bytes.error().message;
      return std::vector<T>(from.size_bytes() / sizeof(T));
    }
    std::vector<T> values(from.size_bytes() / sizeof(T));
    std::memcpy(values.data(), bytes->data(), values.size() * sizeof(T));
    return values;
  }

 private:
  template <class T>
  static T made(Result<T> made) {
    if (made) return *std::move(made);
    ADD_FAILURE() << made.error().message;
    return {};
  }

  const Checks checks_;
  std::unique_ptr<Device> device_;
};

}  // namespace skerry::gpu
