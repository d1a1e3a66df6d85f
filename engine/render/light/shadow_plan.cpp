#include "engine/render/light/shadow_plan.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <iterator>
#include <optional>
#include <utility>

#include "engine/core/shared_work.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/light/shadow_changes.h"

namespace skerry::render {
namespace {

constexpr double kMovedTexels = 0.25;  // of what a kept map shows, at most

// Of maps that may lag. Receivers are looked up half a texel off their faces: an island that sinks
// by more would shade itself.
constexpr double kSoonTexels = 0.125, kLateTexels = 0.45;
constexpr double kOtherIsland = 16.0;  // texels, see MovedBy::at_most
constexpr double kLateTurn = 2.0;      // times what the light may have turned
constexpr double kTurnAbout = 4.0;     // likewise, for texels to turn about the map's middle
constexpr float kLeastCovered = 0.8f;  // of the radius
constexpr float kCoarser = 1.2f;       // texels, than need be
constexpr double kQuadsAtOnce = 8192.0;
constexpr double kMostFrames = 16.0, kLeastFrames = 3.0;  // that a map takes
constexpr int kFineMaps = 2;  // a body's first: few quads are in them, and close to the eye
constexpr std::size_t kToShare = 512;  // islands, from which on several threads plan the maps
constexpr int kMostEdge = 2048;        // of maps that have a spare layer: 16 MiB

bool may_lag(const FrameInput& input, const RenderSettings& settings, int index) {
  return input.may_lag && input.parts == 1 && index >= kFineMaps &&
         settings.shadow_size <= kMostEdge;
}

/// Casters further than this above a cascade are flattened onto the map's near side by depth
/// clamping, so nothing is lost.
double caster_reach(const FrameInput& input) {
  return 2.0 * input.reach_blocks + 512.0;
}

/// The texels in which a kept map does not show what `cascade` asks for; none if it is of no use.
/// Notes in the map what it shows once these have been drawn.
std::optional<TexelBox> outdated(std::optional<DrawnMap>& map, const Cascade& cascade,
                                 const FrameInput& input, const ShadowHistory& last,
                                 const GeometryChanges& geometry) {
  if (!map || map->key != cascade.key || map->island_count > input.islands.size())
    return std::nullopt;
  TexelBox box = moved_islands(*map, cascade, input, last, {.more_than = kMovedTexels});
  const std::optional<TexelBox> changed = changed_sections(*map, cascade, input, geometry);
  if (!changed) return std::nullopt;
  box.add(*changed);
  return box;
}

/// Whether a map drawn by another light's direction shows shadows where they belong, or as good as.
/// @param times what they may be off by.
bool good_enough(const glm::dvec3& drawn_by, const glm::dvec3& to_light, const Cascade& cascade,
                 double times = 1.0) {
  const double moved = kShadowBlocks * glm::length(glm::cross(drawn_by, to_light));
  const double most = kMovedTexels * static_cast<double>(cascade.texel_blocks);
  return glm::dot(drawn_by, to_light) > 0.0 && moved <= times * std::max(most, kShadowStepBlocks);
}

CascadeInput cascade_input(const FrameInput& input, const RenderSettings& settings, int body) {
  CascadeInput in;
  in.to_light = body == 0 ? input.sky.to_sun : input.sky.to_moon;
  in.camera = input.camera.position;
  in.anchor = input.anchor;
  in.near_blocks = 1.0;
  in.far_blocks = input.reach_blocks;
  in.caster_reach_blocks = caster_reach(input);
  in.filter_blocks = 2.0 * static_cast<double>(shadow_blur(input, settings));
  in.map_size = settings.shadow_size;
  in.count = settings.shadow_cascades;
  in.split = settings.shadow_split;
  return in;
}

ShadowLayout layout_of(const FrameInput& input, const RenderSettings& settings) {
  ShadowLayout out;
  out.casting = {settings.shadow_enabled && input.sky.sun_casts,
                 settings.shadow_enabled && input.sky.moon_casts};
  const auto bodies = static_cast<std::uint32_t>(out.casting[0]) + (out.casting[1] ? 1u : 0u);
  out.layers = bodies * static_cast<std::uint32_t>(settings.shadow_cascades);
  if (out.layers != 0) out.edge = static_cast<std::uint32_t>(settings.shadow_size);
  if (may_lag(input, settings, settings.shadow_cascades - 1))
    out.spares = bodies * static_cast<std::uint32_t>(settings.shadow_cascades - kFineMaps);
  return out;
}

/// What the maps show that an array of this layout has kept; nothing if that is another array.
/// @param cascades of a body.
ShadowHistory kept_for(const ShadowLayout& layout, std::uint32_t cascades,
                       const ShadowHistory& history, std::uint64_t generation) {
  ShadowLayout with_spares = layout;
  with_spares.spares = std::max(layout.spares, history.layout.spares);
  if (history.layout == with_spares && history.generation == generation) return history;
  ShadowHistory next;
  next.layout = layout;
  std::uint32_t spare = layout.layers;
  for (std::uint32_t i = 0; i < layout.layers; ++i) {
    next.kept[i].layer = i;
    if (static_cast<int>(i % cascades) >= kFineMaps) next.kept[i].spare = spare++;
  }
  return next;
}

/// A map, and what is drawn of it for later frames.
struct PlannedMap {
  ActiveCascade active;
  std::vector<PartAhead> ahead;
};

/// Plans maps. What it writes to of one is no concern of another.
class Planner {
 public:
  Planner(const FrameInput& input, const RenderSettings& settings,
          std::span<const shared::Section> sections, const GeometryChanges& geometry,
          const ShadowHistory& before, const ShadowLayout& layout)
      : input_(input),
        settings_(settings),
        sections_(sections),
        geometry_(geometry),
        before_(before),
        layout_(layout) {}

