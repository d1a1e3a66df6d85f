#include "engine/render/scene/cull_pass.h"

#include <fmt/format.h>
#include <shader_names.h>

#include <algorithm>
#include <array>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {
namespace {

using gpu::Use;

std::uint32_t list_index(std::uint32_t view, DrawList list) {
  return view * shared::kListCount + static_cast<std::uint32_t>(list);
}

/// Push constants of cull.comp.
struct CullPush {
  std::uint32_t section_count, group_count, islands_per_view;
  DrawLimits most;
};

/// What passes on the way from sections to draws.
struct Culling {
  const CullIn& in;
  std::uint32_t views = 0;
  std::array<const char*, 3> names{};  // of the passes
  gpu::BufferRef totals{};

  std::uint32_t groups() const {
    return gpu::Commands::groups(in.section_slots, shared::kCullGroup);
  }
  CullPush push(const SceneRefs& scene) const {
    return {in.section_slots, groups(), scene.islands_per_view, in.most};
  }
};

/// What cull.comp works on; what a step does not use is bound to another of its buffers.
struct StepBuffers {
  gpu::BufferRef frame, sections, islands, views, masks, totals, stats, transforms, commands,
      counts, seen, far_depths;

  auto bindings() const {
    return std::tuple{gpu::storage<shared::kFrameBinding>(frame),
                      gpu::storage<shared::kSeenSectionsBinding>(seen),
                      gpu::storage<shared::kFarDepthsBinding>(far_depths),
                      gpu::storage<shared::kSectionsBinding>(sections),
                      gpu::storage<shared::kIslandsBinding>(islands),
                      gpu::storage<shared::kCullViewsBinding>(views),
                      gpu::storage<shared::kCullMasksBinding>(masks),
                      gpu::storage<shared::kCullTotalsBinding>(totals),
                      gpu::storage<shared::kCullStatsBinding>(stats),
                      gpu::storage<shared::kSectionTransformsBinding>(transforms),
                      gpu::storage<shared::kDrawCommandsBinding>(commands),
                      gpu::storage<shared::kDrawCountsBinding>(counts)};
  }
};

auto cull_program(gpu::Pipelines& pipelines, std::uint32_t step, bool two_phases = false) {
  if (two_phases)
    return gpu::compute(pipelines, programs::kCull,
                        {{shared::kCullStepConstant, step}, {shared::kTwoPhasesConstant, 1}});
  return gpu::compute(pipelines, programs::kCull, {{shared::kCullStepConstant, step}});
}

void add_sections(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                  Culling& culling, CulledDraws& out) {
  const gpu::BufferRef seen = culling.in.seen;
  graph.add_pass(
      culling.names[0],
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sections, scene.islands, scene.views})
          b.read(ref, Use::kComputeRead);
        if (seen) b.read(seen, Use::kComputeRead);
        out.masks = b.write(out.masks, Use::kComputeWrite);
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.stats = b.write(out.stats, Use::kComputeWrite);
        out.transforms = b.write(out.transforms, Use::kComputeWrite);
      },
      [buffers = StepBuffers{scene.frame, scene.sections, scene.islands, scene.views, out.masks,
                             culling.totals, out.stats, out.transforms, culling.totals,
                             culling.totals, seen ? seen : culling.totals, culling.totals},
       push = culling.push(scene), views = culling.views,
       program = cull_program(pipelines, shared::kCullSections, static_cast<bool>(seen))](
          gpu::Commands& c) {
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(push.group_count, views, 1);
      });
}

