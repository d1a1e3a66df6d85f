#pragma once
#include <glm/vec2.hpp>

#include "game/input/controls.h"
#include "game/scene_file/parse.h"

namespace skerry::game {

/// A camera that flies freely, through anything, while the world stands still.
class PhotoCamera {
 public:
  const CameraPlace& place() const { return place_; }
  void start_at(const CameraPlace& place) { place_ = place; }
  /// @param actions move and look as in play.
  void advance(const LookInput& input, double fov_deg);

 private:
  CameraPlace place_;
};

}  // namespace skerry::game