  /// @param kept in: by earlier frames; out: what this one leaves behind.
  void plan(PlannedMap& map, ShadowHistory::Kept& kept) const {
    ActiveCascade& active = map.active;
    CascadeInput in = cascade_input(input_, settings_, active.body);
    in.pivot = pivot_of(kept.map, in);
    const Cascade cascade = make_cascade(in, active.index);
    if (!may_lag(input_, settings_, active.index) || !follow(kept, in, cascade, map)) {
      kept.job.reset();
      bring_up_to_date(kept, in, cascade, active);
    }
    active.layer = kept.layer;
    active.to_light = kept.map->to_light;
  }

 private:
  /// About which a map's texels turn with the light: the middle of the map before, so that they
  /// move across what is near by no more than the turn makes them. Where the light has jumped, and
  /// for stills, the map is as without a history.
  FixedPos pivot_of(const std::optional<DrawnMap>& before, CascadeInput in) const {
    if (!before || input_.parts != 1) return {};
    const glm::dvec3 to_light = in.to_light;
    if (before->to_light == to_light) return before->key.pivot;
    in.to_light = before->to_light;
    const Cascade shown = cascade_of(before->key, in);
    if (!good_enough(in.to_light, to_light, shown, kTurnAbout)) return {};
    FixedPos middle = shown.centre;
    for (std::size_t i = 0; i < 3; ++i) middle[i] -= in.anchor[i];
    return middle;
  }
  VkRect2D whole() const { return {{0, 0}, {layout_.edge, layout_.edge}}; }
  DrawnMap drawn_now(const Cascade& cascade, const glm::dvec3& to_light) const {
    return {cascade.key,
            to_light,
            geometry_.version(),
            static_cast<std::uint32_t>(input_.islands.size()),
            islands_in(cascade, input_),
            input_.anchor};
  }

