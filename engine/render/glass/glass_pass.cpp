#include "engine/render/glass/glass_pass.h"

#include <shader_names.h>
#include <cmath>
#include <utility>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

namespace {

constexpr VkFormat kListFormat = VK_FORMAT_R32G32_UINT;

struct GlassPush {
  DrawPush draw;
  std::uint32_t cascade;
};

void declare_glass(gpu::PassBuilder& b, const GlassPass::In& in) {
  declare_draws(b, in.scene, in.draws);
  for (const gpu::BufferRef ref : {in.scene.frame, in.scene.materials})
    b.read(ref, Use::kFragmentRead);
  b.read(in.shadows.maps(), Use::kFragmentRead);
}

/// Whole texels of a list about those of a map.
VkRect2D listed_area(const VkRect2D& area) {
  const auto whole = [](std::int32_t offset, std::uint32_t extent) {
    const auto low = static_cast<float>(offset) * shared::kListedTexels;
    const auto high =
        static_cast<float>(offset + static_cast<std::int32_t>(extent)) * shared::kListedTexels;
    return std::pair(static_cast<std::int32_t>(std::floor(low)),
                     static_cast<std::uint32_t>(std::ceil(high) - std::floor(low)));
  };
  const auto [x, width] = whole(area.offset.x, area.extent.width);
  const auto [y, height] = whole(area.offset.y, area.extent.height);
  return {{x, y}, {width, height}};
}

std::uint32_t listed_edge(const GlassPlan& plan) {
  return static_cast<std::uint32_t>(
      std::ceil(static_cast<float>(plan.edge) * shared::kListedTexels));
}

}  // namespace

gpu::ImageRef GlassPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const In& in) {
  if (!in.scene.sums_floats) {
    graph.leave_out("draw_glass", "this device cannot add to images of 32-bit floats");
    return {};
  }
  constexpr VkFormat kSumFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  gpu::ImageRef maps =
      graph.create(gpu::ImageDesc{.name = "glass maps",
                                  .format = kSumFormat,
                                  .extent = {in.plan.edge, in.plan.edge},
                                  .layers = static_cast<std::uint32_t>(in.plan.maps.size()),
                                  .array = true});
  const auto program = gpu::graphics(pipelines, programs::kDrawQuadsVert, programs::kSumGlassFrag,
                                     gpu::GraphicsDesc{.constants = {},
                                                       .color_formats = {kSumFormat},
                                                       .cull = VK_CULL_MODE_NONE,
                                                       .depth_clamp = true,
                                                       .blend = gpu::Blend::kSum});
  for (std::uint32_t layer = 0; layer < in.plan.maps.size(); ++layer) {
    const GlassMap& map = in.plan.maps[layer];
    graph.add_pass(
        "draw_glass",
        [&](gpu::PassBuilder& b) {
          declare_glass(b, in);
          b.area(map.area);
          maps = b.color(maps, gpu::Load::cleared({}), layer);
        },
        [scene = in.scene, draws = in.draws, shadow_maps = in.shadows.maps(),
         view = in.first_view + layer, slot = map.slot, program](gpu::Commands& c) {
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::storage<shared::kMaterialsBinding>(scene.materials),
                    gpu::sampled<shared::kShadowMapsBinding>(shadow_maps, scene.point_sampler),
                    drawn_from(scene, draws),
                    gpu::constants(GlassPush{draw_push(scene, draws, view), slot}));
          draw_list(c, scene, draws, view, DrawList::kTranslucent);
        });
  }
  return maps;
}

gpu::ImageRef GlassPass::list(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const In& in) {
  const std::uint32_t edge = listed_edge(in.plan);
  gpu::ImageRef lists = graph.create(gpu::ImageDesc{
      .name = "glass lists",
      .format = kListFormat,
      .extent = {edge, edge},
      .layers = shared::kListedGlass * static_cast<std::uint32_t>(in.plan.maps.size()),
      .array = true});
  const auto program = [&](bool first) {
    return gpu::graphics(
        pipelines, programs::kDrawQuadsVert, programs::kListGlassFrag,
        gpu::GraphicsDesc{.constants = {{shared::kFirstLayerConstant, first ? 1u : 0u}},
                          .color_formats = {kListFormat},
                          .depth_format = VK_FORMAT_D32_SFLOAT,
                          .cull = VK_CULL_MODE_NONE,
                          .depth_clamp = true});
  };
  const auto nearest = program(true), behind = program(false);
  for (std::uint32_t layer = 0; layer < in.plan.maps.size(); ++layer) {
    const GlassMap& map = in.plan.maps[layer];
    gpu::ImageRef before = in.scene.sky_lut;  // not read
    for (std::uint32_t i = 0; i < shared::kListedGlass; ++i) {
      gpu::ImageRef depth = graph.create(gpu::ImageDesc{
          .name = "listed depth", .format = VK_FORMAT_D32_SFLOAT, .extent = {edge, edge}});
      graph.add_pass(
          "list_glass",
          [&](gpu::PassBuilder& b) {
            declare_glass(b, in);
            b.read(before, Use::kFragmentRead);
            b.area(listed_area(map.area));
            lists = b.color(lists, gpu::Load::cleared({}), layer * shared::kListedGlass + i);
            depth = b.depth(depth, gpu::Load::cleared({}));
          },
          [scene = in.scene, draws = in.draws, shadow_maps = in.shadows.maps(), before,
           view = in.first_view + layer, slot = map.slot,
           program = i == 0 ? nearest : behind](gpu::Commands& c) {
            gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                      gpu::storage<shared::kMaterialsBinding>(scene.materials),
                      gpu::sampled<shared::kShadowMapsBinding>(shadow_maps, scene.point_sampler),
                      gpu::sampled<shared::kPreviousDepthsBinding>(before, scene.point_sampler),
                      drawn_from(scene, draws),
                      gpu::constants(GlassPush{draw_push(scene, draws, view), slot}));
            draw_list(c, scene, draws, view, DrawList::kTranslucent);
          });
      before = depth;
    }
  }
  return lists;
}

}  // namespace skerry::render