/// Of the sections that the camera's view has: what the depths hide, and what is still to be drawn.
void add_hidden(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                Culling& culling, gpu::BufferRef far_depths, CulledDraws& out) {
  gpu::BufferRef seen = culling.in.seen;
  graph.add_pass(
      culling.names[0],
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sections, scene.islands, far_depths})
          b.read(ref, Use::kComputeRead);
        seen = b.write(seen, Use::kComputeWrite);
        out.masks = b.write(out.masks, Use::kComputeWrite);
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.stats = b.write(out.stats, Use::kComputeWrite);
      },
      [buffers = StepBuffers{scene.frame, scene.sections, scene.islands, scene.sections, out.masks,
                             culling.totals, out.stats, culling.totals, culling.totals,
                             culling.totals, seen, far_depths},
       push = culling.push(scene),
       program = cull_program(pipelines, shared::kCullHidden)](gpu::Commands& c) {
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(push.group_count, 1, 1);
      });
}

void add_scan(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
              Culling& culling, CulledDraws& out) {
  graph.add_pass(
      culling.names[1],
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.counts = b.write(out.counts, Use::kComputeWrite);
      },
      [frame = scene.frame, totals = culling.totals, counts = out.counts,
       lists = culling.views * shared::kListCount, push = culling.push(scene),
       program = cull_program(pipelines, shared::kCullScan)](gpu::Commands& c) {
        const StepBuffers buffers{frame,  totals, totals, totals, totals, totals,
                                  totals, totals, totals, counts, totals, totals};
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(lists, 1, 1);
      });
}

void add_emit(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
              Culling& culling, bool first_of_two, CulledDraws& out) {
  graph.add_pass(
      culling.names[2],
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.sections, scene.views})
          b.read(ref, Use::kComputeRead);
        // Read alone by this step, but the shader may write them.
        out.masks = b.write(out.masks, Use::kComputeWrite);
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.commands = b.write(out.commands, Use::kComputeWrite);
      },
      [buffers = StepBuffers{scene.frame, scene.sections, scene.sections, scene.views, out.masks,
                             culling.totals, out.commands, out.commands, out.commands, out.commands,
                             out.commands, out.commands},
       push = culling.push(scene), views = culling.views,
       program = cull_program(pipelines, shared::kCullEmit, first_of_two)](gpu::Commands& c) {
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(push.group_count, views, 1);
      });
}

gpu::BufferRef words(gpu::FrameGraph& graph, const char* name, std::uint64_t count) {
  return graph.create(gpu::BufferDesc{name, count * 4, 0, gpu::Memory::kDevice});
}

/// See kFineDepthEdge.
gpu::BufferRef add_far_depths(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              const SceneRefs& scene, gpu::ImageRef depth) {
  const std::uint32_t coarse_x = gpu::Commands::groups(scene.size.width, shared::kCoarseDepthEdge),
                      coarse_y = gpu::Commands::groups(scene.size.height, shared::kCoarseDepthEdge);
  const std::uint64_t fine =
      std::uint64_t{gpu::Commands::groups(scene.size.width, shared::kFineDepthEdge)} *
      gpu::Commands::groups(scene.size.height, shared::kFineDepthEdge);
  gpu::BufferRef far_depths = words(graph, "far depths", fine + coarse_x * coarse_y);
  const auto find = gpu::compute(pipelines, programs::kFindFarDepths);
  graph.add_pass(
      "find_far_depths",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        far_depths = b.write(far_depths, Use::kComputeWrite);
      },
      [frame = scene.frame, depth, far_depths, sampler = scene.point_sampler, find, coarse_x,
       coarse_y](gpu::Commands& c) {
        gpu::bind(c, find,
                  std::tuple{gpu::storage<shared::kFrameBinding>(frame),
                             gpu::sampled<shared::kDepthsBinding>(depth, sampler),
                             gpu::storage<shared::kFarDepthsBinding>(far_depths)});
        c.dispatch(coarse_x, coarse_y, 1);
      });
  return far_depths;
}

