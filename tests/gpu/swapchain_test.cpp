// The swapchain on a surface without a window: same code path, no display needed.
#include "engine/gpu/swapchain.h"

#include <gtest/gtest.h>

#include "engine/gpu/device.h"

namespace skerry::gpu {
namespace {

class SwapchainTest : public testing::Test {
 protected:
  void SetUp() override {
    DeviceOptions options;
    options.validate = true;
    options.surface_extensions = {VK_KHR_SURFACE_EXTENSION_NAME, VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME};
    Result<std::unique_ptr<Device>> made = Device::create(options);
    if (!made) GTEST_SKIP() << made.error().message;
    device_ = *std::move(made);
    VkHeadlessSurfaceCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT;
    ASSERT_EQ(vkCreateHeadlessSurfaceEXT(device_->instance(), &info, nullptr, &surface_), VK_SUCCESS);
    Result<std::unique_ptr<Swapchain>> swapchain = Swapchain::create(*device_, surface_, false);
    ASSERT_TRUE(swapchain) << swapchain.error().message;
    swapchain_ = *std::move(swapchain);
    ImageDesc desc;
    desc.name = "picture";
    desc.format = VK_FORMAT_R8G8B8A8_UNORM;
    desc.extent = {64, 48};
    desc.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    picture_ = *device_->create_image(desc);
  }
  void TearDown() override {
    if (!device_) return;
    EXPECT_EQ(device_->validation_message_count(), 0);
    swapchain_.reset();
    vkDestroySurfaceKHR(device_->instance(), surface_, nullptr);
    EXPECT_EQ(device_->validation_message_count(), 0);
  }
  /// One frame without waiting for it. @return false if there was nothing to draw to.
  bool draw(VkExtent2D window_px) {
    const std::optional<SwapchainFrame> frame = swapchain_->acquire(window_px);
    if (!frame) return false;
    VkCommandBuffer commands = begin();
    swapchain_->show(commands, picture_, *frame);
    swapchain_->finish(commands, *frame);
    EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS);
    device_->submit(commands, {&frame->wait, 1}, {&frame->signal, 1});
    swapchain_->present(*frame);
    return true;
  }
  VkCommandBuffer begin() {
    VkCommandPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool_info.queueFamilyIndex = device_->queue_family();
    VkCommandPool pool{};
    EXPECT_EQ(vkCreateCommandPool(device_->handle(), &pool_info, nullptr, &pool), VK_SUCCESS);
    VkCommandBufferAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    info.commandPool = pool;
    info.commandBufferCount = 1;
    VkCommandBuffer commands{};
    EXPECT_EQ(vkAllocateCommandBuffers(device_->handle(), &info, &commands), VK_SUCCESS);
    VkCommandBufferBeginInfo begin_info{};
    begin_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    EXPECT_EQ(vkBeginCommandBuffer(commands, &begin_info), VK_SUCCESS);
    device_->retire(reinterpret_cast<std::uint64_t>(pool), VK_OBJECT_TYPE_COMMAND_POOL, VK_NULL_HANDLE, 0, {});
    return commands;
  }
  std::unique_ptr<Device> device_;
  VkSurfaceKHR surface_{};
  std::unique_ptr<Swapchain> swapchain_;
  Image picture_;
};

TEST_F(SwapchainTest, ManyFramesInARowReuseNoSemaphoreTooEarly) {
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(draw({64, 48})) << i;
  EXPECT_EQ(swapchain_->generation(), 1u);
}

TEST_F(SwapchainTest, AResizeMakesNewImagesOfThatSize) {
  ASSERT_TRUE(draw({64, 48}));
  ASSERT_TRUE(draw({200, 100}));
  EXPECT_EQ(swapchain_->extent().width, 200u);
  EXPECT_EQ(swapchain_->extent().height, 100u);
  EXPECT_EQ(swapchain_->generation(), 2u);
}

TEST_F(SwapchainTest, AMinimisedWindowGivesNothingAndComesBack) {
  EXPECT_FALSE(draw({0, 0}));
  ASSERT_TRUE(draw({64, 48}));
  EXPECT_FALSE(draw({0, 48}));
  EXPECT_FALSE(draw({0, 0}));
  ASSERT_TRUE(draw({64, 48}));
}

TEST_F(SwapchainTest, AWindowOfOnePixelWorks) {
  ASSERT_TRUE(draw({1, 1}));
  ASSERT_TRUE(draw({1, 1}));
  ASSERT_TRUE(draw({64, 48}));
}

}  // namespace
}  // namespace skerry::gpu
