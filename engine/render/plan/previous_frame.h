#pragma once
#include "engine/render/frame/camera.h"
#include "engine/render/frame/fixed_pos.h"
#include "engine/render/light/shadow_history.h"

namespace skerry::render {

/// Where the camera and the islands were, for what is compared between frames.
struct PreviousFrame {
  Camera camera;
  FixedPos anchor{};
  SharedIslands islands;  ///< never null
};

}  // namespace skerry::render
