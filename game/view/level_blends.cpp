#include "game/view/level_blends.h"

#include <algorithm>
#include <cmath>
#include <optional>

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

std::uint32_t steps(double share) {
  return static_cast<std::uint32_t>(std::lround(share * shared::kBlendSteps));
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
  for (const auto& [key, chosen] : island.sections)
    if (!chosen) note(key);
  for (const SectionKey& key : came) {
    // What is finer of it gives way, unless it was not shown; where nothing was, it appears.
    const bool after_coarser = any_above(key, goes) && !finer_shown.contains(key);
    if (!after_coarser) island.shares.try_emplace(key, Share{1.0, false});
    if (const auto share = island.shares.find(key); share != island.shares.end())
      share->second.rises = false;
    // What is coarser of it gives way, be it on its way out already.
    each_above(key, [&](const SectionKey& place) {
      if (island.sections.contains(place)) island.shares[place].rises = true;
    });
    island.sections[key] = true;
  }
  for (const SectionKey& key : went) {
    if (!any_above(key, comes)) island.shares[key].rises = true;
    island.sections[key] = false;
  }
}

void LevelBlends::advance(double seconds) {
  const double by = std::min(seconds / kSeconds, kMostAStep);
  for (auto& [id, island] : islands_)
    for (auto& [place, share] : island.shares)
      share.finer = std::clamp(share.finer + (share.rises ? by : -by), 0.0, 1.0);
}

void LevelBlends::finish(std::uint64_t id) {
  const auto island = islands_.find(id);
  if (island == islands_.end()) return;
  for (auto& [place, share] : island->second.shares) share.finer = share.rises ? 1.0 : 0.0;
}

void LevelBlends::finish_all() {
  for (const auto& [id, island] : islands_) finish(id);
}

LevelBlends::Shown LevelBlends::shown(const Island& island, const SectionKey& key, bool chosen) {
  Shown out{.goes = !chosen};
  const auto own = island.shares.find(key);
  if (own != island.shares.end()) out.first = steps(own->second.finer);
  each_above(key, [&](const SectionKey& place) {
    if (const auto share = island.shares.find(place); share != island.shares.end())
      out.end = std::min(out.end, steps(share->second.finer));
  });
  return out;
}

void LevelBlends::each(const std::function<void(const SectionKey&, const Shown&)>& visit) const {
  for (const auto& [id, island] : islands_)
    for (const auto& [key, chosen] : island.sections) visit(key, shown(island, key, chosen));
}

std::vector<std::uint64_t> LevelBlends::settle() {
  std::vector<std::uint64_t> done;
  for (auto& [id, island] : islands_) {
    std::vector<SectionKey> over;
    for (auto section = island.sections.begin(); section != island.sections.end();) {
      const auto& [key, chosen] = *section;
      const Shown now = shown(island, key, chosen);
      if (chosen ? !now.whole() : !now.none()) {
        ++section;
        continue;
      }
      over.push_back(key);
      section = island.sections.erase(section);
    }
    // Of places that are not sections any more shares say nothing.
    for (const SectionKey& key : over) island.shares.erase(key);
    if (island.sections.empty()) done.push_back(id);
  }
  for (const std::uint64_t id : done) islands_.erase(id);
  return done;
}

}  // namespace skerry::game
