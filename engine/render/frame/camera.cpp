#include "engine/render/frame/camera.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace skerry::render {

CameraView view_of(const Camera& camera, std::uint32_t width, std::uint32_t height) {
  const double yaw = glm::radians(camera.yaw_deg), pitch = glm::radians(camera.pitch_deg);
  const glm::dvec3 forward{std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                           std::cos(yaw) * std::cos(pitch)};
  // Right from the yaw alone, so that looking straight up or down keeps its heading.
  const glm::dvec3 right{-std::cos(yaw), 0.0, std::sin(yaw)};
  const glm::dvec3 up = glm::cross(right, forward);
  const double tan_y = std::tan(glm::radians(camera.fov_deg) * 0.5);
  const double tan_x = tan_y * width / height;

  CameraView view;
  view.right = right;
  view.up = up;
  view.forward = forward;
  view.tan_half_x = static_cast<float>(tan_x);
  view.tan_half_y = static_cast<float>(tan_y);
  // Rows: x = right . p / tan_x, y = -up . p / tan_y, z = near, w = forward . p.
  const glm::dvec3 row_x = right / tan_x, row_y = -up / tan_y;
  for (int column = 0; column < 3; ++column)
    view.clip_from_world[column] = glm::vec4(row_x[column], row_y[column], 0.0, forward[column]);
  view.clip_from_world[3] = glm::vec4(0.0f, 0.0f, kNearPlane, 0.0f);

  const auto plane = [](glm::dvec3 normal, double w) {
    return glm::vec4(glm::vec3(glm::normalize(normal)), static_cast<float>(w));
  };
  view.planes = {plane(forward * tan_x + right, 0.0), plane(forward * tan_x - right, 0.0),
                 plane(forward * tan_y + up, 0.0),    plane(forward * tan_y - up, 0.0),
                 plane(forward, -kNearPlane),         glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)};
  return view;
}

}  // namespace skerry::render
