#pragma once
#include <gtest/gtest.h>
#include <volk.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <vector>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/sky.h"
#include "tests/gpu/compile_glsl.h"

namespace skerry::render {

inline constexpr double kHour = 3600.0;
using Texel = std::array<std::uint16_t, 4>;

inline double luminance(glm::dvec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

inline glm::dvec3 decoded(const Texel& t) {
  return {glm::unpackHalf1x16(t[0]), glm::unpackHalf1x16(t[1]), glm::unpackHalf1x16(t[2])};
}

/// What the shading passes do with a ray into the open, to radiance.
inline constexpr const char* kSeeSky =
    "#include \"include/frame/common.glsl\"\n"
    "#include \"shared/sky.h\"\n"
    R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) uniform Sky { SkyConstants sky; };
layout(binding = 2) uniform sampler2D sky_lut;
layout(binding = 3, rgba16f) writeonly uniform image2D radiance;
)"
    "#include \"include/sky/stars.glsl\"\n"
    R"(
void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, frame.size))) return;
  vec3 colour = sky_seen(normalize(pixel_ray(pixel)), true, true);
  imageStore(radiance, ivec2(pixel), vec4(colour, 1.0));
})";

/// Tone curve and encoding, without and with dither.
inline constexpr const char* kDevelop =
    "#include \"include/post/tonemap.glsl\"\n"
    R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) readonly uniform image2D radiance;
layout(binding = 1, rgba8) writeonly uniform image2D picture;
layout(binding = 2, rgba8) writeonly uniform image2D grained;
void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  vec3 encoded = srgb_encode(tone_map(imageLoad(radiance, pixel).rgb * 0.7));
  imageStore(picture, pixel, vec4(encoded, 1.0));
  imageStore(grained, pixel, vec4(dithered(encoded, uvec2(pixel)), 1.0));
})";

/// One binding of a compute shader.
struct Bind {
  std::uint32_t binding;
  const gpu::Buffer* buffer = nullptr;
  const gpu::Image* image = nullptr;
  VkSampler sampler = VK_NULL_HANDLE;
};

/// Runs single compute shaders. Every image stays in the general layout.
class SkyOnGpu : public testing::Test {
 protected:
  void SetUp() override {
    Result<std::unique_ptr<gpu::Device>> created = gpu::Device::create({});
    if (!created) GTEST_SKIP() << created.error().message;
    device_ = std::move(*created);
    shaders_.assign(gpu::embedded_shaders().begin(), gpu::embedded_shaders().end());
    shaders_.push_back(see_sky_.embedded());
    shaders_.push_back(develop_.embedded());
    pipelines_ = std::make_unique<gpu::Pipelines>(*device_, shaders_);
  }

  gpu::Buffer buffer(const void* data, std::size_t size,
                     gpu::Memory memory = gpu::Memory::kUpload) {
    const VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
        VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Result<gpu::Buffer> made = device_->create_buffer(
        {.name = "test", .size_bytes = size, .usage = usage, .memory = memory});
    EXPECT_TRUE(made);
    if (data) std::memcpy(made->mapped(), data, size);
    return std::move(*made);
  }
  template <class T>
  gpu::Buffer buffer(const T& value) {
    return buffer(&value, sizeof value);
  }

  gpu::Image image(std::uint32_t width, std::uint32_t height, VkFormat format) {
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                    VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    Result<gpu::Image> made = device_->create_image(
        {.name = "test", .format = format, .extent = {width, height}, .usage = usage});
    EXPECT_TRUE(made);
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.image = made->handle();
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    device_->run_now([&](VkCommandBuffer c) { vkCmdPipelineBarrier2(c, &info); });
    return std::move(*made);
  }

  /// Everything done so far is seen by everything that follows.
  static void order_memory(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
  }

