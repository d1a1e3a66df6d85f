#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/render/frame/fixed_pos.h"

namespace skerry::render {

/// Distance of the near plane [blocks]; there is no far plane. Reversed floating-point depth keeps
/// its relative precision however near this is. At 175 degrees a wide picture's corners are 47
/// times as far, which must stay below the 0.3 blocks that an eye keeps to walls.
inline constexpr float kNearPlane = 0.005f;

/// A pinhole camera. Axes and angles: docs/conventions.md.
struct Camera {
  FixedPos position{};
  double yaw_deg = 0.0, pitch_deg = 0.0;
  double fov_deg = 70.0;  ///< vertical, 0.1 .. 175
};

/// What the GPU needs of a camera, all relative to its position.
struct CameraView {
  glm::mat4 clip_from_world;
  glm::vec3 right, up, forward;  ///< unit axes
  float tan_half_x = 1.0f, tan_half_y = 1.0f;
  /// Left, right, bottom, top, near and one plane that is always inside: dot(xyz, p) + w >= 0
  /// inside.
  std::array<glm::vec4, 6> planes{};
};

/// @param width, height of the picture [pixels], > 0. Reverse-Z, infinite far plane, y flipped:
/// clip space is Vulkan's.
CameraView view_of(const Camera& camera, std::uint32_t width, std::uint32_t height);

}  // namespace skerry::render
