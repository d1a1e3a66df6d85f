// Planning barriers: what each kept pass has to wait for.
#include <algorithm>

#include "engine/gpu/graph/frame_graph_state.h"

namespace skerry::gpu {
namespace {

// A pass may use a resource in several ways at once. Images then need one layout that allows all of
// them.
void add_use(Access& access, const UseInfo& info) {
  const bool first = access.stages == 0;
  access.stages |= info.stages;
  access.access |= info.access;
  access.write |= info.write;
  if (first) {
    access.layout = info.layout;
  } else if (access.layout != info.layout) {
    access.layout = VK_IMAGE_LAYOUT_GENERAL;
  }
}

// Everything any layer has pending, as one state.
AccessState unite(const AccessState& a, const AccessState& b) {
  AccessState result = a;
  result.stages |= b.stages;
  result.access |= b.access;
  result.written |= b.written;
  return result;
}

}  // namespace

void FrameGraph::State::merge_uses(Pass& pass) {
  pass.merged.clear();
  pass.host_reads.clear();
  for (const Declared& use : pass.declared) {
    const auto layers = static_cast<std::uint32_t>(resources[use.resource].layers.size());
    // What the CPU reads, it reads after the pass.
    auto& list = use.use == Use::kHostRead ? pass.host_reads : pass.merged;
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const Merged& m) { return m.resource == use.resource; });
    if (same == list.end()) {
      Merged merged{use.resource, use.attachment ? use.layer : 0, use.attachment ? 1 : layers, {}};
      add_use(merged.access, use_info(use.use));
      list.push_back(merged);
    } else if (use.attachment ||
               (same->access.access & (VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                       VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT))) {
      fail(pass, use.resource, "is an attachment and used in another way by the same pass");
    } else {
      add_use(same->access, use_info(use.use));
    }
  }
}

void FrameGraph::State::plan() {
  for (Resource& resource : resources) {
    if (resource.last_pass == kNoPass) continue;
    const AccessState& carried = resource.is_image ? resource.image->state : resource.buffer->state;
    std::fill(resource.layers.begin(), resource.layers.end(), Layer{carried, true});
    resource.discard = !resource.imported;
  }
  for (Pass& pass : passes) {
    pass.before.clear();
    pass.behind.clear();
    if (!pass.alive) continue;
    merge_uses(pass);
    for (const Merged& merged : pass.merged) plan_access(merged, pass.before);
    for (const Merged& merged : pass.host_reads) plan_access(merged, pass.behind);
  }
}

void FrameGraph::State::plan_access(const Merged& merged, std::vector<Barrier>& out) {
  Resource& resource = resources[merged.resource];
  if (resource.is_image && resource.layers.front().access.layout != merged.access.layout) {
    plan_transition(resource, merged, out);
  } else {
    Scopes all;
    bool needed = false;
    for (std::uint32_t i = 0; i < merged.layer_count; ++i) {
      const Layer& layer = resource.layers[merged.first_layer + i];
      // The transition has been made visible to these stages, and nobody has come between.
      const bool fresh = !layer.touched && (merged.access.stages & ~layer.access.stages) == 0 &&
                         (merged.access.access & ~layer.access.access) == 0;
      if (fresh) continue;
      if (const std::optional<Scopes> scopes = hazard(layer.access, merged.access)) {
        all.src_stages |= scopes->src_stages;
        all.src_access |= scopes->src_access;
        needed = true;
      }
    }
    if (needed) {
      all.dst_stages = merged.access.stages;
      all.dst_access = merged.access.access;
      out.push_back({merged.resource, merged.first_layer, merged.layer_count, all,
                     merged.access.layout, merged.access.layout});
    }
    for (std::uint32_t i = 0; i < merged.layer_count; ++i) {
      Layer& layer = resource.layers[merged.first_layer + i];
      layer = {after(layer.access, merged.access), true};
    }
  }
  resource.discard = false;
}

// A layout belongs to the whole image: layers that a pass does not touch change along, so that one
// word says it for all.
void FrameGraph::State::plan_transition(Resource& resource, const Merged& merged,
                                        std::vector<Barrier>& out) {
  AccessState before;
  for (const Layer& layer : resource.layers) before = unite(before, layer.access);
  const VkImageLayout old_layout =
      resource.discard ? VK_IMAGE_LAYOUT_UNDEFINED : resource.layers.front().access.layout;
  const Scopes scopes{before.stages, before.written ? before.access & kWriteAccess : 0,
                      merged.access.stages, merged.access.access};
  out.push_back({merged.resource, 0, static_cast<std::uint32_t>(resource.layers.size()), scopes,
                 old_layout, merged.access.layout});
  for (std::uint32_t i = 0; i < resource.layers.size(); ++i) {
    const bool used = i >= merged.first_layer && i - merged.first_layer < merged.layer_count;
    AccessState state;
    state.stages = merged.access.stages;
    state.access = merged.access.access;
    state.layout = merged.access.layout;
    state.written = used && merged.access.write;
    resource.layers[i] = {state, used};
  }
}

void FrameGraph::State::carry_states() {
  for (Resource& resource : resources) {
    if (resource.last_pass == kNoPass) continue;
    AccessState state = resource.layers.front().access;
    for (const Layer& layer : resource.layers) state = unite(state, layer.access);
    if (device) state.last_value = device->next_value();
    (resource.is_image ? resource.image->state : resource.buffer->state) = state;
  }
}

}  // namespace skerry::gpu
