#include "world/motion/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "world/motion/motion_body.h"

namespace skerry::world {
namespace {

constexpr double kDt = kMotionTickSeconds;
// Slower than this, an island without engines stands still [blocks/s].
constexpr double kRestSpeed = 1.0 / 256.0;
// Islands are looked for so far around a disturbed one, and again when it has come half as far.
constexpr double kLookAround = 64.0;
// A hit that changes an island's speed by less leaves it on its course [blocks/s] ...
constexpr double kFeltSpeed = 0.02;
// ... unless it is this deep in the other [blocks].
constexpr double kDeepContact = 0.25;

/// Speed that turning gives a place.
glm::dvec3 carried(double spin, const glm::dvec3& arm) {
  return spin * glm::dvec3{arm.z, 0.0, -arm.x};
}

/// Any island's speed by the closed form, over one tick.
MotionState on_course_at(const IslandSpec& spec, std::int64_t tick, const glm::dvec3& centre) {
  MotionState state;
  state.tick = tick;
  const double time = static_cast<double>(tick) * kDt;
  state.pose = pose_at(spec, time);
  const Pose then = pose_at(spec, time + kDt);
  state.spin = spec.spin_rad_per_s;
  state.velocity = (difference_blocks(then.origin, state.pose.origin) +
                    Turn::of(then.rotation)(centre) - Turn::of(state.pose.rotation)(centre)) /
                   kDt;
  return state;
}

}  // namespace

Pose moved_pose(const Pose& from, const glm::dvec3& centre, const glm::dvec3& velocity, double spin,
                double seconds) {
  // Sine and cosine of half the angle by their series, which + and * give alike everywhere; at the
  // fastest spin the next term is below a double's last bit.
  const double a = 0.5 * spin * seconds, a2 = a * a;
  const double sine = a * (1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0)));
  const double cosine = 1.0 - a2 / 2.0 * (1.0 - a2 / 12.0 * (1.0 - a2 / 30.0));
  glm::dquat q = from.rotation;
  const double w = q.w * cosine - q.y * sine, y = q.w * sine + q.y * cosine;
  const double scale = 1.0 / std::sqrt(w * w + y * y);
  q = {w * scale, 0.0, y * scale, 0.0};
  const glm::dvec3 arm = Turn::of(from.rotation)(centre) - Turn::of(q)(centre);
  return {moved(from.origin, velocity * seconds + arm), q};
}

IslandMotion::IslandMotion(World& world, Shapes shapes)
    : world_(world), shapes_(std::move(shapes)) {
  if (!shapes_)
    shapes_ = [this](std::uint64_t island) {
      return std::make_unique<Shape>(SolidGrid::of_island(world_, island));
    };
}

IslandMotion::~IslandMotion() = default;

void IslandMotion::start(double time_s) {
  // A time that was made of a tick is that tick, though a double may say a little less.
  constexpr double kRounding = 1e-6;
  tick_ = static_cast<std::int64_t>(std::floor(time_s * kMotionTicksPerSecond + kRounding));
  for (auto& [id, body] : bodies_) {
    body->now.tick = tick_;
    body->reported = false;
    report(*body);
  }
}

IslandMotion::Body* IslandMotion::find(std::uint64_t island) {
  const auto found = bodies_.find(island);
  return found == bodies_.end() ? nullptr : found->second.get();
}

std::unique_ptr<IslandMotion::Body> IslandMotion::body_on_course(const IslandSpec& spec) const {
  auto body = std::make_unique<Body>();
  body->id = spec.id;
  body->ball_radius = spec.bounding_radius;
  body->on_course = true;
  body->now = on_course_at(spec, tick_, {});
  body->next = pose_at(spec, static_cast<double>(tick_ + 1) * kDt);
  return body;
}

void IslandMotion::want_shape(Body& body) {
  if (!body.shape) body.shape = from_shelf(body.id);
  if (!body.shape) body.shape = shapes_(body.id);
  if (!body.shape || !std::exchange(body.now.of_origin, false)) return;
  body.now.velocity += carried(body.now.spin, Turn::of(body.now.pose.rotation)(body.centre()));
}

void IslandMotion::drop_shape(Body& body) {
  if (!body.shape) return;
  body.now.velocity -= carried(body.now.spin, Turn::of(body.now.pose.rotation)(body.centre()));
  body.now.of_origin = true;
  body.shape.reset();
}

/// Islands that touch others now and then keep their shapes meanwhile, the last kShelf of them.
void IslandMotion::to_shelf(Body& body) {
  if (!body.shape) return;
  shelf_.emplace_front(body.id, std::move(body.shape));
  if (shelf_.size() > kShelf) shelf_.pop_back();
}

