#pragma once
#include <volk.h>

#include <cstdint>
#include <vector>

#include "engine/core/result.h"
#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/settings.h"
#include "shaders/shared/bindings.h"

namespace skerry::gpu {
class Device;
}

namespace skerry::render {

/// VK_FORMAT_UNDEFINED: not kept.
VkFormat normal_format(NormalStore store);
VkFormat position_format(PositionStore store);
VkFormat depth_format(DepthStore store);

/// What a texel of that image means: a code of shaders/include/scene/stored.glsl.
std::uint32_t normal_code(NormalStore store);

/// What a compute pass needs that asks shaders/include/surface/surface.glsl for surfaces.
struct SurfaceReads {
  explicit SurfaceReads(const Geometry& geometry);
  /// Adds what the shader is specialised by.
  std::vector<gpu::SpecConstant> with_store(std::vector<gpu::SpecConstant> own) const;
  /// The same for one that asks shaders/include/scene/coverage.glsl alone.
  std::vector<gpu::SpecConstant> with_depth(std::vector<gpu::SpecConstant> own) const;
  void declare(gpu::PassBuilder& builder) const;
  auto bindings(VkSampler point) const {
    return std::tuple{
        gpu::storage<shared::kSurfacesBinding>(words),
        gpu::sampled<shared::kDepthsBinding>(depth, point),
        // What is not kept is never read; depth is bound in its place so that every binding is
        // valid.
        gpu::sampled<shared::kStoredNormalsBinding>(normals ? normals : depth, point),
        gpu::sampled<shared::kStoredPositionsBinding>(positions ? positions : depth, point)};
  }

  gpu::ImageRef words, depth, normals, positions;
  GBufferStore store;
};

/// Whether the device can draw to and sample these formats; the error names the one it cannot.
Result<void> check_store(const gpu::Device& device, const GBufferStore& store);

}  // namespace skerry::render
