#include "engine/render/scene/geometry_pass.h"

#include <shader_names.h>
#include <array>

#include "engine/render/scene/gbuffer_formats.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {
namespace {

using gpu::Use;

gpu::ImageRef target(gpu::FrameGraph& graph, const char* name, VkFormat format, VkExtent2D size) {
  if (format == VK_FORMAT_UNDEFINED) return {};
  return graph.create(gpu::ImageDesc{.name = name, .format = format, .extent = size});
}

/// Pipeline of opaque quads, and of cut-outs.
std::array<gpu::GraphicsDesc, 2> pipeline_descs(const GBufferStore& store, bool finest_coverage) {
  gpu::GraphicsDesc opaque{.vertex = programs::kDrawQuadsVert,
                           .fragment = programs::kWriteSurfaceFrag,
                           .constants = {},
                           .color_formats = {VK_FORMAT_R32_UINT},
                           .depth_format = depth_format(store.depth)};
  gpu::GraphicsDesc cutout = opaque;
  cutout.fragment = programs::kWriteCutoutFrag;
  cutout.constants = {{shared::kTexturedConstant, 1}};
  if (finest_coverage) cutout.constants.push_back({shared::kFinestCoverageConstant, 1});
  cutout.cull = VK_CULL_MODE_NONE;
  const VkFormat normal = normal_format(store.normal), position = position_format(store.position);
  if (normal == VK_FORMAT_UNDEFINED && position == VK_FORMAT_UNDEFINED) return {opaque, cutout};
  const bool both = normal != VK_FORMAT_UNDEFINED && position != VK_FORMAT_UNDEFINED;
  opaque.fragment = both ? programs::kWriteSurfaceBothFrag : programs::kWriteSurfaceStoredFrag;
  cutout.fragment = both ? programs::kWriteCutoutBothFrag : programs::kWriteCutoutStoredFrag;
  for (gpu::GraphicsDesc* desc : {&opaque, &cutout}) {
    desc->constants.push_back({shared::kNormalCodeConstant, normal_code(store.normal)});
    for (const VkFormat format : {normal, position})
      if (format != VK_FORMAT_UNDEFINED) desc->color_formats.push_back(format);
  }
  return {opaque, cutout};
}

}  // namespace

Geometry GeometryPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, const CulledDraws& draws, bool cutouts,
                           bool finest_coverage, const GBufferStore& store) {
  Geometry out;
  out.store_ = store;
  out.surfaces_ = target(graph, "surfaces", VK_FORMAT_R32_UINT, scene.size);
  out.depth_ = target(graph, "depth", depth_format(store.depth), scene.size);
  out.normals_ = target(graph, "normals", normal_format(store.normal), scene.size);
  out.positions_ = target(graph, "positions", position_format(store.position), scene.size);
  const std::array<gpu::GraphicsDesc, 2> descs = pipeline_descs(store, finest_coverage);
  const gpu::Pipeline& opaque_pipeline = pipelines.get(descs[0]);
  const gpu::Pipeline* cutout_pipeline = cutouts ? &pipelines.get(descs[1]) : nullptr;

  graph.add_pass(
      "draw_geometry",
      [&](gpu::PassBuilder& b) {
        declare_draws(b, scene, draws);
        if (cutouts) {
          b.read(scene.materials, Use::kFragmentRead);
          b.read(scene.block_textures, Use::kFragmentRead);
        }
        if (out.stored())
          for (const gpu::BufferRef ref : {scene.frame, scene.islands})
            b.read(ref, Use::kFragmentRead);
        for (gpu::ImageRef* image : {&out.surfaces_, &out.normals_, &out.positions_})
          if (*image) *image = b.color(*image, gpu::Load::cleared({}));
        out.depth_ = b.depth(out.depth_, gpu::Load::cleared({}));
      },
      [scene, draws, stored = out.stored(), &opaque_pipeline, cutout_pipeline](gpu::Commands& c) {
        const auto bind = [&](const gpu::Pipeline& pipeline) {
          c.bind(pipeline);
          if (!stored) return;
          c.storage(shared::kFrameBinding, scene.frame);
          c.storage(shared::kIslandsBinding, scene.islands);
        };
        bind(opaque_pipeline);
        draw_list(c, scene, draws, 0, DrawList::kOpaque);
        if (cutout_pipeline) {
          bind(*cutout_pipeline);
          c.storage(shared::kMaterialsBinding, scene.materials);
          c.sampled(shared::kBlockTexturesBinding, scene.block_textures, scene.block_sampler);
          draw_list(c, scene, draws, 0, DrawList::kCutout);
        }
      });
  return out;
}

}  // namespace skerry::render