  /// The map shows in this frame all that it should.
  void bring_up_to_date(ShadowHistory::Kept& kept, CascadeInput in, const Cascade& cascade,
                        ActiveCascade& active) const {
    const glm::dvec3 to_light = in.to_light;
    active.cascade = cascade;
    std::optional<TexelBox> box = outdated(kept.map, cascade, input_, before_, geometry_);
    if (!box && kept.map && input_.parts == 1 &&
        good_enough(kept.map->to_light, to_light, cascade)) {
      in.to_light = kept.map->to_light;
      in.pivot = kept.map->key.pivot;
      const Cascade before = make_cascade(in, active.index);
      box = outdated(kept.map, before, input_, before_, geometry_);
      if (box) active.cascade = before;
    }
    if (!box) kept.map = drawn_now(cascade, to_light);
    set_area(active, box ? box->rect() : whole());
  }

  /// The map may show what was a few frames ago. @return false: it is too far from what it should
  /// show.
  bool follow(ShadowHistory::Kept& kept, CascadeInput in, const Cascade& wanted,
              PlannedMap& planned) const {
    ActiveCascade& active = planned.active;
    const glm::dvec3 to_light = in.to_light;
    if (!kept.map || kept.map->island_count > input_.islands.size()) return false;
    if (kept.job) planned.ahead.push_back(draw_ahead(kept, in));
    in.to_light = kept.map->to_light;
    active.cascade = cascade_of(kept.map->key, in);
    if (active.cascade.radius < kLeastCovered * wanted.radius ||
        !good_enough(in.to_light, to_light, wanted, kLateTurn))
      return false;
    TexelBox box = moved_islands(*kept.map, active.cascade, input_, before_,
                                 {.more_than = kLateTexels, .at_most = kOtherIsland});
    if (!kept.job) {
      const std::optional<TexelBox> more = begin(kept, in, wanted, planned, to_light);
      if (!more) return false;
      box.add(*more);
    }
    active.cascade.radius = std::min(active.cascade.radius, wanted.radius);
    set_area(active, box.rect());
    return true;
  }

  /// Begins to draw what the map lacks, if that is much. @return what is drawn at once; none: what
  /// it lacks is not known.
  std::optional<TexelBox> begin(ShadowHistory::Kept& kept, const CascadeInput& in,
                                const Cascade& wanted, PlannedMap& planned,
                                const glm::dvec3& to_light) const {
    const Cascade& shown = planned.active.cascade;
    DrawnMap after = *kept.map;
    TexelBox box = moved_islands(after, shown, input_, before_, {.more_than = kSoonTexels});
    const std::optional<TexelBox> changed = changed_sections(after, shown, input_, geometry_);
    if (!changed) return std::nullopt;
    box.add(*changed);
    const bool serves = good_enough(in.to_light, to_light, wanted) &&
                        shown.radius >= wanted.radius &&
                        shown.texel_blocks <= kCoarser * wanted.texel_blocks;
    if (serves && (box.empty() || quads_in(box, shown, input_, sections_) <= kQuadsAtOnce)) {
      kept.map = std::move(after);
      return box;
    }
    const double quads = quads_in(whole_map(wanted), wanted, input_, sections_);
    kept.job = ShadowJob{.after = drawn_now(wanted, to_light),
                         .quads_a_frame = std::max(kQuadsAtOnce, quads / frames_for(wanted))};
    planned.ahead.push_back(draw_ahead(kept, in));
    return TexelBox{};
  }

  /// In how many frames a map must be drawn so that nothing in it is late when it is drawn again.
  double frames_for(const Cascade& cascade) const {
    double frames = kMostFrames;
    if (!before_.islands) return frames;
    for (std::size_t i = 0; i < std::min(before_.islands->size(), input_.islands.size()); ++i) {
      const IslandPlacement& now = input_.islands[i];
      IslandPlacement before = (*before_.islands)[i];
      before.origin = rebased(before.origin, before_.anchor, input_.anchor);
      const double moved =  // texels a frame
          movement(before, now) / static_cast<double>(cascade.texel_blocks);
      const double enough = 0.5 * kLateTexels / std::max(moved, 1e-9);
      // What is faster will be late in any case.
      if (enough < frames && enough >= kLeastFrames &&
          may_touch(now, input_.camera.position, cascade))
        frames = enough;
    }
    return frames;
  }

