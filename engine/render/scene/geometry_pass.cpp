#include "engine/render/scene/geometry_pass.h"

#include <shader_names.h>
#include <array>
#include <utility>

#include "engine/gpu/graph/bindings.h"
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

/// Of the programs for opaque quads, and for cut-outs.
std::array<gpu::GraphicsDesc, 2> program_descs(const GeometryPass::In& in) {
  const GBufferStore& store = in.store;
  gpu::GraphicsDesc opaque{.constants = {},
                           .color_formats = {VK_FORMAT_R32_UINT},
                           .depth_format = depth_format(store.depth)};
  gpu::GraphicsDesc cutout = opaque;
  if (in.cutouts) cutout.constants = {{shared::kTexturedConstant, 1}};
  if (in.blended) cutout.constants.push_back({shared::kBlendedConstant, 1});
  if (in.finest_coverage) cutout.constants.push_back({shared::kFinestCoverageConstant, 1});
  if (in.cutouts) cutout.cull = VK_CULL_MODE_NONE;
  for (gpu::GraphicsDesc* desc : {&opaque, &cutout}) {
    if (store.normal != NormalStore::kExact || store.position != PositionStore::kDepth)
      desc->constants.push_back({shared::kNormalCodeConstant, normal_code(store.normal)});
    for (const VkFormat format : {normal_format(store.normal), position_format(store.position)})
      if (format != VK_FORMAT_UNDEFINED) desc->color_formats.push_back(format);
  }
  return {opaque, cutout};
}

/// What the pass draws, whichever outputs its fragment shaders have.
struct Drawing {
  std::array<gpu::GraphicsDesc, 2> descs;
  const SceneRefs& scene;
  const CulledDraws& draws;
  bool cutouts;
};

/// What the pass records. @param stored what its fragment shader declares besides.
template <class Surface, class Stored>
std::function<void(gpu::Commands&)> recording(gpu::Pipelines& pipelines, const Drawing& what,
                                              Surface surface, const Stored& stored) {
  using Program = gpu::Program<programs::DrawQuadsVert, Surface>;
  const Program opaque = gpu::graphics(pipelines, programs::kDrawQuadsVert, surface, what.descs[0]);
  const Program cutout =
      what.cutouts ? gpu::graphics(pipelines, programs::kDrawQuadsVert, surface, what.descs[1])
                   : Program{};
  return [scene = what.scene, draws = what.draws, stored, opaque, cutout](gpu::Commands& c) {
    const std::tuple bindings{draw_bindings(scene, draws, 0), cutout_bindings(scene), stored};
    gpu::bind(c, opaque, bindings);
    draw_list(c, scene, draws, 0, DrawList::kOpaque);
    if (!cutout.pipeline) return;
    gpu::bind(c, cutout, bindings);
    draw_list(c, scene, draws, 0, DrawList::kCutout);
  };
}

}  // namespace

Geometry GeometryPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, const CulledDraws& draws, const In& in) {
  const GBufferStore& store = in.store;
  Geometry out;
  out.store_ = store;
  out.surfaces_ = target(graph, "surfaces", VK_FORMAT_R32_UINT, scene.size);
  out.depth_ = target(graph, "depth", depth_format(store.depth), scene.size);
  out.normals_ = target(graph, "normals", normal_format(store.normal), scene.size);
  out.positions_ = target(graph, "positions", position_format(store.position), scene.size);
  add_pass(graph, pipelines, scene, draws, in, false, out);
  return out;
}

Geometry GeometryPass::add_revealed(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                    const SceneRefs& scene, const CulledDraws& draws, const In& in,
                                    Geometry&& drawn) {
  Geometry out = std::move(drawn);
  add_pass(graph, pipelines, scene, draws, in, true, out);
  return out;
}

void GeometryPass::add_pass(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const CulledDraws& draws, const In& in,
                            bool revealed, Geometry& out) {
  const GBufferStore& store = in.store;
  const Drawing drawing{program_descs(in), scene, draws, in.cutouts || in.blended};
  const auto record = [&](auto surface, const auto& stored) {
    return recording(pipelines, drawing, surface, stored);
  };
  const std::tuple stored{gpu::storage<shared::kFrameBinding>(scene.frame),
                          gpu::texels<shared::kIslandsBinding>(scene.islands)};

  graph.add_pass(
      revealed ? "draw_revealed" : "draw_geometry",
      [&](gpu::PassBuilder& b) {
        declare_draws(b, scene, draws);
        b.read(scene.materials, Use::kFragmentRead);
        b.read(scene.block_coverage, Use::kFragmentRead);
        if (out.stored())
          for (const gpu::BufferRef ref : {scene.frame, scene.islands})
            b.read(ref, Use::kFragmentRead);
        // Depth says where there is a surface, unless 16 bits cannot. A clear costs a GPU with few
        // raster units 0.15 ms at 1920x1080.
        const bool clear = in.clear_words || store.depth == DepthStore::kD16;
        const gpu::Load drawn_over = clear ? gpu::Load::cleared({}) : gpu::Load::discarded();
        out.surfaces_ = b.color(out.surfaces_, revealed ? gpu::Load::keep() : drawn_over);
        for (gpu::ImageRef* image : {&out.normals_, &out.positions_})
          if (*image)
            *image = b.color(*image, revealed ? gpu::Load::keep() : gpu::Load::discarded());
        out.depth_ = b.depth(out.depth_, revealed ? gpu::Load::keep() : gpu::Load::cleared({}));
      },
      out.normals_ && out.positions_ ? record(programs::kWriteSurfaceBothFrag, stored)
      : out.stored()                 ? record(programs::kWriteSurfaceStoredFrag, stored)
                                     : record(programs::kWriteSurfaceFrag, std::tuple<>{}));
}

}  // namespace skerry::render
