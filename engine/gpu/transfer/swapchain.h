#pragma once
#include <volk.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {

class Device;

/// What presenting does with a frame that comes between two refreshes of the display.
enum class Sync : std::uint8_t {
  kOff,       ///< never waits: the newest frame wins, without tearing where the device can
  kOn,        ///< waits for the next refresh
  kAdaptive,  ///< as kOn, but a frame that missed its refresh is shown at once, torn
};

/// One image of the window, from acquire() to present().
struct SwapchainFrame {
  std::uint32_t index = 0;         ///< of the image
  VkSemaphoreSubmitInfo wait{};    ///< what the submit that draws it must wait for
  VkSemaphoreSubmitInfo signal{};  ///< and signal
};

/// The images of a window. Use: acquire(), record show(), the UI, finish(), submit with the frame's
/// semaphores, present().
class Swapchain {
 public:
  /// @param surface of the device's instance; the caller destroys it after this. @param sync of
  /// what the device lacks the nearest is taken. Errors: this device cannot present to the surface.
  static Result<std::unique_ptr<Swapchain>> create(Device& device, VkSurfaceKHR surface, Sync sync);
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;
  ~Swapchain();  ///< waits for the GPU

  /// From the next acquire() on.
  void set_sync(Sync sync);
  /// Whether acquire(), and what is submitted for its frame, may wait for the display's refresh.
  bool waits_for_display() const {
    return mode_ == VK_PRESENT_MODE_FIFO_KHR || mode_ == VK_PRESENT_MODE_FIFO_RELAXED_KHR;
  }

  /// The next image to draw, waiting until there is one. Makes the images anew when the window has
  /// another size or they are out of date. @param window_px size of the window's framebuffer now.
  /// @return nothing while the window has no area (minimised): wait for window events then, do not
  /// ask again at once.
  std::optional<SwapchainFrame> acquire(VkExtent2D window_px);
  /// Records the picture over the whole image, scaled if the sizes differ (needs usage
  /// TRANSFER_SRC), and makes the image ready to be a colour attachment.
  void show(VkCommandBuffer commands, Image& picture, const SwapchainFrame& frame);
  /// Records what presenting needs. The image must be in COLOR_ATTACHMENT_OPTIMAL, as show() left
  /// it and a UI pass keeps it.
  void finish(VkCommandBuffer commands, const SwapchainFrame& frame);
  /// Queues the image for the window, after the submit. Each acquired frame must get here.
  void present(const SwapchainFrame& frame);

  VkFormat format() const {
    return format_.format;
  }  ///< UNORM: sRGB-coded values are stored as they are
  VkExtent2D extent() const { return extent_; }
  VkImageView view(std::uint32_t index) const { return images_[index].view; }
  /// Changes whenever views and extent do: framebuffers made from them are then void.
  std::uint32_t generation() const { return generation_; }

 private:
  struct PerImage {
    VkImage image{};
    VkImageView view{};
    VkSemaphore drawn{};  ///< presenting waits for it; acquiring the image again proves that it has
  };
  struct Acquire {
    VkSemaphore semaphore{};
    std::uint64_t value = 0;  ///< the submit that waits for it is done at this timeline value
  };
  Swapchain(Device& device, VkSurfaceKHR surface) : device_(device), surface_(surface) {}
  bool rebuild(VkExtent2D window_px);
  void adopt_images();
  void destroy_images();
  Device& device_;
  VkSurfaceKHR surface_;
  VkSurfaceFormatKHR format_{};
  VkPresentModeKHR mode_ = VK_PRESENT_MODE_FIFO_KHR;
  VkSwapchainKHR handle_{};
  VkExtent2D extent_{}, window_px_{};
  std::vector<PerImage> images_;
  std::vector<Acquire> acquires_;
  std::size_t next_acquire_ = 0;
  std::uint32_t generation_ = 0;
  bool stale_ = false;     ///< the images still work but no longer fit the window
  bool acquired_ = false;  ///< between acquire() and present()
};

}  // namespace skerry::gpu
