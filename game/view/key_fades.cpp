#include "game/view/key_fades.h"

#include <algorithm>
#include <utility>

#include "world/light/bounce_light.h"

namespace skerry::game {
namespace {

constexpr float kStep = 1.0f / 32.0f;  // a frame

}  // namespace

std::optional<glm::vec3> key_direction(const render::Celestial& sky, const glm::dquat& rotation) {
  const float sun = world::luminance(sky.sun_irradiance),
              moon = world::luminance(sky.moon_irradiance);
  if (std::max(sun, moon) <= 0.0f) return std::nullopt;
  return glm::vec3(glm::conjugate(rotation) * (sun >= moon ? sky.to_sun : sky.to_moon));
}

void KeyFades::show(const world::IslandLevel& row, const world::KeyDirections& keys) {
  const auto [at, first] = islands_.try_emplace(row);
  Island& island = at->second;
  const world::KeyDirections before = std::exchange(island.keys, keys);
  if (first) {  // with the rest of its light
    island.to = keys[0] ? 0 : 1;
    island.weight[island.to] = keys[island.to] ? 1.0f : 0.0f;
    return;
  }
  for (std::size_t slot = 0; slot < keys.size(); ++slot) {
    if (keys[slot] == before[slot]) continue;
    if (keys[slot])
      island.to = slot;
    else
      island.weight[slot] = 0.0f;
  }
}

void KeyFades::advance(const std::function<bool(const world::IslandLevel&)>& keyed) {
  for (auto& [row, island] : islands_) {
    if (!keyed(row)) {
      for (float& weight : island.weight) weight = std::max(weight - kStep, 0.0f);
      continue;
    }
    float& grows = island.weight[island.to];
    float& shrinks = island.weight[1 - island.to];
    if (island.keys[island.to]) grows = std::min(grows + kStep, 1.0f);
    shrinks = std::min(shrinks, 1.0f - grows);
  }
}

bool KeyFades::turn_to(const world::IslandLevel& row, const glm::vec3& direction) {
  const auto found = islands_.find(row);
  if (found == islands_.end()) return false;
  Island& island = found->second;
  for (std::size_t slot = 0; slot < island.keys.size(); ++slot)
    if (island.keys[slot] == direction) {
      island.to = slot;
      return true;
    }
  return false;
}

void KeyFades::finish(const std::set<world::IslandLevel>& shown) {
  for (auto& [row, island] : islands_) {
    island.weight = {};
    if (island.keys[island.to] && shown.contains(row)) island.weight[island.to] = 1.0f;
  }
}

std::size_t KeyFades::next(const world::IslandLevel& row) const {
  const auto found = islands_.find(row);
  if (found == islands_.end()) return 0;
  const Island& island = found->second;
  return island.keys[island.to] ? 1 - island.to : island.to;
}

bool KeyFades::is_unseen(const world::IslandLevel& row, std::size_t slot) const {
  const auto found = islands_.find(row);
  return found == islands_.end() || found->second.weight[slot] == 0.0f;
}

bool KeyFades::shows(const world::IslandLevel& row) const {
  return !is_unseen(row, 0) || !is_unseen(row, 1);
}

std::optional<glm::vec3> KeyFades::shown(const world::IslandLevel& row) const {
  const auto found = islands_.find(row);
  return found == islands_.end() ? std::nullopt : found->second.keys[found->second.to];
}

std::array<render::KeyedBody, 2> KeyFades::of(const world::IslandLevel& row) const {
  std::array<render::KeyedBody, 2> out{};
  const auto found = islands_.find(row);
  if (found == islands_.end()) return out;
  for (std::size_t slot = 0; slot < out.size(); ++slot)
    if (found->second.keys[slot])
      out[slot] = {*found->second.keys[slot], found->second.weight[slot]};
  return out;
}

}  // namespace skerry::game
