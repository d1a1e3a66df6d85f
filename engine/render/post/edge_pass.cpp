#include "engine/render/post/edge_pass.h"

#include <shader_names.h>

#include <cstddef>
#include <glm/geometric.hpp>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/edges.h"

namespace skerry::render {
namespace {

using gpu::Use;

/// How far reverse depth may bend on a plane, of what it bends where two faces of a block meet that
/// are seen alike. Rounding bends it a hundred times less.
constexpr float kBendOfPlane = 0.05f;

struct EdgeList {
  gpu::BufferRef listed;  ///< shared::TileDispatch in groups of 64
  gpu::BufferRef pixels;  ///< shared::EdgePixel[]
};

EdgeList make_list(gpu::FrameGraph& graph, VkExtent2D size) {
  EdgeList out;
  out.listed = graph.create(
      gpu::BufferDesc{"edge dispatch", sizeof(shared::TileDispatch), 0, gpu::Memory::kDevice});
  out.pixels = graph.create(gpu::BufferDesc{
      "edge pixels", std::uint64_t{size.width} * size.height * sizeof(shared::EdgePixel), 0,
      gpu::Memory::kDevice});
  graph.add_pass(
      "find_edges_clear",
      [&](gpu::PassBuilder& b) { out.listed = b.write(out.listed, Use::kTransferWrite); },
      [listed = out.listed](gpu::Commands& c) {
        c.fill(listed, offsetof(shared::TileDispatch, groups_x), 4, 0);
        c.fill(listed, offsetof(shared::TileDispatch, groups_y), 8, 1);
        c.fill(listed, offsetof(shared::TileDispatch, tiles), 4, 0);
      });
  return out;
}

void find(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
          gpu::ImageRef depth, float bend, EdgeList& list) {
  graph.add_pass(
      "find_edges",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        list.listed = b.write(list.listed, Use::kComputeWrite);
        list.pixels = b.write(list.pixels, Use::kComputeWrite);
      },
      [scene, depth, list, bend,
       program = gpu::compute(pipelines, programs::kFindEdges)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
                  gpu::storage<shared::kListedBinding>(list.listed),
                  gpu::storage<shared::kEdgePixelsBinding>(list.pixels), gpu::constants(bend));
        c.dispatch(gpu::Commands::groups(scene.size.width, 8 * shared::kEdgeColumns),
                   gpu::Commands::groups(scene.size.height, 8 * shared::kEdgeRows), 1);
      });
}

/// @param store the second step, which writes the picture that the first has read.
gpu::ImageRef smooth(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const Geometry& geometry, gpu::ImageRef picture, EdgeList& list, bool store) {
  const gpu::ImageRef words = geometry.surfaces(), depth = geometry.depth();
  graph.add_pass(
      store ? "store_edges" : "smooth_edges",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        b.read(words, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        b.read(scene.block_textures, Use::kComputeSampled);
        b.read(list.listed, Use::kIndirect);
        b.read(list.listed, Use::kComputeRead);
        list.pixels = b.write(list.pixels, Use::kComputeWrite);
        picture = b.write(picture, Use::kComputeWrite);
      },
      [scene, words, depth, list, picture,
       program = gpu::compute(pipelines, programs::kSmoothEdges,
                              {{shared::kStoreConstant, store ? 1u : 0u}})](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::storage<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kSurfacesBinding>(words),
            gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::storage<shared::kPictureBinding>(picture),
            gpu::storage<shared::kListedBinding>(list.listed),
            gpu::storage<shared::kEdgePixelsBinding>(list.pixels));
        c.dispatch_indirect(list.listed, 0);
      });
  return picture;
}

}  // namespace

Developed EdgePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                        const Geometry& geometry, Developed developed,
                        const shared::FrameConstants& frame) {
  const float pixel = frame.pixel_to_ndc.y * glm::length(frame.ray_up);
  EdgeList list = make_list(graph, scene.size);
  find(graph, pipelines, scene, geometry.depth(), kBendOfPlane * pixel, list);
  gpu::ImageRef picture = developed.picture();
  for (const bool store : {false, true})
    picture = smooth(graph, pipelines, scene, geometry, picture, list, store);
  return Developed(picture);
}

}  // namespace skerry::render