std::unique_ptr<Shape> IslandMotion::from_shelf(std::uint64_t island) {
  const auto found = std::find_if(shelf_.begin(), shelf_.end(),
                                  [&](const auto& kept) { return kept.first == island; });
  if (found == shelf_.end()) return nullptr;
  std::unique_ptr<Shape> shape = std::move(found->second);
  shelf_.erase(found);
  return shape;
}

bool IslandMotion::disturb(std::uint64_t island) {
  if (find(island)) return true;
  const std::optional<IslandSpec> spec = world_.island(island);
  if (!spec) return false;
  std::unique_ptr<Body> body = body_on_course(*spec);
  body->now.of_origin = true;
  body->on_course = false;
  if (const auto course = courses_.find(island); course != courses_.end())
    body->shape = std::move(course->second->shape);
  want_shape(*body);
  body->next = body->now.pose;
  courses_.erase(island);
  report(*body);
  bodies_.emplace(island, std::move(body));
  return true;
}

void IslandMotion::add(std::uint64_t island, const MotionState& state,
                       std::unique_ptr<Shape> shape) {
  auto body = std::make_unique<Body>();
  body->id = island;
  if (const auto spec = world_.island(island)) body->ball_radius = spec->bounding_radius;
  body->now = state;
  body->now.tick = tick_;
  body->next = state.pose;
  body->shape = std::move(shape);
  want_shape(*body);
  courses_.erase(island);
  report(*body);
  bodies_.insert_or_assign(island, std::move(body));
}

bool IslandMotion::steer(std::uint64_t island, glm::dvec3 thrust, double turn) {
  const double most = std::max(1.0, length(thrust));
  thrust /= most;
  turn = std::clamp(turn, -1.0, 1.0);
  const bool engines = thrust != glm::dvec3{} || turn != 0.0;
  if (engines && !disturb(island)) return false;
  Body* body = find(island);
  if (!body) return world_.island(island).has_value();
  body->thrust = thrust;
  body->turn = turn;
  return true;
}

void IslandMotion::edited(std::uint64_t island, std::span<const IVec3> voxels, bool solid) {
  if (const auto course = courses_.find(island); course != courses_.end() && course->second->shape)
    course->second->shape->edit(voxels, solid);
  for (auto& [id, shape] : shelf_)
    if (id == island) shape->edit(voxels, solid);
  Body* body = find(island);
  if (!body || !body->shape) return;
  const glm::dvec3 before = body->centre();
  body->shape->edit(voxels, solid);
  const glm::dvec3 arm = Turn::of(body->now.pose.rotation)(body->centre() - before);
  body->now.velocity += carried(body->now.spin, arm);
}

void IslandMotion::reshape(std::uint64_t island) {
  courses_.erase(island);
  from_shelf(island);
  if (Body* body = find(island)) drop_shape(*body);
}

/// Engines, air and limits; then where it would go.
void IslandMotion::drive(Body& body) const {
  body.held = false;
  body.waits = !body.shape;
  body.next = body.now.pose;
  if (!body.awake() || !body.shape) return;
  MotionState& now = body.now;
  now.velocity += Turn::of(now.pose.rotation)(body.thrust) * (kThrust * kDt);
  now.spin += body.turn * kTurnThrust * kDt;
  constexpr double kKept = 1.0 / (1.0 + kAirDrag * kDt);
  now.velocity *= kKept;
  now.spin *= kKept;
  const double fastest = length(now.velocity) + std::abs(now.spin) * body.radius();
  if (fastest > kMaxIslandSpeed) {
    now.velocity *= kMaxIslandSpeed / fastest;
    now.spin *= kMaxIslandSpeed / fastest;
  }
  if (!body.driven() && fastest < kRestSpeed) {
    now.velocity = {};
    now.spin = 0.0;
  }
  body.next = moved_pose(now.pose, body.centre(), now.velocity, now.spin, kDt);
}

/// Islands on their courses that a disturbed one may touch in this tick.
void IslandMotion::meet_courses(Body& body) {
  const WorldPos place = body.place(body.now.pose);
  const glm::dvec3 since =
      body.looked_from ? difference_blocks(place, *body.looked_from) : glm::dvec3{};
  if (!body.looked_from || length(since) > 0.5 * kLookAround) {
    body.looked_from = place;
    body.course_islands.clear();
    // One that has left its course does not come back to it.
    for (const IslandSpec& spec :
         world_.islands_near(place, body.radius() + kLookAround, static_cast<double>(tick_) * kDt))
      if (!bodies_.contains(spec.id)) body.course_islands.push_back(spec.id);
  }
  for (const std::uint64_t id : body.course_islands) {
    if (bodies_.contains(id)) continue;
    const std::optional<IslandSpec> spec = world_.island(id);
    if (!spec) continue;
    const glm::dvec3 away =
        difference_blocks(pose_at(*spec, static_cast<double>(tick_) * kDt).origin, place);
    if (length(away) > spec->bounding_radius + body.radius() + 1.0) continue;
    std::unique_ptr<Body>& course = courses_[id];
    if (course && course->wanted) continue;
    std::unique_ptr<Body> fresh = body_on_course(*spec);
    if (course) fresh->shape = std::move(course->shape);
    course = std::move(fresh);
    want_shape(*course);
    course->now = on_course_at(*spec, tick_, course->centre());
    course->wanted = true;
  }
}