  /// Draws the next part of a map. The last one makes it the map that is shown.
  PartAhead draw_ahead(ShadowHistory::Kept& kept, CascadeInput in) const {
    ShadowJob& job = *kept.job;
    in.to_light = job.after.to_light;
    PartAhead part{.layer = kept.spare,
                   .clear = job.next_section == 0,
                   .sections = {},
                   .to_light = in.to_light,
                   .cascade = cascade_of(job.after.key, in),
                   .islands = {input_.islands.begin(), input_.islands.end()}};
    part.sections = next_part(job, part.cascade, input_, sections_);
    for (const DrawnIsland& then : *job.after.islands) {
      if (then.index >= part.islands.size()) break;
      part.islands[then.index].origin = rebased(then.origin, job.after.anchor, input_.anchor);
      part.islands[then.index].rotation = then.rotation;
    }
    if (job.next_section < sections_.size()) return part;
    std::swap(kept.layer, kept.spare);
    kept.map = std::move(job.after);
    kept.job.reset();
    return part;
  }

  static void set_area(ActiveCascade& active, const VkRect2D& area) {
    active.area = area;
    active.redraw = area.extent.width != 0;
  }

  const FrameInput& input_;
  const RenderSettings& settings_;
  std::span<const shared::Section> sections_;
  const GeometryChanges& geometry_;
  const ShadowHistory& before_;
  const ShadowLayout& layout_;
};

}  // namespace

SharedIslands shared_islands(const FrameInput& input) {
  return std::make_shared<const std::vector<IslandPlacement>>(input.islands.begin(),
                                                              input.islands.end());
}

void ShadowHistory::only_shows(std::uint64_t geometry_version) {
  const auto no_newer = [&](DrawnMap& map) {
    map.geometry_version = std::min(map.geometry_version, geometry_version);
  };
  for (Kept& k : kept) {
    if (k.map) no_newer(*k.map);
    if (k.job) no_newer(k.job->after);
  }
}

std::uint32_t layers_used(const ShadowPlan& plan) {
  std::uint32_t count = 0;
  for (const ActiveCascade& c : plan.cascades) count = std::max(count, c.layer + 1);
  for (const PartAhead& part : plan.ahead) count = std::max(count, part.layer + 1);
  return count;
}

ShadowPlan plan_shadows(const FrameInput& input, const RenderSettings& settings,
                        std::span<const shared::Section> sections, const GeometryChanges& geometry,
                        const ShadowHistory& history, std::uint64_t generation) {
  ShadowPlan plan;
  plan.layout = layout_of(input, settings);
  plan.next = kept_for(plan.layout, static_cast<std::uint32_t>(settings.shadow_cascades), history,
                       generation);
  std::vector<PlannedMap> maps;
  for (int body = 0; body < 2; ++body)
    for (int index = 0; index < settings.shadow_cascades; ++index) {
      if (!plan.layout.casting[static_cast<std::size_t>(body)]) continue;
      ActiveCascade& active = maps.emplace_back().active;
      active.body = body, active.index = index;
      active.slot = static_cast<std::uint32_t>(maps.size() - 1);
    }
  const Planner planner(input, settings, sections, geometry, history, plan.layout);
  Helpers* const helpers = input.islands.size() < kToShare ? nullptr : Helpers::of_frames();
  SharedWork(helpers, static_cast<int>(maps.size()), [&](int piece) {
    const auto slot = static_cast<std::size_t>(piece);
    planner.plan(maps[slot], plan.next.kept[slot]);
  }).join();
  for (PlannedMap& map : maps) {
    plan.cascades.push_back(std::move(map.active));
    std::ranges::move(map.ahead, std::back_inserter(plan.ahead));
  }
  plan.next.islands = shared_islands(input);
  plan.next.anchor = input.anchor;
  return plan;
}

}  // namespace skerry::render
