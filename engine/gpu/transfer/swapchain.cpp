#include "engine/gpu/transfer/swapchain.h"

#include <algorithm>
#include <limits>

#include "engine/core/check.h"
#include "engine/gpu/device/access.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

/// First use of an acquired image. Waiting there alone lets all other work of the frame start
/// before the window is ready.
constexpr VkPipelineStageFlags2 kFirstUse = VK_PIPELINE_STAGE_2_BLIT_BIT;

VkSemaphore create_semaphore(Device& device, const char* name) {
  const auto info = vk_struct<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
  VkSemaphore semaphore{};
  GPU_CHECK(vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore));
  device.set_name(reinterpret_cast<std::uint64_t>(semaphore), VK_OBJECT_TYPE_SEMAPHORE, name);
  return semaphore;
}

// The picture holds sRGB-coded values already, so a format that would code them again is not
// wanted.
std::optional<VkSurfaceFormatKHR> choose_format(const Device& device, VkSurfaceKHR surface) {
  std::uint32_t count = 0;
  GPU_CHECK(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface, &count, nullptr));
  std::vector<VkSurfaceFormatKHR> formats(count);
  GPU_CHECK(
      vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), surface, &count, formats.data()));
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device.physical(), wanted, &properties);
    if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_BLIT_DST_BIT)) continue;
    for (const VkSurfaceFormatKHR& format : formats) {
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
        return format;
    }
  }
  return std::nullopt;
}

/// The nearest mode to what is wanted; every device has first in, first out.
VkPresentModeKHR choose_mode(const Device& device, VkSurfaceKHR surface, Sync sync) {
  std::uint32_t count = 0;
  GPU_CHECK(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, nullptr));
  std::vector<VkPresentModeKHR> modes(count);
  GPU_CHECK(
      vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical(), surface, &count, modes.data()));
  const auto has = [&modes](VkPresentModeKHR mode) {
    return std::find(modes.begin(), modes.end(), mode) != modes.end();
  };
  if (sync == Sync::kOff)
    for (const VkPresentModeKHR mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
      if (has(mode)) return mode;
  if (sync == Sync::kAdaptive && has(VK_PRESENT_MODE_FIFO_RELAXED_KHR))
    return VK_PRESENT_MODE_FIFO_RELAXED_KHR;
  return VK_PRESENT_MODE_FIFO_KHR;
}

VkExtent2D choose_extent(const VkSurfaceCapabilitiesKHR& caps, VkExtent2D window_px) {
  if (caps.currentExtent.width != std::numeric_limits<std::uint32_t>::max())
    return caps.currentExtent;
  return {std::clamp(window_px.width, caps.minImageExtent.width, caps.maxImageExtent.width),
          std::clamp(window_px.height, caps.minImageExtent.height, caps.maxImageExtent.height)};
}

void transition(VkCommandBuffer commands, VkImage image, const Scopes& scopes, VkImageLayout from,
                VkImageLayout to) {
  auto barrier = vk_struct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
  barrier.srcStageMask = scopes.src_stages;
  barrier.srcAccessMask = scopes.src_access;
  barrier.dstStageMask = scopes.dst_stages;
  barrier.dstAccessMask = scopes.dst_access;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, VkSurfaceKHR surface,
                                                     Sync sync) {
  const std::string who = "cannot present to this window with " + device.info().name + ": ";
  VkBool32 supported = VK_FALSE;
  GPU_CHECK(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(), surface,
                                                 &supported));
  if (!supported) return Error{who + "its queue cannot present; choose another with --device"};
  const std::optional<VkSurfaceFormatKHR> format = choose_format(device, surface);
  if (!format)
    return Error{who + "it offers no 8-bit format to copy to; choose another with --device"};
  VkSurfaceCapabilitiesKHR caps{};
  GPU_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &caps));
  constexpr VkImageUsageFlags kNeeded =
      VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if ((caps.supportedUsageFlags & kNeeded) != kNeeded) {
    return Error{who + "its images cannot be copied to; choose another with --device"};
  }
  std::unique_ptr<Swapchain> swapchain(new Swapchain(device, surface));
  swapchain->format_ = *format;
  swapchain->mode_ = choose_mode(device, surface, sync);
  return swapchain;
}

void Swapchain::set_sync(Sync sync) {
  const VkPresentModeKHR mode = choose_mode(device_, surface_, sync);
  stale_ |= mode != mode_;
  mode_ = mode;
}

Swapchain::~Swapchain() {
  vkDeviceWaitIdle(device_.handle());
  destroy_images();
  for (const Acquire& acquire : acquires_)
    vkDestroySemaphore(device_.handle(), acquire.semaphore, nullptr);
  if (handle_) vkDestroySwapchainKHR(device_.handle(), handle_, nullptr);
}

void Swapchain::destroy_images() {
  for (const PerImage& image : images_) {
    vkDestroyImageView(device_.handle(), image.view, nullptr);
    vkDestroySemaphore(device_.handle(), image.drawn, nullptr);
  }
  images_.clear();
}

