// The light that stays on islands: what SceneView has workers find and hands to the renderer.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/log.h"
#include "engine/render/frame/celestial.h"
#include "engine/render/frame/features.h"
#include "game/view/scene_view.h"

namespace skerry::game {
namespace {

/// How far sun or moon may move before their light is followed anew, if they move on.
constexpr float kKeyStepDeg = 3.0f;

}  // namespace

/// All of it, whatever has been found before.
void SceneView::load_light(const Moment& moment) {
  find_light(moment, true);
  if (!island_light_) return;
  for (bool more = true; more;) {
    island_light_->wait();
    more = island_light_->searching();  // and then what has changed meanwhile
    find_light(moment, true);
    more |= island_light_->guesses();
  }
  island_light_->wait();
  while (hand_over_light(moment, UINT64_MAX)) renderer_->reclaim();
  if (!sky_light_.idle()) {
    // Which islands have light must not depend on what was lit before.
    if (indirect_) sky_light_.take_back(*indirect_, renderer_->mesh_uploader());
    renderer_->reclaim();
    while (hand_over_light(moment, UINT64_MAX)) renderer_->reclaim();
  }
  std::set<world::IslandLevel> keyed;
  for (const auto& [row, island] : islands_to_light(moment, true))
    if (key_directions_.contains(row)) keyed.insert(row);
  key_fades_.finish(keyed);
}

/// How near islands are, and from where light of sun and moon is to be followed on the nearest.
/// @param now exactly from there.
IslandLight::NearIslands SceneView::islands_to_light(const Moment& moment, bool now) {
  IslandLight::NearIslands out;
  std::vector<std::pair<double, world::IslandLevel>> nearest;
  for (const auto& [row, island] : near_islands(moment)) {
    out[row].distance = island.distance;
    if (row.level == 0 && island.distance <= kKeyedWithin)
      nearest.emplace_back(island.distance, row);
  }
  if (settings_.render.indirect != render::Indirect::kFull) return out;
  std::ranges::sort(nearest);
  nearest.resize(std::min(nearest.size(), kMostKeyed));
  const render::Celestial sky = render::sky_without(
      render::celestial_at(moment.time_of_day_s, settings_.moon_phase), settings_.render.leave_out);
  const world::IslandPoses poses = world_->poses(moment.world_time_s);
  std::map<world::IslandLevel, glm::vec3> directions;
  for (const auto& [distance, row] : nearest)
    if (const auto to_body =
            key_direction(sky, poses.of(islands_[near_slots_.at(row)].spec).rotation))
      directions[row] = *to_body;
  for (auto& [row, island] : out) island.keyed = directions.contains(row) || key_fades_.shows(row);
  for (const auto& [row, to_body] : directions) {
    const auto before = key_directions_.find(row);
    const bool rests = before != key_directions_.end() && before->second == to_body;
    if ((now || rests) && key_fades_.turn_to(row, to_body)) continue;
    const std::size_t slot = key_fades_.next(row);
    const bool handed_over = !sky_light_.has(row) || sky_light_.shows(row);
    if (!now && (!handed_over || !key_fades_.is_unseen(row, slot))) continue;
    const std::optional<glm::vec3> shown = key_fades_.shown(row);
    const float far = std::sin(glm::radians(kKeyStepDeg));
    if (now || rests || !shown || glm::length(*shown - to_body) > far)
      out.at(row).key = IslandLight::Key{slot, to_body};
  }
  key_directions_ = std::move(directions);
  return out;
}

/// Has workers look for light where something has changed, and takes in what they have found.
/// @param now see IslandLight::start.
void SceneView::find_light(const Moment& moment, bool now) {
  if (!island_light_) return;
  // What waits for memory would let light in.
  if (waiting_.empty())
    island_light_->start(
        *streamer_, [&] { return islands_to_light(moment, now); }, now);
  for (IslandLight::FoundReach& found : island_light_->poll_reach())
    light_field_.set_reach(found.section, std::move(found.reach));
  for (IslandLight::Found& found : island_light_->poll())
    if (island_slots_.contains(found.row)) sky_light_.add(std::move(found));
}

std::map<world::IslandLevel, SkyLightFeed::NearIsland> SceneView::near_islands(
    const Moment& moment) const {
  std::map<world::IslandLevel, SkyLightFeed::NearIsland> islands;
  const world::IslandPoses poses = world_->poses(moment.world_time_s);
  const render::FixedPos& eye = moment.camera.position;
  for (const auto& [row, slot] : near_slots_) {
    const world::IslandSpec& spec = islands_[slot].spec;
    const double centre = glm::length(
        world::difference_blocks(world::WorldPos{eye[0], eye[1], eye[2]}, poses.of(spec).origin));
    islands[row] = {slot, std::max(0.0, centre - spec.bounding_radius)};
  }
  return islands;
}

/// Hands light of the sky to the renderer until `most_bytes` wait to be copied. @return whether
/// there is more to hand over.
bool SceneView::hand_over_light(const Moment& moment, std::uint64_t most_bytes) {
  if (sky_light_.idle()) return false;
  if (!indirect_store()) return false;
  const bool more = sky_light_.hand_over(*indirect_, renderer_->mesh_uploader(),
                                         near_islands(moment), most_bytes);
  for (const auto& [row, keys] : sky_light_.shown()) key_fades_.show(row, keys);
  if (const std::optional<std::string> why = sky_light_.refusal()) refuse_light(*why);
  return more;
}

/// The store of the sky's light, made when it is first needed; null: there is no memory for it.
render::IndirectStore* SceneView::indirect_store() {
  if (indirect_) return indirect_;
  Result<render::IndirectStore*> made = renderer_->indirect();
  if (!made) {
    refuse_light(made.error().message);
    return nullptr;
  }
  return indirect_ = *made;
}

/// A far section hides next to nothing of the sky from itself.
void SceneView::open_to_sky(std::uint32_t slot) {
  // What is kept, not what is drawn at the moment: light that is turned off and on again is there.
  if (!island_light_ || island_light_->finds() == IslandLight::Finds::kReach) return;
  if (render::IndirectStore* store = indirect_store())
    store->open_island(renderer_->mesh_uploader(), slot);
}

void SceneView::refuse_light(const std::string& why) {
  if (std::exchange(light_refused_, true)) return;
  notices_.push_back("some islands have no light of the sky: " + why);
  log_warning(notices_.back());
}

}  // namespace skerry::game
