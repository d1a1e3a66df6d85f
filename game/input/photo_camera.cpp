#include "game/input/photo_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace skerry::game {
namespace {

constexpr double kSpeed = 8.0, kFastSpeed = 40.0;  // blocks/s

}  // namespace

void PhotoCamera::advance(const LookInput& input, double fov_deg) {
  const glm::dvec2 turned = turned_deg(input, fov_deg);
  place_.yaw_deg = std::remainder(place_.yaw_deg + turned.x, 360.0);
  place_.pitch_deg = std::clamp(place_.pitch_deg + turned.y, -90.0, 90.0);
  const Intent intent = intent_of(*input.actions);
  const double yaw = glm::radians(place_.yaw_deg), pitch = glm::radians(place_.pitch_deg);
  const glm::dvec3 ahead{std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                         std::cos(yaw) * std::cos(pitch)};
  const glm::dvec3 right{-std::cos(yaw), 0.0, std::sin(yaw)};
  glm::dvec3 way =
      ahead * intent.move.y + right * intent.move.x + glm::dvec3(0.0, intent.rise, 0.0);
  if (const double length = glm::length(way); length > 1.0) way /= length;
  place_.position =
      world::moved(place_.position, way * ((intent.fast ? kFastSpeed : kSpeed) * input.seconds));
}

}  // namespace skerry::game
