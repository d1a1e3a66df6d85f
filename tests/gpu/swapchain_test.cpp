// The swapchain of a real window; needs a display (xvfb-run will do) and is skipped without.
#include "engine/gpu/transfer/swapchain.h"

#include <gtest/gtest.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

class SwapchainTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!glfwInit()) GTEST_SKIP() << "no display";
    DeviceOptions options;
    options.validate = true;
    std::uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    options.surface_extensions.assign(extensions, extensions + count);
    Result<std::unique_ptr<Device>> made = Device::create(options);
    ASSERT_TRUE(made) << made.error().message;
    device_ = *std::move(made);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(64, 48, "swapchain test", nullptr, nullptr);
    ASSERT_TRUE(window_);
    VkSurfaceKHR surface{};
    ASSERT_EQ(glfwCreateWindowSurface(device_->instance(), window_, nullptr, &surface), VK_SUCCESS);
    surface_ = surface;
    Result<std::unique_ptr<Swapchain>> swapchain = Swapchain::create(*device_, surface_, Sync::kOn);
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
    picture_ = {};
    swapchain_.reset();
    if (device_) {
      vkDestroySurfaceKHR(device_->instance(), surface_, nullptr);
      EXPECT_EQ(device_->validation_message_count(), 0);
    }
    device_.reset();
    if (window_) glfwDestroyWindow(window_);
    glfwTerminate();
  }
  /// Changes the window's size and waits until the window system has done so.
  void resize(int width, int height) {
    glfwSetWindowSize(window_, width, height);
    for (int i = 0; i < 100; ++i) {
      glfwWaitEventsTimeout(0.02);
      int w = 0, h = 0;
      glfwGetFramebufferSize(window_, &w, &h);
      if (w == width && h == height) return;
    }
    FAIL() << "the window keeps its size";
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
    auto pool_info = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool_info.queueFamilyIndex = device_->queue_family();
    VkCommandPool pool{};
    EXPECT_EQ(vkCreateCommandPool(device_->handle(), &pool_info, nullptr, &pool), VK_SUCCESS);
    auto info =
        vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool;
    info.commandBufferCount = 1;
    VkCommandBuffer commands{};
    EXPECT_EQ(vkAllocateCommandBuffers(device_->handle(), &info, &commands), VK_SUCCESS);
    const auto begin_info =
        vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    EXPECT_EQ(vkBeginCommandBuffer(commands, &begin_info), VK_SUCCESS);
    device_->retire(reinterpret_cast<std::uint64_t>(pool), VK_OBJECT_TYPE_COMMAND_POOL,
                    VK_NULL_HANDLE, 0, {});
    return commands;
  }
  GLFWwindow* window_ = nullptr;
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
  resize(200, 100);
  ASSERT_TRUE(draw({200, 100}));
  EXPECT_EQ(swapchain_->extent().width, 200u);
  EXPECT_EQ(swapchain_->extent().height, 100u);
  EXPECT_EQ(swapchain_->generation(), 2u);
}

TEST_F(SwapchainTest, AResizeNobodyToldUsAboutIsNoticed) {
  ASSERT_TRUE(draw({64, 48}));
  resize(120, 90);
  // The caller still believes in the old size; the surface knows better, within a frame or two.
  for (int i = 0; i < 3; ++i) draw({64, 48});
  EXPECT_EQ(swapchain_->extent().width, 120u);
  EXPECT_EQ(swapchain_->extent().height, 90u);
}

TEST_F(SwapchainTest, AMinimisedWindowGivesNothingAndComesBack) {
  EXPECT_FALSE(draw({0, 0}));
  ASSERT_TRUE(draw({64, 48}));
  EXPECT_FALSE(draw({0, 48}));
  EXPECT_FALSE(draw({0, 0}));
  ASSERT_TRUE(draw({64, 48}));
}

TEST_F(SwapchainTest, AWindowOfOnePixelWorks) {
  resize(1, 1);
  ASSERT_TRUE(draw({1, 1}));
  ASSERT_TRUE(draw({1, 1}));
  EXPECT_EQ(swapchain_->extent().width, 1u);
  resize(64, 48);
  ASSERT_TRUE(draw({64, 48}));
}

TEST_F(SwapchainTest, NewImagesComeWithAllFramesStillInFlight) {
  for (int i = 0; i < 10; ++i) {
    const int width = 64 + 16 * i;
    resize(width, 48);
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(draw({static_cast<std::uint32_t>(width), 48}));
  }
}

}  // namespace
}  // namespace skerry::gpu
