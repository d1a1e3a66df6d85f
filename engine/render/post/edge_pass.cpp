#include "engine/render/post/edge_pass.h"

#include <shader_names.h>

#include <glm/geometric.hpp>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/edges.h"
#include "shaders/shared/frame.h"

namespace skerry::render {
namespace {

using gpu::Use;

EdgeLists make_lists(gpu::FrameGraph& graph, VkExtent2D size) {
  EdgeLists out;
  out.dispatches = graph.create(
      gpu::BufferDesc{"edge dispatches", shared::kEdgeDispatches * sizeof(shared::TileDispatch), 0,
                      gpu::Memory::kDevice});
  out.tiles = graph.create(
      gpu::BufferDesc{"edge tiles", std::uint64_t{tile_count(size)} * 4, 0, gpu::Memory::kDevice});
  out.pixels = graph.create(gpu::BufferDesc{
      "edge pixels", std::uint64_t{size.width} * size.height * sizeof(shared::EdgePixel), 0,
      gpu::Memory::kDevice});
  graph.add_pass(
      "find_edges_clear",
      [&](gpu::PassBuilder& b) { out.dispatches = b.write(out.dispatches, Use::kTransferWrite); },
      [dispatches = out.dispatches](gpu::Commands& c) {
        for (std::uint64_t list = 0; list < shared::kEdgeDispatches; ++list)
          clear_dispatch(c, dispatches, list * sizeof(shared::TileDispatch));
      });
  return out;
}

/// @param every_pixel the second step, of the tiles that the first has listed.
void find(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
          gpu::ImageRef depth, float bend, EdgeLists& lists, bool every_pixel) {
  graph.add_pass(
      every_pixel ? "find_edges" : "find_edge_tiles",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        if (every_pixel) b.read(lists.dispatches, Use::kIndirect);
        lists.dispatches = b.write(lists.dispatches, Use::kComputeWrite);
        lists.tiles = b.write(lists.tiles, Use::kComputeWrite);
        lists.pixels = b.write(lists.pixels, Use::kComputeWrite);
      },
      [scene, depth, lists, bend, every_pixel,
       program =
           gpu::compute(pipelines, programs::kFindEdges,
                        {{shared::kEveryPixelConstant, every_pixel ? 1u : 0u}})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
                  gpu::storage<shared::kTileDispatchesBinding>(lists.dispatches),
                  gpu::storage<shared::kTilesBinding>(lists.tiles),
                  gpu::storage<shared::kEdgePixelsBinding>(lists.pixels), gpu::constants(bend));
        if (every_pixel)
          c.dispatch_indirect(lists.dispatches, 0);
        else
          dispatch_items(c, tile_count(scene.size));
      });
}

/// @param store the second step, which writes the picture that the first has read.
gpu::ImageRef smooth(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const Geometry& geometry, gpu::ImageRef picture, EdgeLists& lists,
                     bool store) {
  const gpu::ImageRef words = geometry.surfaces(), depth = geometry.depth();
  graph.add_pass(
      store ? "store_edges" : "smooth_edges",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        b.read(words, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        b.read(scene.block_coverage, Use::kComputeSampled);
        b.read(lists.dispatches, Use::kIndirect);
        b.read(lists.dispatches, Use::kComputeRead);
        lists.pixels = b.write(lists.pixels, Use::kComputeWrite);
        picture = b.write(picture, Use::kComputeWrite);
      },
      [scene, words, depth, lists, picture,
       program = gpu::compute(pipelines, programs::kSmoothEdges,
                              {{shared::kStoreConstant, store ? 1u : 0u}})](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kSurfacesBinding>(words),
            gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_coverage, scene.block_sampler),
            gpu::storage<shared::kPictureBinding>(picture),
            gpu::storage<shared::kTileDispatchesBinding>(lists.dispatches),
            gpu::storage<shared::kEdgePixelsBinding>(lists.pixels));
        c.dispatch_indirect(lists.dispatches, sizeof(shared::TileDispatch));
      });
  return picture;
}

}  // namespace

SmoothEdges EdgePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                          const Geometry& geometry, Developed developed,
                          const shared::FrameConstants& frame) {
  const float pixel = frame.pixel_to_ndc.y * glm::length(frame.ray_up);
  EdgeLists lists = make_lists(graph, scene.size);
  for (const bool every_pixel : {false, true})
    find(graph, pipelines, scene, geometry.depth(), shared::kBendOfPlane * pixel, lists,
         every_pixel);
  gpu::ImageRef picture = developed.picture();
  for (const bool store : {false, true})
    picture = smooth(graph, pipelines, scene, geometry, picture, lists, store);
  return {Developed(picture), lists};
}

}  // namespace skerry::render
