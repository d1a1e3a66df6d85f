#include "engine/render/scene/cull_pass.h"

#include <fmt/format.h>
#include <shader_names.h>

#include <algorithm>

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
  std::uint32_t groups = 0;
  gpu::BufferRef masks, totals;

  CullPush push(const SceneRefs& scene) const {
    return {in.section_slots, groups, scene.islands_per_view, in.most};
  }
};

/// What cull.comp works on; what a step does not use is bound to another of its buffers.
struct StepBuffers {
  gpu::BufferRef sections, islands, views, masks, totals, stats, transforms, commands, counts;

  auto bindings() const {
    return std::tuple{gpu::storage<shared::kSectionsBinding>(sections),
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

auto cull_program(gpu::Pipelines& pipelines, std::uint32_t step) {
  return gpu::compute(pipelines, programs::kCull, {{shared::kCullStepConstant, step}});
}

void add_sections(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                  Culling& culling, CulledDraws& out) {
  graph.add_pass(
      "cull_sections",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.sections, scene.view_islands, scene.views})
          b.read(ref, Use::kComputeRead);
        culling.masks = b.write(culling.masks, Use::kComputeWrite);
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.stats = b.write(out.stats, Use::kComputeWrite);
        out.transforms = b.write(out.transforms, Use::kComputeWrite);
      },
      [buffers =
           StepBuffers{scene.sections, scene.view_islands, scene.views, culling.masks,
                       culling.totals, out.stats, out.transforms, culling.totals, culling.totals},
       push = culling.push(scene), views = culling.in.views,
       program = cull_program(pipelines, shared::kCullSections)](gpu::Commands& c) {
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(push.group_count, views, 1);
      });
}

void add_scan(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
              Culling& culling, CulledDraws& out) {
  graph.add_pass(
      "cull_scan",
      [&](gpu::PassBuilder& b) {
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.counts = b.write(out.counts, Use::kComputeWrite);
      },
      [totals = culling.totals, counts = out.counts, lists = culling.in.views * shared::kListCount,
       push = culling.push(scene),
       program = cull_program(pipelines, shared::kCullScan)](gpu::Commands& c) {
        const StepBuffers buffers{totals, totals, totals, totals, totals,
                                  totals, totals, totals, counts};
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(lists, 1, 1);
      });
}

void add_emit(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
              Culling& culling, CulledDraws& out) {
  graph.add_pass(
      "cull_emit",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.sections, scene.views})
          b.read(ref, Use::kComputeRead);
        // Read alone by this step, but the shader may write them.
        culling.masks = b.write(culling.masks, Use::kComputeWrite);
        culling.totals = b.write(culling.totals, Use::kComputeWrite);
        out.commands = b.write(out.commands, Use::kComputeWrite);
      },
      [buffers =
           StepBuffers{scene.sections, scene.sections, scene.views, culling.masks, culling.totals,
                       out.commands, out.commands, out.commands, out.commands},
       push = culling.push(scene), views = culling.in.views,
       program = cull_program(pipelines, shared::kCullEmit)](gpu::Commands& c) {
        gpu::bind(c, program, buffers.bindings(), gpu::constants(push));
        c.dispatch(push.group_count, views, 1);
      });
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
  const auto words = [&](const char* name, std::uint64_t count) {
    return graph.create(gpu::BufferDesc{name, count * 4, 0, gpu::Memory::kDevice});
  };
  const std::uint64_t lists = std::uint64_t{in.views} * shared::kListCount;
  Culling culling{in, gpu::Commands::groups(in.section_slots, shared::kCullGroup), {}, {}};
  culling.masks = words("cull masks", std::uint64_t{in.views} * in.section_slots);
  culling.totals = words("cull totals", lists * culling.groups);
  CulledDraws out;
  out.section_slots = in.section_slots;
  out.most = in.most;
  out.counts = words("draw counts", lists);
  out.commands = graph.create(gpu::BufferDesc{
      "draw commands", out.first(in.views, DrawList::kOpaque) * sizeof(shared::DrawCommand), 0,
      gpu::Memory::kDevice});
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
  add_emit(graph, pipelines, scene, culling, out);
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
