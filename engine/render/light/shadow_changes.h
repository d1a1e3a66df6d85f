// What a kept shadow map lacks, as texels.
#pragma once
#include <volk.h>
#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/light/shadow_history.h"
#include "engine/render/scene/geometry_changes.h"

namespace skerry::render {

/// Texels of a map, [low, high) along each axis.
struct TexelBox {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x < high.x && low.y < high.y); }
  bool touches(const TexelBox& other) const {
    return !empty() && !other.empty() && low.x < other.high.x && other.low.x < high.x &&
           low.y < other.high.y && other.low.y < high.y;
  }
  /// The smallest that holds both.
  void add(const TexelBox& other);
  /// No texel if empty.
  VkRect2D rect() const;
};

TexelBox whole_map(const Cascade& cascade);

/// Where a section may show in a cascade's map. Errs on the side of more: by what rounding, the
/// growth of edges and a quarter texel of motion come to.
TexelBox box_of(const shared::Section& section, const IslandPlacement& island,
                const FixedPos& camera, const Cascade& cascade);

/// Places from one anchor as they are from another.
FixedPos rebased(FixedPos origin, const FixedPos& from, const FixedPos& to);

/// The islands that may show in a cascade's map, ascending. Errs on the side of more, so that an
/// island that has moved by less than a texel since cannot show and be missing.
std::shared_ptr<const std::vector<DrawnIsland>> islands_in(const Cascade& cascade,
                                                           const FrameInput& input);

/// How far a point of an island can have moved between two placements from one anchor [blocks], at
/// most. @tparam A, B IslandPlacement or DrawnIsland.
template <class A, class B>
double movement(const A& a, const B& b) {
  glm::dvec3 shift;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    shift[i] = static_cast<double>(b.origin[k] - a.origin[k]) / 65536.0;
  }
  // A rotation by angle t moves a point at distance r by 2 r sin(t / 2); |q - q'| = 2 sin(t / 4)
  // for the nearer of q' and -q'.
  const glm::dquat same = glm::dot(a.rotation, b.rotation) < 0.0 ? -b.rotation : b.rotation;
  const double quarter = 0.5 * glm::length(a.rotation - same);
  return glm::length(shift) + 4.0 * quarter * std::max(a.bounding_radius, b.bounding_radius);
}
/// Whether an island may show in a cascade's map. Errs on the side of yes.
bool may_touch(const IslandPlacement& island, const FixedPos& camera, const Cascade& cascade);

/// How far an island must have moved [texels].
struct MovedBy {
  double more_than = 0.0;
  /// What moved further is another island in its place, which sections tell of that came and went.
  double at_most = std::numeric_limits<double>::infinity();
};

/// The texels in which islands that have moved since may show, before or now. Notes in `map` where
/// these are now. @param last the placements of the last frame. @pre the input has as many islands
/// as the map, or more.
TexelBox moved_islands(DrawnMap& map, const Cascade& cascade, const FrameInput& input,
                       const ShadowHistory& last, const MovedBy& by);
/// The texels in which sections that came or went since may show; none: that is not known. Notes
/// in `map` that it shows them.
std::optional<TexelBox> changed_sections(DrawnMap& map, const Cascade& cascade,
                                         const FrameInput& input, const GeometryChanges& geometry);

}  // namespace skerry::render
