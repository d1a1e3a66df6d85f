// The map of a run of the game: places to find again, and what was found.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "game/client/island_name.h"
#include "game/client/play_loop.h"
#include "game/map/island_kinds.h"
#include "game/ui/hud.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

constexpr double kMapPeriod = 2.0;    // seconds after which a map is drawn anew: islands drift
constexpr double kMapFollows = 0.02;  // of its radius: it is drawn anew when moved by more
constexpr double kDriftSpan = 60.0;   // seconds over which drift is measured
constexpr double kMarkedHere = 4.0;   // blocks: no mark is shown of a place where one is

glm::dvec2 flat(const glm::dvec3& v) {
  return {v.x, v.z};
}

std::string shown_name(const Wayfinder::Place& place) {
  if (place.kind == ui::PlaceKind::kHome) return tr("Home");
  return place.name.empty() ? tr("Waypoint") : place.name;
}

}  // namespace

void PlayLoop::act_on_places(const ActionFrame& actions) {
  if (actions.pressed(Action::kMark)) mark_place();
  if (actions.pressed(Action::kGoHome)) {
    const std::vector<Wayfinder::Place> places = wayfinder_.places(player_, player_.tick_time_s());
    if (!places.empty() && places.front().kind == ui::PlaceKind::kHome)
      travel_to(places.front());
    else
      said_.emplace_back(tr("There is no home yet: make a place of the map one"));
  }
  for (const Found& found : wayfinder_.note(player_)) {
    const std::string_view what = found.what == Found::What::kKind
                                      ? kind_name(static_cast<world::Archetype>(found.number))
                                      : biome_name(static_cast<world::Biome>(found.number));
    said_.push_back(tr_format("Discovered: {} ({})", what, island_name(found.island)));
  }
  keep_journal();
}

/// The session hears of every change.
void PlayLoop::keep_journal() {
  if (wayfinder_.take_changed()) session_->send(KeepJournal{wayfinder_.journal()});
}

void PlayLoop::mark_place() {
  const auto number = wayfinder_.journal().waypoints.size() + 1;
  const std::optional<std::uint64_t> island = player_.frame_island();
  std::string name = island ? fmt::format("{} {}", island_name(*island), number)
                            : tr_format("Waypoint {}", number);
  const std::string line = tr_format("Marked: {}", name);
  if (wayfinder_.mark(player_, std::move(name)))
    said_.push_back(line);
  else
    said_.push_back(tr_format("There are {} waypoints: remove one first", kMaxWaypoints));
}

void PlayLoop::travel_to(const Wayfinder::Place& place) {
  helm_.leave(*session_);
  wayfinder_.travel(place.spot, player_, around_);
  scene_.camera = player_.eye(around_);
  tell_session();
  said_.push_back(place.kind == ui::PlaceKind::kGround
                      ? std::string(tr("Back on the last safe ground"))
                      : tr_format("Back: {}", shown_name(place)));
}

void PlayLoop::fulfil(const ui::MapWishes& wishes) {
  const std::vector<Wayfinder::Place> places = wayfinder_.places(player_, player_.tick_time_s());
  const auto waypoint = [&](std::size_t place) {
    return place + wayfinder_.journal().waypoints.size() - places.size();  // they come last
  };
  if (wishes.rename && *wishes.rename < places.size())
    wayfinder_.rename(waypoint(*wishes.rename), wishes.name);
  if (wishes.make_home && *wishes.make_home < places.size()) {
    const Spot& home = places[*wishes.make_home].spot;
    wayfinder_.make_home(home);
    if (home.island) player_.set_home({*home.island, home.lattice});
  }
  if (wishes.remove && *wishes.remove < places.size()) wayfinder_.remove(waypoint(*wishes.remove));
  if (wishes.mark) mark_place();
  if (wishes.travel && *wishes.travel < places.size()) travel_to(places[*wishes.travel]);
  keep_journal();
}