/// Pairs whose balls overlap, at least one of them off its course and one of them awake. Sorted
/// along x, then swept, so that those far apart are never compared.
std::vector<IslandMotion::Pair> IslandMotion::near_pairs() {
  struct Span {
    std::int64_t low, high;
    WorldPos place;
    Body* body;
  };
  std::vector<Span> spans;
  for (const Bodies* all : {&bodies_, &courses_}) {
    for (const auto& [id, body] : *all) {
      // A tick's way, and a little for where a ball is turned about.
      const double reach = body->radius() + 1.5;
      const auto units = static_cast<std::int64_t>(reach * kUnitsPerBlock);
      const WorldPos place = body->place(body->now.pose);
      spans.push_back({place.x - units, place.x + units, place, body.get()});
    }
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) {
    return std::tie(a.low, a.body->id) < std::tie(b.low, b.body->id);
  });
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    for (std::size_t j = i + 1; j < spans.size() && spans[j].low <= spans[i].high; ++j) {
      Body *a = spans[i].body, *b = spans[j].body;
      if ((a->on_course && b->on_course) || (!a->awake() && !b->awake())) continue;
      const double reach = a->radius() + b->radius() + 2.0;
      const glm::dvec3 away = difference_blocks(spans[i].place, spans[j].place);
      if (glm::dot(away, away) > reach * reach) continue;
      if (a->id > b->id) std::swap(a, b);
      pairs.push_back({a, b, {}});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
    return std::tie(p.a->id, p.b->id) < std::tie(q.a->id, q.b->id);
  });
  return pairs;
}

namespace {

template <class Body>
Touch touch_between(const Body& a, const Pose& pose_a, const Body& b, const Pose& pose_b) {
  if (a.shape && b.shape) return touch_of(*a.shape, pose_a, *b.shape, pose_b);
  const double apart = length(difference_blocks(a.place(pose_a), b.place(pose_b)));
  return {std::max(0.0, a.radius() + b.radius() - apart), {}};
}

}  // namespace

/// Finds who has to stay where it is. Each hold may free the way of nobody and bar that of others,
/// so this ends: at the latest when all are held, as they were a tick ago.
void IslandMotion::hold(std::vector<Pair>& pairs) {
  for (bool changed = true; changed;) {
    changed = false;
    for (Pair& pair : pairs) {
      Body &a = *pair.a, &b = *pair.b;
      const int state = a.held + 2 * b.held;
      if (pair.state == state) continue;
      pair.state = state;
      Touch touch = touch_between(a, a.pose(), b, b.pose());
      if (touch.overlap == 0.0) continue;
      pair.touch = std::move(touch);
      pair.between = difference_blocks(a.place(a.pose()), b.place(b.pose()));
      if (pair.before < 0.0) pair.before = touch_between(a, a.now.pose, b, b.now.pose).overlap;
      if (pair.touch.overlap <= pair.before) continue;
      for (Body* body : {&a, &b}) {
        if (body->on_course || body->held) continue;
        body->held = true;
        changed = true;
      }
    }
  }
}

/// What is held by an island whose shape is not known yet waits for it, without gathering speed.
void IslandMotion::stop_at_balls(const std::vector<Pair>& pairs) {
  for (const Pair& pair : pairs) {
    if (pair.touch.overlap == 0.0 || (pair.a->shape && pair.b->shape)) continue;
    for (Body* body : {pair.a, pair.b}) {
      if (body->on_course || !body->held) continue;
      body->waits = true;
      body->now.velocity = {};
      body->now.spin = 0.0;
    }
  }
}

