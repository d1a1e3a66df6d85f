#include "game/sections/level_blends.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "world/voxel/hash.h"

namespace skerry::game {
namespace {

using world::SectionKey;

/// The place that holds a section's; none for the coarsest.
std::optional<SectionKey> parent_of(const SectionKey& key) {
  const std::int32_t level = key.level + 1;
  if (level < world::kLevelCount)
    return SectionKey{key.island, {key.chunk.x >> 1, key.chunk.y >> 1, key.chunk.z >> 1}, level};
  if (level < world::kLevelCount + world::kFarLevelCount)
    return SectionKey{key.island, {0, 0, 0}, level, true};
  return std::nullopt;
}

template <class Visit>
void each_above(const SectionKey& key, const Visit& visit) {
  for (std::optional<SectionKey> place = parent_of(key); place; place = parent_of(*place))
    visit(*place);
}

bool any_above(const SectionKey& key, const std::set<SectionKey>& of) {
  bool any = false;
  each_above(key, [&](const SectionKey& place) { any = any || of.contains(place); });
  return any;
}

/// Of a step: by how much a place is late.
double phase_of(const SectionKey& place) {
  const std::uint32_t hash = world::hash3(static_cast<std::uint32_t>(place.level), place.chunk.x,
                                          place.chunk.y, place.chunk.z);
  return static_cast<double>(hash & 0xffffu) / 65536.0;
}

/// None for a share of 0, all for one of 1.
std::uint32_t step_of(const SectionKey& place, double share) {
  constexpr double kSteps = shared::kBlendSteps;
  return static_cast<std::uint32_t>(
      std::clamp(std::floor(share * (kSteps + 1.0) - phase_of(place)), 0.0, kSteps));
}

}  // namespace

std::uint32_t LevelBlends::Shown::packed() const {
  if (whole()) return 0;
  const std::uint32_t pixels =
      none() ? shared::kBlendSteps | shared::kBlendSteps << 8 : first | end << 8;
  return pixels | (goes ? shared::kBlendGoes : 0u);
}

void LevelBlends::change(std::uint64_t id, std::span<const SectionKey> came,
                         std::span<const SectionKey> went) {
  if (came.empty() && went.empty()) return;
  Island& island = islands_[id];
  const std::set<SectionKey> comes(came.begin(), came.end()), goes(went.begin(), went.end());
  std::set<SectionKey> finer_shown;  // places of which finer sections are shown
  const auto note = [&](const SectionKey& key) {
    each_above(key, [&](const SectionKey& place) { finer_shown.insert(place); });
  };
  for (const SectionKey& key : went) note(key);
  for (const auto& [key, section] : island.sections)
    if (!section.chosen) note(key);
  for (const SectionKey& key : came) {
    // What is finer of it gives way, unless it was not shown; where nothing was, it appears.
    const bool after_coarser = any_above(key, goes) && !finer_shown.contains(key);
    if (!after_coarser) island.shares.try_emplace(key, Share{1.0, false, shared::kBlendSteps});
    if (const auto share = island.shares.find(key); share != island.shares.end())
      share->second.rises = false;
    // What is coarser of it gives way, be it on its way out already.
    each_above(key, [&](const SectionKey& place) {
      if (island.sections.contains(place)) island.shares[place].rises = true;
    });
    island.sections[key].chosen = true;
    island.sections[key].visited = false;
  }
  for (const SectionKey& key : went) {
    if (!any_above(key, comes)) island.shares[key].rises = true;
    island.sections[key].chosen = false;
    island.sections[key].visited = false;
  }
  island.linked = false;
  island.unsettled = true;
}

void LevelBlends::set(const SectionKey& place, Share& share, double finer, Island& island) {
  share.finer = finer;
  const std::uint32_t step = step_of(place, finer);
  island.unsettled |= std::exchange(share.step, step) != step;
}

void LevelBlends::advance(double seconds) {
  const double by = std::min(seconds / kSeconds, kMostAStep);
  for (auto& [id, island] : islands_)
    for (auto& [place, share] : island.shares)
      set(place, share, std::clamp(share.finer + (share.rises ? by : -by), 0.0, 1.0), island);
}

void LevelBlends::finish(std::uint64_t id) {
  const auto found = islands_.find(id);
  if (found == islands_.end()) return;
  Island& island = found->second;
  for (auto& [place, share] : island.shares) set(place, share, share.rises ? 1.0 : 0.0, island);
}

void LevelBlends::finish_all() {
  for (const auto& [id, island] : islands_) finish(id);
}

/// Hundreds of sections ask for the shares above them in every frame.
void LevelBlends::link(Island& island) {
  if (std::exchange(island.linked, true)) return;
  const auto share_of = [&](const SectionKey& place) {
    const auto found = island.shares.find(place);
    return found == island.shares.end() ? nullptr : &found->second;
  };
  for (auto& entry : island.sections) {
    const SectionKey& key = entry.first;
    Section& section = entry.second;
    section.own = share_of(key);
    section.above = {};
    std::size_t next = 0;
    each_above(key, [&](const SectionKey& place) { section.above[next++] = share_of(place); });
  }
}

LevelBlends::Shown LevelBlends::shown(const Section& section) {
  Shown out{.goes = !section.chosen};
  if (section.own) out.first = section.own->step;
  for (const Share* share : section.above)
    if (share) out.end = std::min(out.end, share->step);
  return out;
}

void LevelBlends::each_changed(const std::function<void(const SectionKey&, const Shown&)>& visit) {
  for (auto& [id, island] : islands_) {
    if (!island.unsettled) continue;
    link(island);
    for (auto& [key, section] : island.sections) {
      const Shown now = shown(section);
      if (std::exchange(section.visited, true) && section.shown == now) continue;
      section.shown = now;
      visit(key, now);
    }
  }
}

void LevelBlends::repeat(const SectionKey& key) {
  const auto island = islands_.find(key.island);
  if (island == islands_.end()) return;
  const auto section = island->second.sections.find(key);
  if (section == island->second.sections.end()) return;
  section->second.visited = false;
  island->second.unsettled = true;
}

std::vector<std::uint64_t> LevelBlends::settle() {
  std::vector<std::uint64_t> done;
  for (auto& [id, island] : islands_) {
    if (!std::exchange(island.unsettled, false)) continue;
    link(island);
    bool any_share = false;
    for (auto section = island.sections.begin(); section != island.sections.end();) {
      const Shown now = shown(section->second);
      if (section->second.chosen ? !now.whole() : !now.none()) {
        ++section;
        continue;
      }
      // Of places that are not sections any more shares say nothing.
      if (Share* const own = section->second.own) any_share = own->done = true;
      section = island.sections.erase(section);
    }
    if (island.sections.empty()) done.push_back(id);
    if (!any_share) continue;
    for (auto& [key, section] : island.sections)
      for (Share*& share : section.above)
        if (share && share->done) share = nullptr;
    std::erase_if(island.shares, [](const auto& share) { return share.second.done; });
  }
  for (const std::uint64_t id : done) islands_.erase(id);
  return done;
}

}  // namespace skerry::game