/// Islands around a place, nearest first, as the map shows them.
void PlayLoop::ask_for_map(double radius, world::WorldPos middle) {
  MapMaker::Request request;
  request.middle = middle;
  request.radius = radius;
  const double time_s = session_->time_s();
  const world::World& world = view_->world();
  for (const world::IslandSpec& spec :
       world.islands_near(request.middle, radius * std::sqrt(2.0), time_s)) {
    const std::optional<world::Pose> pose = world.pose(spec.id, time_s);
    if (!pose) continue;
    const glm::dvec3 at = world::difference_blocks(pose->origin, request.middle);
    const glm::dvec3 ahead = pose->rotation * glm::dvec3(0.0, 0.0, 1.0);
    request.islands.push_back(
        {spec, !world.is_added(spec.id), {nullptr, flat(at), at.y, std::atan2(ahead.x, ahead.z)}});
  }
  map_asked_s_ = time_s;
  map_maker_.ask(std::move(request));
}

std::optional<ui::Rgba> PlayLoop::take_map(double radius, glm::dvec2 shift) {
  const world::WorldPos middle = world::moved(player_.feet(), {shift.x, 0.0, shift.y});
  map_view_ = flat(world::difference_blocks(middle, map_.middle));
  const double since_s = session_->time_s() - map_asked_s_;
  const bool due = !map_taken_ || map_.to_come != 0 || map_.radius != radius ||
                   glm::length(map_view_) > kMapFollows * radius || since_s > kMapPeriod ||
                   since_s < 0.0;
  std::optional<MapMaker::Map> drawn = map_maker_.take();
  if (!drawn) {
    if (due && map_maker_.idle()) ask_for_map(radius, middle);
    return std::nullopt;
  }
  ui::Rgba picture = std::move(drawn->picture);
  map_ = *std::move(drawn);
  map_taken_ = true;
  map_view_ = flat(world::difference_blocks(middle, map_.middle));
  return picture;
}

ui::MapFacts PlayLoop::map_facts() const {
  ui::MapFacts facts;
  const double time_s = session_->time_s();
  const world::WorldPos feet = player_.feet();
  const auto from_middle = [&](world::WorldPos place) {
    return flat(world::difference_blocks(place, map_.middle));
  };
  facts.radius = map_taken_ ? map_.radius : 0.0;
  facts.view = map_view_;
  facts.to_come = map_.to_come;
  facts.player = from_middle(feet);
  facts.yaw_deg = scene_.camera->yaw_deg;
  facts.full = wayfinder_.journal().waypoints.size() >= kMaxWaypoints;
  const Discoveries& found = wayfinder_.journal().found;
  facts.kinds = std::popcount(found.kinds);
  facts.all_kinds = static_cast<int>(world::Archetype::kCount);
  facts.biomes = std::popcount(found.biomes);
  facts.all_biomes = static_cast<int>(world::Biome::kCount);
  facts.highest = found.highest;
  facts.deepest = found.deepest;
  for (const Wayfinder::Place& place : wayfinder_.places(player_, time_s))
    facts.places.push_back({place.kind, place.name, from_middle(place.feet),
                            world::difference_blocks(place.feet, feet).y});
  const world::World& world = view_->world();
  for (const world::IslandSpec& spec : world.islands_near(map_.middle, map_.radius, time_s)) {
    const auto now = world.pose(spec.id, time_s), later = world.pose(spec.id, time_s + kDriftSpan);
    if (!now || !later) continue;
    const glm::dvec3 drift = world::difference_blocks(later->origin, now->origin) / kDriftSpan;
    facts.islands.push_back({island_name(spec.id),
                             world.is_added(spec.id) ? std::string() : description_of(spec),
                             from_middle(now->origin), spec.bounding_radius,
                             world::difference_blocks(now->origin, feet).y, flat(drift)});
  }
  return facts;
}

std::vector<ui::HudFacts::Mark> PlayLoop::compass_marks() const {
  std::vector<ui::HudFacts::Mark> marks;
  for (const Wayfinder::Place& place : wayfinder_.places(player_, player_.tick_time_s())) {
    if (place.kind == ui::PlaceKind::kGround) continue;
    const glm::dvec3 to = world::difference_blocks(place.feet, player_.feet());
    const double blocks = glm::length(to);
    if (blocks < kMarkedHere) continue;
    marks.push_back({place.kind, shown_name(place),
                     ui::bearing_deg(glm::degrees(std::atan2(to.x, to.z))), blocks});
  }
  return marks;
}

}  // namespace skerry::game