/// Takes islands from their courses that were hit so that it counts. @return whether any was.
bool IslandMotion::leave_courses(std::vector<Pair>& pairs) {
  bool any = false;
  for (const Pair& pair : pairs) {
    if (pair.touch.contacts.empty() || pair.a->on_course == pair.b->on_course) continue;
    Body& course = pair.a->on_course ? *pair.a : *pair.b;
    const Body& other = pair.a->on_course ? *pair.b : *pair.a;
    const double own = static_cast<double>(course.shape->mass().blocks);
    const double hits = static_cast<double>(other.shape->mass().blocks);
    const double speed = length(other.now.velocity - course.now.velocity) +
                         std::abs(other.now.spin) * other.radius();
    if (speed * hits / (own + hits) < kFeltSpeed &&
        pair.touch.contacts.front().depth < kDeepContact)
      continue;
    course.on_course = false;
    course.reported = false;
    any = true;
    const auto found = courses_.find(course.id);
    bodies_.emplace(course.id, std::move(found->second));
    courses_.erase(found);
  }
  return any;
}

void IslandMotion::step() {
  for (auto& [id, body] : bodies_) {
    want_shape(*body);
    drive(*body);
  }
  for (auto& [id, course] : courses_) course->wanted = false;
  for (auto& [id, body] : bodies_) meet_courses(*body);  // one at rest, too, may be run into
  std::erase_if(courses_, [this](const auto& entry) {
    if (!entry.second->wanted) to_shelf(*entry.second);
    return !entry.second->wanted;
  });
  std::vector<Pair> pairs = near_pairs();
  hold(pairs);
  stop_at_balls(pairs);
  while (leave_courses(pairs)) {
    for (auto& [id, body] : bodies_)
      if (!body->reported)
        body->next =
            moved_pose(body->now.pose, body->centre(), body->now.velocity, body->now.spin, kDt);
    for (Pair& pair : pairs) pair.a->held = pair.b->held = false;
    for (Pair& pair : pairs) {
      pair.state = -1;
      pair.touch = {};
    }
    hold(pairs);
  }
  exchange_impulses(pairs);

  counts_ = {bodies_.size(), 0, pairs.size(), 0, 0};
  for (const Pair& pair : pairs) counts_.touching += pair.touch.overlap > 0.0;
  ++tick_;
  for (auto& [id, body] : bodies_) {
    counts_.awake += body->awake();
    counts_.held += body->held;
    body->now.pose = body->pose();
    body->now.tick = tick_;
    report(*body);
  }
}

/// One that stands still is where the world has it; when it goes on, the world is given since
/// when, so that it does not jump there.
void IslandMotion::report(Body& body) {
  const std::optional<Pose> known = world_.pose(body.id, static_cast<double>(tick_) * kDt);
  const bool still =
      known && known->origin == body.now.pose.origin && known->rotation == body.now.pose.rotation;
  const bool alike =
      body.now.velocity == body.reported_velocity && body.now.spin == body.reported_spin;
  if (body.reported && still && alike && body.waits == body.reported_waits) return;
  if (body.reported && known && body.reported_tick < tick_ - 1)
    report_to_world(body, tick_ - 1, *known);
  report_to_world(body, tick_, body.now.pose);
  body.reported = true;
  body.reported_tick = tick_;
  body.reported_waits = body.waits;
  body.reported_velocity = body.now.velocity;
  body.reported_spin = body.now.spin;
}

void IslandMotion::report_to_world(Body& body, std::int64_t tick, const Pose& pose) {
  world_.move_island(body.id, tick, pose);
  if (!moves_) return;
  moves_->push_back({body.id, body.now, body.waits});
  moves_->back().state.tick = tick;
  moves_->back().state.pose = pose;
}

void IslandMotion::advance_to(double time_s) {
  const auto wanted = static_cast<std::int64_t>(std::ceil(time_s * kMotionTicksPerSecond));
  if (wanted - tick_ > kMaxTicks) {
    tick_ = wanted - kMaxTicks;
    for (auto& [id, body] : bodies_) body->now.tick = tick_;
  }
  if (bodies_.empty()) tick_ = wanted;
  if (tick_ - wanted > kMaxTicks) start(time_s);
  while (tick_ < wanted) step();
}

std::vector<MovingIsland> IslandMotion::states() const {
  std::vector<MovingIsland> out;
  for (const auto& [id, body] : bodies_) out.push_back({id, body->now});
  return out;
}

std::optional<IslandMotion::PointMotion> IslandMotion::motion_at(std::uint64_t island,
                                                                 const glm::dvec3& place) const {
  const auto found = bodies_.find(island);
  if (found == bodies_.end()) {
    const std::optional<IslandSpec> spec = world_.island(island);
    if (!spec) return std::nullopt;
    const MotionState state = on_course_at(*spec, tick_, place);
    return PointMotion{state.pose, state.velocity, state.spin};
  }
  if (!found->second->shape && !found->second->now.of_origin) return std::nullopt;
  const MotionState& now = found->second->now;
  const glm::dvec3 arm = Turn::of(now.pose.rotation)(place - found->second->centre());
  return PointMotion{now.pose, now.velocity + carried(now.spin, arm), now.spin};
}

}  // namespace skerry::world