/// Makes what the passes write: lists of draws, and how many draws each group of sections has.
void create_lists(gpu::FrameGraph& graph, Culling& culling, CulledDraws& out) {
  const std::uint64_t lists = std::uint64_t{culling.views} * shared::kListCount;
  culling.totals = words(graph, "cull totals", lists * culling.groups());
  out.section_slots = culling.in.section_slots;
  out.most = culling.in.most;
  out.counts = words(graph, "draw counts", lists);
  out.commands = graph.create(gpu::BufferDesc{
      "draw commands", out.first(culling.views, DrawList::kOpaque) * sizeof(shared::DrawCommand), 0,
      gpu::Memory::kDevice});
}

}  // namespace

std::uint64_t CulledDraws::first(std::uint32_t view, DrawList list) const {
  std::uint64_t before = 0, of_view = 0;
  for (std::uint32_t i = 0; i < shared::kListCount; ++i) {
    of_view += most[i];
    if (i < static_cast<std::uint32_t>(list)) before += most[i];
  }
  return view * of_view + before;
}

Result<void> check_draws(const DrawLimits& most, const gpu::DeviceLimits& limits) {
  const std::uint32_t largest = *std::ranges::max_element(most);
  if (largest <= limits.max_draw_count) return {};
  return Error{fmt::format(
      "cannot draw the world at once: it may take {} indirect draws and this device allows {}; "
      "lower view.distance",
      largest, limits.max_draw_count)};
}

CulledDraws add_cull_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const CullIn& in) {
  Culling culling{in, in.views, {"cull_sections", "cull_scan", "cull_emit"}};
  CulledDraws out;
  create_lists(graph, culling, out);
  out.masks = words(graph, "cull masks", std::uint64_t{in.views} * in.section_slots);
  out.transforms = graph.create(
      gpu::BufferDesc{"section transforms",
                      std::uint64_t{in.views} * in.section_slots * sizeof(shared::SectionTransform),
                      0, gpu::Memory::kDevice});
  out.stats = graph.create(
      gpu::BufferDesc{"cull stats", in.views * sizeof(shared::CullStats), 0, gpu::Memory::kDevice});
  graph.add_pass(
      "clear_cull_stats",
      [&](gpu::PassBuilder& b) { out.stats = b.write(out.stats, Use::kTransferWrite); },
      [stats = out.stats](gpu::Commands& c) { c.fill(stats, 0, VK_WHOLE_SIZE, 0); });
  add_sections(graph, pipelines, scene, culling, out);
  add_scan(graph, pipelines, scene, culling, out);
  add_emit(graph, pipelines, scene, culling, static_cast<bool>(in.seen), out);
  return out;
}

CulledDraws add_hidden_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              const SceneRefs& scene, const CullIn& in, gpu::ImageRef depth,
                              const CulledDraws& first) {
  const gpu::BufferRef far_depths = add_far_depths(graph, pipelines, scene, depth);
  Culling culling{in, 1, {"cull_hidden", "scan_revealed", "emit_revealed"}};
  CulledDraws out = first;
  create_lists(graph, culling, out);
  add_hidden(graph, pipelines, scene, culling, far_depths, out);
  add_scan(graph, pipelines, scene, culling, out);
  add_emit(graph, pipelines, scene, culling, false, out);
  return out;
}

void declare_draws(gpu::PassBuilder& builder, const SceneRefs& scene, const CulledDraws& draws) {
  builder.read(draws.commands, Use::kIndirect);
  builder.read(draws.counts, Use::kIndirect);
  builder.read(scene.indices, Use::kIndex);
  builder.read(scene.quads, Use::kVertexRead);
  builder.read(draws.transforms, Use::kVertexRead);
}

void draw_list(gpu::Commands& commands, const SceneRefs& scene, const CulledDraws& draws,
               std::uint32_t view, DrawList list) {
  commands.index_buffer(scene.indices, VK_INDEX_TYPE_UINT16);
  commands.draw_indirect_count(
      draws.commands, draws.first(view, list) * sizeof(shared::DrawCommand), draws.counts,
      std::uint64_t{list_index(view, list)} * 4, draws.most[static_cast<std::size_t>(list)]);
}

}  // namespace skerry::render
