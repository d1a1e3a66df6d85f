#include "game/map/map_maker.h"

#include <utility>

#include "engine/core/clock.h"

namespace skerry::game {
namespace {

// A map is shown after so much of charting, and drawn anew with the rest.
constexpr double kChartingMs = 80.0;
constexpr std::size_t kMostKnown = 512;  // islands; a large one takes 300 KiB

}  // namespace

void MapMaker::ask(Request request) {
  busy_ = true;
  thread_.submit([this, request = std::move(request)]() mutable {
    Map map = draw(request);
    {
      const std::lock_guard lock(mutex_);
      done_ = std::move(map);
    }
    busy_ = false;
  });
}

std::optional<MapMaker::Map> MapMaker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

/// @return whether the island has a chart now.
bool MapMaker::chart(Island& island, bool may_make) {
  const world::IslandSpec& spec = island.spec;
  const auto found = known_.find(spec.id);
  const bool current =
      found != known_.end() && (island.planned || (found->second.box_min == spec.box_min &&
                                                   found->second.box_max == spec.box_max));
  if (!current) {
    if (!may_make) return false;
    const IslandChart made = island.planned ? chart_of(spec) : outline_of(spec);
    known_[spec.id] = {std::make_shared<const IslandChart>(made), spec.box_min, spec.box_max};
  }
  island.land.chart = known_[spec.id].chart;
  return true;
}

MapMaker::Map MapMaker::draw(Request& request) {
  if (known_.size() > kMostKnown) known_.clear();
  Map map{request.middle, request.radius, {}, 0, 0.0, 0.0};
  std::vector<MapLand> lands;
  const Stopwatch charting;
  for (Island& island : request.islands) {
    if (chart(island, charting.milliseconds() < kChartingMs))
      lands.push_back(island.land);
    else
      ++map.to_come;
  }
  map.chart_ms = charting.milliseconds();
  const Stopwatch drawing;
  map.picture = draw_map(lands, request.radius, kEdge);
  map.draw_ms = drawing.milliseconds();
  return map;
}

}  // namespace skerry::game
