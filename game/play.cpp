#include "game/play.h"

#include <utility>

#include "game/play_loop.h"

namespace skerry::game {

Result<void> play(platform::Window& window, gpu::Device& device, VkSurfaceKHR surface,
                  const SceneOptions& options) {
  auto view = SceneView::create(device, options);
  if (!view) return view.error();
  PlayLoop loop(window, device, options, *std::move(view));
  if (const auto started = loop.start(surface); !started) return started;
  return loop.run();
}

}  // namespace skerry::game
