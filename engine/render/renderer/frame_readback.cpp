#include "engine/render/renderer/frame_readback.h"

#include <cstring>

namespace skerry::render {
namespace {

constexpr std::uint64_t kPixelStatsOffset = shared::kViewCount * sizeof(shared::CullStats);
constexpr std::uint64_t kExposureOffset = kPixelStatsOffset + sizeof(shared::PixelStats);
constexpr std::uint64_t kClusterWorkOffset = kExposureOffset + sizeof(shared::Exposure);

}  // namespace

Result<void> FrameReadback::create(gpu::Device& device) {
  Result<gpu::Buffer> made =
      device.create_buffer({"frame stats", kClusterWorkOffset + sizeof(shared::ClusterWork),
                            VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::kReadback});
  if (!made) return made.error();
  buffer_ = *std::move(made);
  return {};
}

void FrameReadback::add(gpu::FrameGraph& graph, const SceneRefs& scene,
                        const gpu::BufferRef* cull_stats, std::uint32_t views,
                        gpu::BufferRef cluster_work) {
  gpu::BufferRef to = graph.import(buffer_);
  views_ = cull_stats ? views : 0;
  clusters_ = static_cast<bool>(cluster_work);
  graph.add_pass(
      "read_stats",
      [&](gpu::PassBuilder& b) {
        if (cull_stats) b.read(*cull_stats, gpu::Use::kTransferRead);
        b.read(scene.pixel_stats, gpu::Use::kTransferRead);
        b.read(scene.exposure, gpu::Use::kTransferRead);
        if (cluster_work) b.read(cluster_work, gpu::Use::kTransferRead);
        to = b.write(to, gpu::Use::kTransferWrite);
      },
      [to, stats = cull_stats ? *cull_stats : gpu::BufferRef{}, pixels = scene.pixel_stats,
       exposed = scene.exposure, cluster_work, views](gpu::Commands& c) {
        if (stats) c.copy(stats, to, 0, 0, views * sizeof(shared::CullStats));
        c.copy(pixels, to, 0, kPixelStatsOffset, sizeof(shared::PixelStats));
        c.copy(exposed, to, 0, kExposureOffset, sizeof(shared::Exposure));
        if (cluster_work)
          c.copy(cluster_work, to, 0, kClusterWorkOffset, sizeof(shared::ClusterWork));
      });
  graph.add_pass(
      "stats_to_cpu",
      [&](gpu::PassBuilder& b) {
        b.read(to, gpu::Use::kHostRead);
        b.keep();
      },
      [](gpu::Commands&) {});
}

void FrameReadback::take(FrameReport& into) const {
  const std::byte* data = buffer_.mapped();
  for (std::uint32_t v = 0; v < views_; ++v) {
    shared::CullStats one;
    std::memcpy(&one, data + v * sizeof(one), sizeof(one));
    if (v == 0) {
      into.camera = one;
    } else {
      into.shadows.sections_in += one.sections_in;
      into.shadows.sections_passed += one.sections_passed;
      into.shadows.draws += one.draws;
      into.shadows.quads += one.quads;
      into.shadows.quads_in_view += one.quads_in_view;
    }
  }
  std::memcpy(&into.pixels, data + kPixelStatsOffset, sizeof(into.pixels));
  if (clusters_) std::memcpy(&into.clusters, data + kClusterWorkOffset, sizeof(into.clusters));
  shared::Exposure exposed;
  std::memcpy(&exposed, data + kExposureOffset, sizeof(exposed));
  into.exposure_ev = exposed.ev;
  if (exposed.metered != 0) into.metered_ev = exposed.metered_ev;
}

}  // namespace skerry::render
