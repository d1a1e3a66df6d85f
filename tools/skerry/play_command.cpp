#include "tools/skerry/play_command.h"

#include <memory>

#include "engine/gpu/device/device.h"
#include "engine/platform/files.h"
#include "engine/platform/window.h"
#include "game/client/play.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

/// A window's surface, gone before the window and the device are.
class Surface {
 public:
  Surface(VkInstance instance, VkSurfaceKHR surface) : instance_(instance), surface_(surface) {}
  ~Surface() { vkDestroySurfaceKHR(instance_, surface_, nullptr); }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  VkSurfaceKHR handle() const { return surface_; }

 private:
  VkInstance instance_;
  VkSurfaceKHR surface_;
};

}  // namespace

int play_command(const game::SceneOptions& scene, bool at_title,
                 const std::vector<std::string>& notes) {
  const platform::WindowOptions wanted{static_cast<int>(scene.size.width),
                                       static_cast<int>(scene.size.height), "Skerry"};
  auto window = platform::Window::create(wanted);
  if (!window) return fail(kFailed, window.error());
  auto device = open_device(scene, (*window)->vulkan_extensions());
  if (!device) return fail(kNoDevice, device.error());
  const auto surface = (*window)->create_surface((*device)->instance());
  if (!surface) return fail(kFailed, surface.error());
  const Surface owned((*device)->instance(), *surface);
  const auto played = game::play(**window, **device, owned.handle(), scene, at_title, notes);
  if (!played) return fail(kFailed, played.error());
  return status_after(**device);
}

}  // namespace skerry::tools
