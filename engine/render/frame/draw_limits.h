#pragma once
#include <array>
#include <cstdint>

#include "shaders/shared/frame.h"

namespace skerry::render {

/// Most indirect draws that each list of a view can need: opaque, cut-out, translucent.
using DrawLimits = std::array<std::uint32_t, shared::kListCount>;

}  // namespace skerry::render
