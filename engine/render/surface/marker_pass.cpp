#include "engine/render/surface/marker_pass.h"
#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

#include <shader_names.h>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace skerry::render {
namespace {

using gpu::Use;

constexpr float kLineShare = 1.0f / 800.0f;  // half a line's width, of the picture's height
constexpr float kThinnest = 0.8f;            // pixels
constexpr float kAround = 2.5f;  // pixels that lines and their rims reach beyond half a width

struct PixelBox {
  glm::vec2 low, high;
};

/// Pixels that the box can touch: all when it reaches behind the eye.
PixelBox box_in_picture(const shared::MarkerConstants& m, glm::vec2 size) {
  PixelBox box{glm::vec2(INFINITY), glm::vec2(-INFINITY)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 share((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
    const glm::vec3 from_eye = share * m.size - m.eye;
    const float z = glm::dot(from_eye, m.forward);
    if (z < kNearPlane) return {glm::vec2(0.0f), size};
    const glm::vec2 ndc = glm::vec2(glm::dot(from_eye, m.right) / glm::dot(m.right, m.right),
                                    -glm::dot(from_eye, m.up) / glm::dot(m.up, m.up)) /
                          z;
    const glm::vec2 pixel = (ndc + 1.0f) * 0.5f * size;
    box = {glm::min(box.low, pixel), glm::max(box.high, pixel)};
  }
  return box;
}

}  // namespace

std::optional<shared::MarkerConstants> marker_constants(const BlockMarker& marker,
                                                        const IslandPlacement& island,
                                                        const Camera& camera, VkExtent2D picture) {
  const CameraView view = view_of(camera, picture.width, picture.height);
  const glm::dquat lattice_from_world = glm::conjugate(island.rotation);
  glm::dvec3 from_origin;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    from_origin[axis] = static_cast<double>(camera.position[i] - island.origin[i]) / 65536.0;
  }
  const auto turned = [&](const glm::vec3& v) {
    return glm::vec3(lattice_from_world * glm::dvec3(v));
  };
  shared::MarkerConstants m{};
  m.eye = glm::vec3(lattice_from_world * from_origin - marker.min);
  m.right = turned(view.right * view.tan_half_x);
  m.up = turned(view.up * view.tan_half_y);
  m.forward = turned(view.forward);
  m.size = glm::vec3(marker.max - marker.min);
  m.half_width = std::max(kThinnest, static_cast<float>(picture.height) * kLineShare);
  m.dug = marker.dug;
  const glm::vec2 size(picture.width, picture.height);
  const PixelBox box = box_in_picture(m, size);
  const float margin = m.half_width + kAround;
  const glm::vec2 low = glm::clamp(glm::floor(box.low - margin), glm::vec2(0.0f), size);
  const glm::vec2 high = glm::clamp(glm::ceil(box.high + margin), glm::vec2(0.0f), size);
  if (low.x >= high.x || low.y >= high.y) return std::nullopt;
  m.first = glm::uvec2(low);
  m.end = glm::uvec2(high);
  return m;
}

Developed MarkerPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                          const Geometry& geometry, Developed developed,
                          const shared::MarkerConstants& marker) {
  gpu::ImageRef out = developed.picture();
  const gpu::ImageRef depth = geometry.depth();
  const auto program = gpu::compute(pipelines, programs::kDrawMarker,
                                    {{shared::kSamplesPerEdgeConstant, scene.samples_per_edge}});
  graph.add_pass(
      "draw_marker",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        out = b.write(out, Use::kComputeWrite);
      },
      [program, scene, depth, out, marker](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
                  gpu::storage<shared::kPictureBinding>(out), gpu::constants(marker));
        c.dispatch(gpu::Commands::groups(marker.end.x - marker.first.x, 8),
                   gpu::Commands::groups(marker.end.y - marker.first.y, 8), 1);
      });
  return Developed(out);
}

}  // namespace skerry::render
