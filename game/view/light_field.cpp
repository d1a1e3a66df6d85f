#include "game/view/light_field.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/render/light/lights.h"

namespace skerry::game {
namespace {

/// Squared, from a place to a box that may hold it.
float distance2_to(const shared::LightPane& box, const glm::vec3& place) {
  const glm::vec3 away = place - glm::clamp(place, box.low, box.high);
  return glm::dot(away, away);
}

}  // namespace

/// Writes lights together with the lists of islands about them and the panes in their range.
/// Neighbours share a list of islands.
class LightField::Writer {
 public:
  Writer(const LightField& field, std::span<const PlacedIsland> islands, FrameLights& out)
      : field_(field), islands_(islands), out_(out) {}

  /// Of the lights that follow, none reaches beyond this sphere. @param own the level of an island
  /// that they are on: it stands for the island; null: none.
  void within(glm::dvec3 centre, double radius, const PlacedIsland* own = nullptr) {
    out_.near.clear();
    for (const PlacedIsland& island : islands_) {
      const bool stands = own && own->id == island.id ? own == &island : island.main;
      if (stands && touches(island, centre, radius)) out_.near.push_back(&island);
    }
  }

  void write(const shared::Light& light, glm::dvec3 position) {
    list_islands(light, position);
    write_listed(light, position);
  }
  /// @param reach where it can arrive on `own`; counts if it touches no other island.
  void write(const shared::Light& light, glm::dvec3 position, const PlacedIsland& own,
             const shared::LightReach& reach) {
    list_islands(light, position);
    const bool alone = out_.found.size() == 1 && out_.found.front() == own.index;
    if (alone && reach.size == glm::ivec3(0)) return;
    write_listed(light, position);
    if (!alone) return;
    out_.reaches.push_back(reach);
    out_.lights.back().reach = static_cast<std::uint32_t>(out_.reaches.size());
  }

 private:
  void write_listed(const shared::Light& light, glm::dvec3 position) {
    shared::Light& out = out_.lights.emplace_back(light);
    out.position = position;
    out.first_island = static_cast<std::uint32_t>(out_.islands.size()) - count_;
    out.island_count = count_;
    out.first_pane = static_cast<std::uint32_t>(out_.panes.size());
    if (!field_.glass_.empty() && !everywhere(light)) write_panes(position, light.range);
    out.pane_count = static_cast<std::uint32_t>(out_.panes.size()) - out.first_pane;
  }
  void write_panes(glm::dvec3 position, float range) {
    out_.near_panes.clear();
    for (const PlacedIsland* island : out_.near) {
      if (!touches(*island, position, range)) continue;
      const glm::vec3 place(glm::transpose(island->rotation) * (position - island->origin));
      const auto within = [&](const shared::LightPane& box) {
        return distance2_to(box, place) < range * range;
      };
      for (auto glass =
               field_.glass_.lower_bound({island->id, {INT32_MIN, INT32_MIN, INT32_MIN}, 0});
           glass != field_.glass_.end() && glass->first.island == island->id; ++glass) {
        if (!within(glass->second.about) || field_.hidden_.contains(glass->first)) continue;
        for (shared::LightPane pane : glass->second.panes) {
          if (!within(pane)) continue;
          pane.island = island->index;
          out_.near_panes.push_back({distance2_to(pane, place), pane});
        }
      }
    }
    const std::size_t count = std::min(out_.near_panes.size(), kMostPanes);
    if (count < out_.near_panes.size())
      std::ranges::stable_sort(out_.near_panes, {}, &FrameLights::NearPane::distance2);
    for (std::size_t i = 0; i < count; ++i) out_.panes.push_back(out_.near_panes[i].pane);
  }
  void list_islands(const shared::Light& light, glm::dvec3 position) {
    out_.found.clear();
    for (const PlacedIsland* island : out_.near)
      if (everywhere(light) || touches(*island, position, light.range))
        out_.found.push_back(island->index);
    const auto last = out_.islands.end() - count_;
    if (out_.found.size() == count_ && std::equal(out_.found.begin(), out_.found.end(), last))
      return;
    out_.islands.insert(out_.islands.end(), out_.found.begin(), out_.found.end());
    count_ = static_cast<std::uint32_t>(out_.found.size());
  }
  static bool everywhere(const shared::Light& light) {
    return light.kind == shared::kLightDirectional;
  }
  static bool touches(const PlacedIsland& island, glm::dvec3 centre, double radius) {
    const glm::dvec3 away = island.origin - centre;
    const double reach = island.radius + radius;
    return glm::dot(away, away) <= reach * reach;
  }

