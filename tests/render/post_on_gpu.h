#pragma once
#include <cstring>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/gpu/program/pipeline.h"
#include "engine/gpu/transfer/readback.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/exposure.h"
#include "shaders/shared/frame.h"
#include "tests/gpu/test_device.h"
#include "tools/measure/picture.h"

namespace skerry::render {

/// Passes that make a picture of radiance, fed with radiance of a test's own making.
class PostOnGpu : public gpu::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    pipelines_ = std::make_unique<gpu::Pipelines>(device());
    graph_ = std::make_unique<gpu::FrameGraph>(&device());
    uploader_ = std::make_unique<gpu::Uploader>(device(), gpu::UploadPath::kUpdateBuffer);
  }
  void TearDown() override {
    graph_.reset();
    pipelines_.reset();
    uploader_.reset();
    radiance_ = {};
    frame_ = {};
    exposure_ = {};
    stats_ = {};
    GpuTest::TearDown();
  }

  gpu::FrameGraph& graph() { return *graph_; }
  gpu::Pipelines& pipelines() { return *pipelines_; }

  /// Runs passes over a picture, whose pixels are rounded to half precision.
  /// @param add adds them. @param given the exposure before them.
  void run(const measure::Picture& picture, const shared::Exposure& given,
           const std::function<void(SceneRefs&, gpu::ImageRef radiance)>& add) {
    std::vector<std::uint64_t> texels;
    for (const glm::vec3& c : picture.pixels)
      texels.push_back(glm::packHalf4x16(glm::vec4(c, 1.0f)));
    radiance_ = image({.name = "radiance",
                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                       .extent = {picture.width, picture.height},
                       .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    ASSERT_TRUE(uploader_->fill_image(radiance_, std::as_bytes(std::span(texels))));
    shared::FrameConstants constants{};
    constants.size = constants.picture_size = {picture.width, picture.height};
    fill(frame_, "frame constants", constants);
    fill(exposure_, "exposure", given);
    fill(stats_, "pixel stats", shared::PixelStats{});
    graph_->begin();
    SceneRefs scene;
    scene.frame = graph_->import(frame_);
    scene.exposure = graph_->import(exposure_);
    scene.pixel_stats = graph_->import(stats_);
    scene.size = {picture.width, picture.height};
    add(scene, graph_->import(radiance_));
    graph_->compile();
    device().run_now([&](VkCommandBuffer commands) {
      uploader_->record(commands, UINT64_MAX);
      graph_->execute(commands, 0);
    });
  }

  shared::Exposure exposure() { return contents<shared::Exposure>(exposure_)[0]; }
  gpu::Buffer room(const char* name, std::uint64_t bytes) {
    return buffer(name, bytes,
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  }
  /// Copies a buffer of the graph to one that outlives it.
  void keep(gpu::BufferRef from, gpu::Buffer& to) {
    gpu::BufferRef kept = graph_->import(to);
    const std::uint64_t bytes = to.size_bytes();
    graph_->add_pass(
        "keep",
        [&](gpu::PassBuilder& b) {
          b.read(from, gpu::Use::kTransferRead);
          kept = b.write(kept, gpu::Use::kTransferWrite);
        },
        [from, kept, bytes](gpu::Commands& c) { c.copy(from, kept, 0, 0, bytes); });
  }

 private:
  template <class T>
  void fill(gpu::Buffer& to, const char* name, const T& value) {
    to = room(name, sizeof(T));
    uploader_->write(to, 0, std::span<const T>(&value, 1));
  }

  std::unique_ptr<gpu::Pipelines> pipelines_;
  std::unique_ptr<gpu::FrameGraph> graph_;
  std::unique_ptr<gpu::Uploader> uploader_;
  gpu::Image radiance_;
  gpu::Buffer frame_, exposure_, stats_;
};

}  // namespace skerry::render
