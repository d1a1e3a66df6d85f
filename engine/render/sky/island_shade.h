#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"

namespace skerry::render {

/// An island that may hide the sky from others.
struct HidingIsland {
  std::size_t island = 0;  ///< index
  float reach = 0.0f;      ///< that it counts for, to the middle of another's land [blocks]
};

/// All of them: those that are near and have land.
std::vector<HidingIsland> islands_that_hide(std::span<const IslandPlacement> islands);

/// How much of its shade an island has: less of it and then none as it gets small in the picture.
float share_of_shade(const IslandPlacement& island, const FixedPos& eye);

/// How much light other islands let past to an island, as a mean over its land. What they hide is a
/// smooth function of where all of them are, so that islands that turn or pass change each other's
/// light without a step. Islands count by their ellipsoids (IslandLand), those that are small from
/// here not at all. docs/decisions/0060-islands-in-each-others-sky.md.
class IslandShade {
 public:
  /// @param hiding of islands_that_hide(). @param island index of the one that is shaded; far ones
  /// neither shade nor are shaded. @param share of what they hide, see share_of_shade().
  IslandShade(std::span<const IslandPlacement> islands, std::span<const HidingIsland> hiding,
              std::size_t island, float share);

  /// Whether no other island is near enough to matter.
  bool empty() const { return hiding_.empty(); }
  /// Share of the light from one direction that arrives.
  struct Open {
    std::array<float, 6> face{1.0f, 1.0f, 1.0f,
                              1.0f, 1.0f, 1.0f};  ///< on the side that it looks to
    float all = 1.0f;                             ///< on all of the island
  };
  /// @param direction unit, in the world. @param near of near(). None: all of it arrives.
  std::optional<Open> towards(const glm::vec3& direction, std::uint32_t near = ~0u) const;

  static constexpr std::size_t kDirections = 256;
  /// Side by side, for vectors of them.
  struct Directions {
    std::array<float, kDirections> x, y, z;
    void set(std::size_t i, const glm::vec3& d) { x[i] = d.x, y[i] = d.y, z[i] = d.z; }
    glm::vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  };
  using Near = std::array<std::uint32_t, kDirections>;
  /// Which islands may hide each direction, a bit each; the last bit stands for all from there on.
  Near near(const Directions& directions) const;

 private:
  static constexpr std::size_t kPlaces = 8;
  /// Another island, and places of this one, where the other is a ball of radius 1.
  struct Hiding {
    glm::mat3 ball_from_world{1.0f};
    std::array<float, kPlaces> x{}, y{}, z{}, distance2{};  ///< of the places, from its middle
    std::array<float, kPlaces> weight{};                    ///< 0: the place is within it
    glm::vec3 to_middle{0.0f};                              ///< unit, in the world
    float cosine = -1.0f;  ///< beyond this angle to it nothing is hidden
  };
  std::vector<Hiding> hiding_;
};

}  // namespace skerry::render