  const LightField& field_;
  std::span<const PlacedIsland> islands_;
  FrameLights& out_;
  std::uint32_t count_ = 0;  // of the list written last
};

namespace {

bool in_view(const render::CameraView& view, glm::dvec3 centre, double radius) {
  return std::all_of(view.planes.begin(), view.planes.end(), [&](const glm::vec4& plane) {
    return glm::dot(glm::dvec3(plane), centre) + plane.w >= -radius;
  });
}

shared::Light point_light(glm::vec3 intensity, float range) {
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.intensity = intensity;
  light.range = range;
  return light;
}

shared::LightReach reach_of(const world::LampReach::Bricks& bricks, int level,
                            const PlacedIsland& island) {
  shared::LightReach out{};
  out.low = {bricks.low.x, bricks.low.y, bricks.low.z};
  out.size = {bricks.size.x, bricks.size.y, bricks.size.z};
  out.per_block = std::ldexp(1.0f, -level - bricks.edge_log2);
  out.edge_log2 = static_cast<std::uint32_t>(bricks.edge_log2);
  out.island = island.index;
  std::copy(bricks.bits.begin(), bricks.bits.end(), out.bits);
  return out;
}

}  // namespace

LightField::Group LightField::group_of(const world::SectionKey& key,
                                       std::vector<LatticeLight> lights) {
  Group group;
  const double edge = world::kChunkEdge << key.level;
  group.corner = glm::dvec3(key.chunk.x, key.chunk.y, key.chunk.z) * edge;
  glm::vec3 low = lights.front().place, high = low;
  for (const LatticeLight& light : lights) {
    low = glm::min(low, light.place);
    high = glm::max(high, light.place);
  }
  group.centre = 0.5f * (low + high);
  for (const LatticeLight& light : lights)
    group.reach = std::max(group.reach, glm::length(light.place - group.centre) + light.range);
  group.lights = std::move(lights);
  return group;
}

std::vector<LatticeLight> LightField::lights_of(const world::SectionKey& key,
                                                std::span<const world::Emitter> emitters) const {
  const float voxel = static_cast<float>(1 << key.level);  // blocks
  std::vector<LatticeLight> lights;
  for (const world::Emitter& emitter : emitters) {
    const BlockEmission& block = emission_[emitter.block];
    // What is behind faces that all look one way takes half the sphere: the rest gets all of it.
    const float faces = static_cast<float>(emitter.faces) * (emitter.one_way ? 2.0f : 1.0f);
    const glm::vec3 intensity = block.face_intensity * (faces * voxel * voxel);
    lights.push_back({(emitter.place + block.offset) * voxel, intensity, light_range(intensity)});
  }
  return lights;
}

void LightField::add_lights(const world::SectionKey& key, std::vector<LatticeLight> lights) {
  if (!lights.empty()) emitted_.emplace(key, group_of(key, std::move(lights)));
}

void LightField::add_glass(const world::SectionKey& key, std::span<const world::StainedBox> boxes) {
  if (boxes.empty()) return;
  const float voxel = static_cast<float>(1 << key.level);  // blocks
  const glm::ivec3 corner =
      glm::ivec3(key.chunk.x, key.chunk.y, key.chunk.z) * static_cast<int>(world::kChunkEdge);
  Glass glass;
  for (const world::StainedBox& box : boxes) {
    const glm::vec3 low = glm::vec3(corner + box.low) * voxel;
    glass.panes.push_back({low, box.block, low + glm::vec3(box.size) * voxel, 0});
  }
  glass.about = glass.panes.front();
  for (const shared::LightPane& pane : glass.panes) {
    glass.about.low = glm::min(glass.about.low, pane.low);
    glass.about.high = glm::max(glass.about.high, pane.high);
  }
  glass_.emplace(key, std::move(glass));
}

void LightField::set_reach(const world::SectionKey& key,
                           std::vector<world::LampReach::Bricks> reach) {
  // An island that changes its level of detail invalidates once for each of thousands of sections:
  // the bricks go when the first new ones come.
  if (stale_.erase(key.island) != 0) {
    for (auto group = emitted_.lower_bound({key.island, {INT32_MIN, INT32_MIN, INT32_MIN}, 0});
         group != emitted_.end() && group->first.island == key.island; ++group)
      group->second.bricks.clear();
  }
  const auto group = emitted_.find(key);
  if (group != emitted_.end() && reach.size() == group->second.lights.size())
    group->second.bricks = std::move(reach);
}

void LightField::scatter(std::map<world::SectionKey, std::vector<LatticeLight>> lights) {
  scattered_.clear();
  for (auto& [key, group] : lights) scattered_.emplace(key, group_of(key, std::move(group)));
}

void LightField::gather_groups(const Groups& groups, const std::optional<render::CameraView>& view,
                               std::span<const PlacedIsland> islands, bool in_the_open,
                               FrameLights& out) const {
  Writer writer(*this, islands, out);
  auto first = islands.begin();
  for (const auto& [key, group] : groups) {
    // Both are in order of islands' ids.
    first = std::find_if(first, islands.end(),
                         [&key = key](const PlacedIsland& one) { return one.id >= key.island; });
    if (first == islands.end()) return;
    if (first->id != key.island) continue;
    if (&groups == &emitted_ && hidden_.contains(key)) continue;
    auto island = first;  // at the level of the lamp, if it is there
    for (auto one = first; one != islands.end() && one->id == key.island; ++one)
      if (one->level == key.level) island = one;
    const glm::dvec3 corner = island->rotation * group.corner + island->origin;
    const glm::dvec3 centre = corner + island->rotation * glm::dvec3(group.centre);
    if (view && !in_view(*view, centre, group.reach)) continue;
    writer.within(centre, group.reach, &*island);
    const bool known = !group.bricks.empty() && !stale_.contains(key.island);
    // Within a chunk, float is exact to a few millionths of a block.
    const glm::mat3 rotation(island->rotation);
    for (std::size_t i = 0; i < group.lights.size(); ++i) {
      const LatticeLight& light = group.lights[i];
      const glm::dvec3 position = corner + glm::dvec3(rotation * light.place);
      const shared::Light point = point_light(light.intensity, light.range);
      if (in_the_open || !known)
        writer.write(point, position);
      else
        writer.write(point, position, *island, reach_of(group.bricks[i], key.level, *island));
    }
  }
}

void LightField::gather_world(const world::WorldPos& camera, std::span<const PlacedIsland> islands,
                              FrameLights& out) const {
  Writer writer(*this, islands, out);
  for (const WorldLight& one : world_) {
    const bool placed = one.light.kind != shared::kLightDirectional;
    const glm::dvec3 position =
        placed ? world::difference_blocks(one.position, camera) : glm::dvec3(0.0);
    // Nothing that can be drawn is so far away.
    if (glm::length(position) > render::kMaxLightDistance) continue;
    writer.within(position, placed ? one.light.range : std::numeric_limits<double>::infinity());
    writer.write(one.light, position);
  }
}

void LightField::gather(const world::WorldPos& camera,
                        const std::optional<render::CameraView>& view,
                        std::span<const PlacedIsland> islands,
                        const std::optional<shared::Light>& held, bool in_the_open,
                        FrameLights& out) const {
  out.lights.clear();
  out.islands.clear();
  out.reaches.clear();
  out.panes.clear();
  std::size_t most = world_.size() + 1;
  for (const Groups* groups : {&emitted_, &scattered_})
    for (const auto& [key, group] : *groups) most += group.lights.size();
  out.lights.reserve(most);
  gather_groups(emitted_, view, islands, in_the_open, out);
  gather_groups(scattered_, view, islands, in_the_open, out);
  gather_world(camera, islands, out);
  if (!held) return;
  Writer writer(*this, islands, out);
  writer.within(held->position, held->range);
  writer.write(*held, held->position);
}

}  // namespace skerry::game
