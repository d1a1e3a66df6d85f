#pragma once

namespace skerry::world {

/// Which values of a grid are inside.
struct SolidRule {
  bool below = false;  ///< inside is below the threshold (distances) rather than from it on
  float threshold = 0.5f;
  bool nearest = false;  ///< voxels are cubes (masks, ids) rather than samples of something smooth

  bool operator()(float value) const { return below ? value < threshold : value >= threshold; }
};

}  // namespace skerry::world
