#include "game/client/play.h"

#include "game/client/app.h"

namespace skerry::game {

Result<void> play(platform::Window& window, gpu::Device& device, VkSurfaceKHR surface,
                  const SceneOptions& options, bool at_title,
                  const std::vector<std::string>& notes) {
  App app(window, device, options, notes);
  if (const auto started = app.start(surface, at_title); !started) return started;
  return app.run();
}

}  // namespace skerry::game
