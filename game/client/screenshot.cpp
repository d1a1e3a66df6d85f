#include "game/client/screenshot.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <vector>

#include "engine/gpu/transfer/readback.h"
#include "engine/platform/files.h"
#include "engine/platform/image_file.h"

namespace skerry::game {

std::filesystem::path free_screenshot_path(const std::filesystem::path& folder,
                                           std::int64_t time_s) {
  const std::string stem =
      fmt::format("skerry-{:%Y%m%d-%H%M%S}", fmt::gmtime(static_cast<std::time_t>(time_s)));
  std::filesystem::path path = folder / (stem + ".png");
  for (int number = 2; std::filesystem::exists(path); ++number)
    path = folder / fmt::format("{}-{}.png", stem, number);
  return path;
}

Result<std::filesystem::path> save_screenshot(gpu::Device& device, gpu::Image& picture,
                                              const SceneOptions& scene,
                                              const std::optional<IslandView>& from) {
  const std::filesystem::path data = platform::data_dir();
  if (data.empty())
    return Error{"cannot save a screenshot: there is no data folder; set HOME or XDG_DATA_HOME"};
  const std::filesystem::path folder = data / "screenshots";
  if (const auto made = platform::make_dirs(folder); !made) return made.error();
  constexpr std::uint32_t kTexelBytes = 4;
  const auto pixels = gpu::read_back(device, picture, kTexelBytes);
  if (!pixels) return pixels.error();
  const VkExtent2D size = picture.desc().extent;
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(pixels->data()),
                                            pixels->size());
  std::vector<platform::PngText> text{{"Software", "Skerry"}, {"Command", shot_command(scene)}};
  if (from) text.push_back(text_of(*from));
  const std::filesystem::path path = free_screenshot_path(folder, std::time(nullptr));
  if (const auto written = platform::write_png(path, {size.width, size.height, 4, bytes}, text);
      !written) {
    return written.error();
  }
  return path;
}

}  // namespace skerry::game
