#pragma once
#include <array>
#include <cstdint>

namespace skerry::render {

/// A place in the world, units of 1/65536 block (world::WorldPos without the dependency). |each| <=
/// 2^57.
using FixedPos = std::array<std::int64_t, 3>;

}  // namespace skerry::render
