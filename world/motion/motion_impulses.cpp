#include <algorithm>
#include <cmath>

#include "world/motion/motion_body.h"

namespace skerry::world {
namespace {

constexpr double kBounce = 0.2, kFriction = 0.3;
// How fast islands that overlapped before are pushed apart, at most [blocks/s].
constexpr double kPushSpeed = 0.5;
// Of the spin of one island against another, what is lost in a tick in which they bar each other.
constexpr double kSpinLost = 0.25;
// Rounds of impulses: each contact undoes a little of what the others did.
constexpr int kRounds = 4;

/// Torque about the vertical of a force along `f` at `arm`.
double turning(const glm::dvec3& arm, const glm::dvec3& f) {
  return arm.z * f.x - arm.x * f.z;
}

template <class Body>
glm::dvec3 velocity_at(const Body& body, const glm::dvec3& arm) {
  return body.now.velocity + body.now.spin * glm::dvec3{arm.z, 0.0, -arm.x};
}

template <class Body>
void push(Body& body, const glm::dvec3& arm, const glm::dvec3& impulse) {
  body.now.velocity += impulse * body.inverse_mass();
  body.now.spin += turning(arm, impulse) * body.inverse_inertia();
}

/// How much a unit impulse along `f` changes the speed along it, of both together.
template <class Body>
double ease(const Body& a, const glm::dvec3& arm_a, const Body& b, const glm::dvec3& arm_b,
            const glm::dvec3& f) {
  const double ta = turning(arm_a, f), tb = turning(arm_b, f);
  return a.inverse_mass() + b.inverse_mass() + ta * ta * a.inverse_inertia() +
         tb * tb * b.inverse_inertia();
}

template <class Body>
void resolve(Body& a, Body& b, const Contact& contact, const glm::dvec3& between,
             double push_speed) {
  const glm::dvec3 arm_a = contact.point, arm_b = contact.point + between;
  const glm::dvec3 relative = velocity_at(a, arm_a) - velocity_at(b, arm_b);
  const double approach = glm::dot(relative, contact.normal);
  const double wanted = std::max(approach < 0.0 ? -kBounce * approach : approach, push_speed);
  const double along = ease(a, arm_a, b, arm_b, contact.normal);
  if (wanted <= approach || along <= 0.0) return;
  const double strength = (wanted - approach) / along;
  glm::dvec3 impulse = contact.normal * strength;
  const glm::dvec3 slide = relative - contact.normal * approach;
  const double speed = std::sqrt(glm::dot(slide, slide));
  if (speed > 0.0 && approach < 0.0) {
    const glm::dvec3 way = slide / speed;
    // Friction stops the slide at most; half of that, because the two impulses turn the islands
    // together and each was found as if alone.
    const double stop = 0.5 * speed / ease(a, arm_a, b, arm_b, way);
    impulse -= way * std::min(stop, kFriction * strength);
  }
  push(a, arm_a, impulse);
  push(b, arm_b, -impulse);
}

/// Two that bar each other's way do not turn against each other either. Contacts alone do not see
/// that: an island whose engines press it on a corner would turn about that corner faster and
/// faster without moving, and leap away once it is free. A torque between the two keeps the angular
/// momentum, and takes energy.
template <class Body>
void brake_spin(Body& a, Body& b) {
  const double along = a.inverse_inertia() + b.inverse_inertia();
  if (along <= 0.0) return;
  const double torque = kSpinLost * (a.now.spin - b.now.spin) / along;
  a.now.spin -= torque * a.inverse_inertia();
  b.now.spin += torque * b.inverse_inertia();
}

}  // namespace

/// Islands that touch exchange impulses: momentum is kept, and energy does not grow, but for those
/// that overlapped before: they are pushed apart slowly.
void IslandMotion::exchange_impulses(std::vector<Pair>& pairs) {
  for (Pair& pair : pairs)
    if (!pair.touch.contacts.empty() && pair.touch.overlap > pair.before)
      brake_spin(*pair.a, *pair.b);
  for (int round = 0; round < kRounds; ++round) {
    for (Pair& pair : pairs) {
      if (pair.touch.contacts.empty()) continue;
      Body &a = *pair.a, &b = *pair.b;
      for (const Contact& contact : pair.touch.contacts) {
        const double push_speed = pair.before > 0.0 ? std::min(kPushSpeed, contact.depth) : 0.0;
        resolve(a, b, contact, pair.between, push_speed);
      }
    }
  }
}

}  // namespace skerry::world