// Rare, so it may wait for the GPU: then nothing old is in use any more. @return false if there is
// nothing to draw to.
bool Swapchain::rebuild(VkExtent2D window_px) {
  VkSurfaceCapabilitiesKHR caps{};
  GPU_CHECK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &caps));
  const VkExtent2D extent = choose_extent(caps, window_px);
  if (extent.width == 0 || extent.height == 0) return false;
  GPU_CHECK(vkDeviceWaitIdle(device_.handle()));
  destroy_images();
  auto info = vk_struct<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
  info.surface = surface_;
  info.minImageCount = std::max(caps.minImageCount, 3u);
  if (caps.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, caps.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.preTransform = caps.currentTransform;
  const bool opaque = (caps.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0;
  info.compositeAlpha =
      opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = mode_;
  info.clipped = VK_TRUE;
  info.oldSwapchain = handle_;
  VkSwapchainKHR made{};
  GPU_CHECK(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &made));
  if (handle_) vkDestroySwapchainKHR(device_.handle(), handle_, nullptr);
  handle_ = made;
  device_.set_name(reinterpret_cast<std::uint64_t>(handle_), VK_OBJECT_TYPE_SWAPCHAIN_KHR,
                   "swapchain");
  extent_ = extent;
  window_px_ = window_px;
  stale_ = false;
  ++generation_;
  adopt_images();
  return true;
}

void Swapchain::adopt_images() {
  std::uint32_t count = 0;
  GPU_CHECK(vkGetSwapchainImagesKHR(device_.handle(), handle_, &count, nullptr));
  std::vector<VkImage> handles(count);
  GPU_CHECK(vkGetSwapchainImagesKHR(device_.handle(), handle_, &count, handles.data()));
  for (const VkImage handle : handles) {
    PerImage image{handle, {}, create_semaphore(device_, "window image drawn")};
    auto view = vk_struct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
    view.image = handle;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    GPU_CHECK(vkCreateImageView(device_.handle(), &view, nullptr, &image.view));
    device_.set_name(reinterpret_cast<std::uint64_t>(handle), VK_OBJECT_TYPE_IMAGE, "window image");
    device_.set_name(reinterpret_cast<std::uint64_t>(image.view), VK_OBJECT_TYPE_IMAGE_VIEW,
                     "window image");
    images_.push_back(image);
  }
  // One more than images: all images may be acquired and queued while the next acquire needs a
  // semaphore of its own.
  while (acquires_.size() < images_.size() + 1)
    acquires_.push_back({create_semaphore(device_, "window image acquired"), 0});
}

std::optional<SwapchainFrame> Swapchain::acquire(VkExtent2D window_px) {
  SKERRY_ASSERT(!acquired_);
  if (window_px.width == 0 || window_px.height == 0) return std::nullopt;
  const bool resized = window_px.width != window_px_.width || window_px.height != window_px_.height;
  if ((!handle_ || stale_ || resized) && !rebuild(window_px)) return std::nullopt;
  const Acquire acquire = acquires_[next_acquire_];
  device_.wait(acquire.value);  // its last wait has been done, so the semaphore is free
  std::uint32_t index = 0;
  // A window that changes its size all the time can outrun us; then this frame is skipped.
  for (int attempt = 0; attempt < 3; ++attempt) {
    const VkResult result =
        vkAcquireNextImageKHR(device_.handle(), handle_, std::numeric_limits<std::uint64_t>::max(),
                              acquire.semaphore, VK_NULL_HANDLE, &index);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
      stale_ = result == VK_SUBOPTIMAL_KHR;
      acquired_ = true;
      break;
    }
    if (result != VK_ERROR_OUT_OF_DATE_KHR) GPU_CHECK(result);
    if (!rebuild(window_px)) return std::nullopt;
  }
  if (!acquired_) return std::nullopt;
  SwapchainFrame frame;
  frame.index = index;
  frame.wait = vk_struct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  frame.wait.semaphore = acquire.semaphore;
  frame.wait.stageMask = kFirstUse;
  frame.signal = vk_struct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
  frame.signal.semaphore = images_[index].drawn;
  frame.signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  return frame;
}

void Swapchain::show(VkCommandBuffer commands, Image& picture, const SwapchainFrame& frame) {
  const VkImage target = images_[frame.index].image;
  touch(device_, commands, picture,
        {VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, false});
  transition(commands, target,
             {kFirstUse, 0, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
             VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkExtent2D from = picture.desc().extent;
  const auto corner = [](VkExtent2D e) {
    return VkOffset3D{static_cast<std::int32_t>(e.width), static_cast<std::int32_t>(e.height), 1};
  };
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = corner(from);
  region.dstOffsets[1] = corner(extent_);
  vkCmdBlitImage(commands, picture.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                 same_size(from, extent_) ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
  transition(commands, target,
             {VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
              VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
              VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

void Swapchain::finish(VkCommandBuffer commands, const SwapchainFrame& frame) {
  // The semaphore that presenting waits for makes the image visible to it: no second scope.
  transition(commands, images_[frame.index].image,
             {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
              VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, 0, 0},
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

void Swapchain::present(const SwapchainFrame& frame) {
  SKERRY_ASSERT(acquired_);
  acquired_ = false;
  acquires_[next_acquire_].value = device_.next_value() - 1;
  next_acquire_ = (next_acquire_ + 1) % acquires_.size();
  auto info = vk_struct<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &frame.signal.semaphore;
  info.swapchainCount = 1;
  info.pSwapchains = &handle_;
  info.pImageIndices = &frame.index;
  const VkResult result = vkQueuePresentKHR(device_.queue(), &info);
  if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR) {
    stale_ = true;
  } else {
    GPU_CHECK(result);
  }
}

}  // namespace skerry::gpu
