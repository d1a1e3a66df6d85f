#include "engine/render/scene/cull_pass.h"

#include <fmt/format.h>
#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {
namespace {

using gpu::Use;

std::uint64_t list_index(std::uint32_t view, DrawList list) {
  return std::uint64_t{view} * shared::kListCount + static_cast<std::uint32_t>(list);
}

}  // namespace

std::uint64_t most_draws(std::uint32_t section_slots, std::uint64_t quads) {
  return 4ull * section_slots + quads / shared::kMaxQuadsPerDraw;
}

Result<void> check_draws(std::uint64_t most, const gpu::DeviceLimits& limits) {
  if (most <= limits.max_draw_count) return {};
  return Error{fmt::format(
      "cannot draw the world at once: it may take {} indirect draws and this device allows {}; "
      "lower view.distance",
      most, limits.max_draw_count)};
}

CulledDraws add_cull_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const CullIn& in) {
  const std::uint32_t groups = gpu::Commands::groups(in.section_slots, shared::kCullGroup);
  const std::uint32_t lists = in.views * shared::kListCount;
  const auto max_draws = static_cast<std::uint32_t>(most_draws(in.section_slots, in.quads));
  const auto words = [&](const char* name, std::uint64_t count) {
    return graph.create(gpu::BufferDesc{name, count * 4, 0, gpu::Memory::kDevice});
  };
  gpu::BufferRef masks = words("cull masks", std::uint64_t{in.views} * in.section_slots);
  gpu::BufferRef totals = words("cull totals", std::uint64_t{lists} * groups);
  CulledDraws out;
  out.max_draws = max_draws;
  out.commands = graph.create(gpu::BufferDesc{
      "draw commands", std::uint64_t{lists} * max_draws * sizeof(shared::DrawCommand), 0,
      gpu::Memory::kDevice});
  out.counts = words("draw counts", lists);
  out.transforms = graph.create(
      gpu::BufferDesc{"section transforms",
                      std::uint64_t{in.views} * in.section_slots * sizeof(shared::SectionTransform),
                      0, gpu::Memory::kDevice});
  out.section_slots = in.section_slots;
  out.stats = graph.create(
      gpu::BufferDesc{"cull stats", in.views * sizeof(shared::CullStats), 0, gpu::Memory::kDevice});

  graph.add_pass(
      "clear_cull_stats",
      [&](gpu::PassBuilder& b) { out.stats = b.write(out.stats, Use::kTransferWrite); },
      [stats = out.stats](gpu::Commands& c) { c.fill(stats, 0, VK_WHOLE_SIZE, 0); });

  graph.add_pass(
      "cull_sections",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.sections, scene.view_islands, scene.views})
          b.read(ref, Use::kComputeRead);
        masks = b.write(masks, Use::kComputeWrite);
        totals = b.write(totals, Use::kComputeWrite);
        out.stats = b.write(out.stats, Use::kComputeWrite);
        out.transforms = b.write(out.transforms, Use::kComputeWrite);
      },
      [scene, masks, totals, stats = out.stats, transforms = out.transforms, in, groups,
       program = gpu::compute(pipelines, programs::kCullSections)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kSectionsBinding>(scene.sections),
                  gpu::storage<shared::kIslandsBinding>(scene.view_islands),
                  gpu::storage<shared::kCullViewsBinding>(scene.views),
                  gpu::storage<shared::kCullMasksBinding>(masks),
                  gpu::storage<shared::kCullTotalsBinding>(totals),
                  gpu::storage<shared::kCullStatsBinding>(stats),
                  gpu::storage<shared::kSectionTransformsBinding>(transforms));
        const struct {
          std::uint32_t section_count, group_count, islands_per_view;
        } push{in.section_slots, groups, scene.islands_per_view};
        c.push(push);
        c.dispatch(groups, in.views, 1);
      });

  graph.add_pass(
      "cull_scan",
      [&](gpu::PassBuilder& b) {
        totals = b.write(totals, Use::kComputeWrite);
        out.counts = b.write(out.counts, Use::kComputeWrite);
      },
      [totals, counts = out.counts, lists, groups, max_draws,
       program = gpu::compute(pipelines, programs::kCullScan)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kCullTotalsBinding>(totals),
                  gpu::storage<shared::kDrawCountsBinding>(counts));
        const struct { std::uint32_t group_count, max_draws; } push{groups, max_draws};
        c.push(push);
        c.dispatch(lists, 1, 1);
      });

  graph.add_pass(
      "cull_emit",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.sections, masks, totals, scene.views})
          b.read(ref, Use::kComputeRead);
        out.commands = b.write(out.commands, Use::kComputeWrite);
      },
      [scene, masks, totals, commands = out.commands, in, groups, max_draws,
       program = gpu::compute(pipelines, programs::kCullEmit)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kSectionsBinding>(scene.sections),
                  gpu::storage<shared::kCullMasksBinding>(masks),
                  gpu::storage<shared::kCullTotalsBinding>(totals),
                  gpu::storage<shared::kCullViewsBinding>(scene.views),
                  gpu::storage<shared::kDrawCommandsBinding>(commands));
        const struct {
          std::uint32_t section_count, group_count, max_draws;
        } push{in.section_slots, groups, max_draws};
        c.push(push);
        c.dispatch(groups, in.views, 1);
      });
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
  const struct {
    glm::mat4 clip_from_source;
    std::uint32_t first_transform;
    float edge_growth;
  } push{scene.clip_from_source[view], view * draws.section_slots, scene.edge_growth[view]};
  commands.push(push);
  commands.index_buffer(scene.indices, VK_INDEX_TYPE_UINT16);
  const std::uint64_t index = list_index(view, list);
  commands.draw_indirect_count(draws.commands,
                               index * draws.max_draws * sizeof(shared::DrawCommand), draws.counts,
                               index * 4, draws.max_draws);
}

}  // namespace skerry::render