  void dispatch(const char* shader, const std::vector<Bind>& binds, std::uint32_t width,
                std::uint32_t height) {
    const gpu::Pipeline& pipeline = pipelines_->get(gpu::ComputeDesc{shader, {}});
    std::vector<VkDescriptorBufferInfo> buffers(binds.size());
    std::vector<VkDescriptorImageInfo> images(binds.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (std::size_t i = 0; i < binds.size(); ++i) {
      VkWriteDescriptorSet write{};
      write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      write.dstBinding = binds[i].binding;
      write.descriptorCount = 1;
      for (const gpu::Pipeline::Binding& declared : pipeline.bindings) {
        if (declared.binding == write.dstBinding) write.descriptorType = declared.type;
      }
      if (binds[i].buffer) {
        buffers[i] = {binds[i].buffer->handle(), 0, VK_WHOLE_SIZE};
        write.pBufferInfo = &buffers[i];
      } else {
        images[i] = {binds[i].sampler, binds[i].image->view(), VK_IMAGE_LAYOUT_GENERAL};
        write.pImageInfo = &images[i];
      }
      writes.push_back(write);
    }
    device_->run_now([&](VkCommandBuffer c) {
      order_memory(c);
      vkCmdBindPipeline(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.made().handle);
      vkCmdPushDescriptorSetKHR(c, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0,
                                static_cast<std::uint32_t>(writes.size()), writes.data());
      vkCmdDispatch(c, (width + 7) / 8, (height + 7) / 8, 1);
    });
  }

  void copy(const gpu::Image& from, const gpu::Buffer& to, bool back = false) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {from.desc().extent.width, from.desc().extent.height, 1};
    device_->run_now([&](VkCommandBuffer c) {
      order_memory(c);
      if (back) {
        vkCmdCopyBufferToImage(c, to.handle(), from.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &region);
      } else {
        vkCmdCopyImageToBuffer(c, from.handle(), VK_IMAGE_LAYOUT_GENERAL, to.handle(), 1, &region);
      }
    });
  }

  template <class T>
  std::vector<T> read(const gpu::Image& from) {
    std::vector<T> texels(std::size_t{from.desc().extent.width} * from.desc().extent.height);
    const gpu::Buffer back = buffer(nullptr, texels.size() * sizeof(T), gpu::Memory::kReadback);
    copy(from, back);
    std::memcpy(texels.data(), back.mapped(), texels.size() * sizeof(T));
    return texels;
  }

  gpu::Image baked(const SkyModel& sky) {
    gpu::Image lut =
        image(shared::kSkyLutWidth, shared::kSkyLutHeight, VK_FORMAT_R16G16B16A16_SFLOAT);
    const SkyScattering scattering = scattering_of_bodies(sky);
    const gpu::Buffer constants = buffer(sky.constants),
                      table = buffer(scattering.data(), scattering.size() * sizeof(scattering[0]));
    dispatch("bake_sky.comp",
             {{shared::kSkyBinding, &constants},
              {shared::kSkyScatteringBinding, &table},
              {shared::kSkyTableBinding, nullptr, &lut}},
             shared::kSkyLutWidth, shared::kSkyLutHeight);
    return lut;
  }

  /// What a camera looking along `forward` sees of the sky.
  std::vector<glm::dvec3> seen(const SkyModel& sky, glm::vec3 forward, float tan_half_fov,
                               glm::uvec2 size) {
    const gpu::Image lut = baked(sky),
                     radiance = image(size.x, size.y, VK_FORMAT_R16G16B16A16_SFLOAT);
    shared::FrameConstants frame{};
    frame.ray_forward = glm::normalize(forward);
    frame.ray_right =
        glm::normalize(glm::cross(frame.ray_forward, glm::vec3(0.001f, 1.0f, 0.002f)));
    frame.ray_up = glm::cross(frame.ray_right, frame.ray_forward) * tan_half_fov;
    frame.ray_right *= tan_half_fov * static_cast<float>(size.x) / static_cast<float>(size.y);
    frame.pixel_to_ndc = 2.0f / glm::vec2(size);
    frame.sample_in_pixel = glm::vec2(0.5f);
    frame.size = size;
    frame.sky_horizon = sky.constants.horizon;
    const gpu::Buffer frame_buffer = buffer(frame), sky_buffer = buffer(sky.constants);
    const VkSampler sampler = *device_->sampler({});
    dispatch("see_sky.comp",
             {{0, &frame_buffer},
              {1, &sky_buffer},
              {2, nullptr, &lut, sampler},
              {3, nullptr, &radiance}},
             size.x, size.y);
    std::vector<glm::dvec3> result;
    for (const Texel& t : read<Texel>(radiance)) result.push_back(decoded(t));
    return result;
  }

  std::unique_ptr<gpu::Device> device_;
  gpu::TestShader see_sky_{"see_sky.comp", kSeeSky}, develop_{"develop_test.comp", kDevelop};
  std::vector<gpu::EmbeddedShader> shaders_;
  std::unique_ptr<gpu::Pipelines> pipelines_;
};

}  // namespace skerry::render
