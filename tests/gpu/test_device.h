#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "engine/gpu/device.h"

namespace skerry::gpu {

/// A device under the validation layer; a test fails if the layer says anything.
class GpuTest : public testing::Test {
 protected:
  void SetUp() override {
    DeviceOptions options;
    options.validate = true;
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
    Result<Buffer> made = device_->create_buffer({std::move(name), bytes, usage, memory});
    if (!made) {
      ADD_FAILURE() << made.error().message;
      return {};
    }
    return *std::move(made);
  }
  Image image(const ImageDesc& desc) {
    Result<Image> made = device_->create_image(desc);
    if (!made) {
      ADD_FAILURE() << made.error().message;
      return {};
    }
    return *std::move(made);
  }

 private:
  std::unique_ptr<Device> device_;
};

}  // namespace skerry::gpu
