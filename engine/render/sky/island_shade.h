#pragma once
#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"

namespace skerry::render {

/// Which islands may hide the sky from others: those that are near and have land.
std::vector<std::size_t> islands_that_hide(std::span<const IslandPlacement> islands);

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
  IslandShade(std::span<const IslandPlacement> islands, std::span<const std::size_t> hiding,
              std::size_t island, float share);

  /// Whether no other island is near enough to matter.
  bool empty() const { return hiding_.empty(); }
  /// Share of the light from one direction that arrives.
  struct Open {
    std::array<float, 6> face{1.0f, 1.0f, 1.0f,
                              1.0f, 1.0f, 1.0f};  ///< on the side that it looks to
    float all = 1.0f;                             ///< on all of the island
  };
  /// @param direction unit, in the world. None: all of it arrives.
  std::optional<Open> towards(const glm::vec3& direction) const;

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
