#include "engine/render/post/kept_frames.h"

#include <algorithm>

#include "engine/render/scene/grow_buffer.h"

namespace skerry::render {

Result<void> KeptFrames::ensure(VkExtent2D size) {
  if (keys_ && gpu::same_size(size_, size)) return {};
  ++generation_;
  pictures_ = {};
  keys_ = {};
  const auto make = [&](gpu::Image& image, const char* name) -> Result<void> {
    Result<gpu::Image> made = device_->create_image(
        {.name = name,
         .format = VK_FORMAT_R32_UINT,
         .extent = size,
         .layers = shared::kMixedFrames,
         .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    if (!made) return made.error();
    image = *std::move(made);
    return {};
  };
  if (Result<void> ok = make(pictures_, "kept pictures"); !ok) return ok;
  if (Result<void> ok = make(keys_, "kept keys"); !ok) return ok;
  size_ = size;
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
