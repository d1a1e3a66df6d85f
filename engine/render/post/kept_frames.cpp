#include "engine/render/post/kept_frames.h"

#include <algorithm>

#include "engine/render/scene/grow_buffer.h"

namespace skerry::render {

Result<void> KeptFrames::ensure(VkExtent2D size) {
  if (frames_[1].mixed && gpu::same_size(frames_[1].mixed.desc().extent, size)) return {};
  ++generation_;
  frames_ = {};
  const auto make = [&](gpu::Image& image, const char* name, VkFormat format,
                        VkImageUsageFlags usage) -> Result<void> {
    Result<gpu::Image> made = device_->create_image(
        {.name = name,
         .format = format,
         .extent = size,
         .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    if (!made) return made.error();
    image = *std::move(made);
    return {};
  };
  for (Frame& frame : frames_) {
    if (Result<void> ok = make(frame.surfaces, "kept surfaces", VK_FORMAT_R32_UINT,
                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
        !ok)
      return ok;
    if (Result<void> ok = make(frame.depth, "kept depth", VK_FORMAT_D32_SFLOAT,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        !ok)
      return ok;
    if (Result<void> ok = make(frame.mixed, "mixed picture", VK_FORMAT_R16G16B16A16_SFLOAT,
                               VK_IMAGE_USAGE_STORAGE_BIT);
        !ok)
      return ok;
  }
  return {};
}

Result<void> KeptFrames::upload(gpu::Uploader& uploader, std::span<const shared::Motion> motions) {
  if (!motions_ || motions_.size_bytes() < motions.size_bytes()) {
    constexpr std::uint64_t kUsualBytes = std::uint64_t{1} << 16;
    const std::uint64_t bytes = std::max<std::uint64_t>(2 * motions.size_bytes(), kUsualBytes);
    Result<gpu::Buffer> made =
        device_->create_buffer({"motions", bytes, kTexelTableUsage, gpu::Memory::kDevice, true});
    if (!made) return made.error();
    motions_ = *std::move(made);
  }
  uploader.write(motions_, 0, motions);
  return {};
}

}  // namespace skerry::render
