#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "world/voxel/blocks.h"

namespace skerry::reference {

/// Axis of a face's normal; 3 for a plant's diagonals.
inline int axis_of_face(int face) {
  return face >> 1;
}

/// The program's block textures at full resolution, in linear light.
class BlockTexels {
 public:
  /// Decodes the textures embedded in the program, once.
  static const BlockTexels& shared();

  /// Colour and coverage of the texel at a point of a face [lattice]: sharp texels, as many samples
  /// a pixel average them.
  glm::dvec4 texel(world::BlockId block, int face, glm::dvec3 point) const;
  /// Whether a leaf or plant has something here: coverage, linear between texel centres, of at
  /// least a half. @param point of a plant: in its voxel, 0..1; its texture does not repeat.
  bool covers(world::BlockId block, int face, glm::dvec3 point) const;

 private:
  BlockTexels();
  const glm::vec4& at(std::size_t layer, int x, int y) const {
    return texels_[(layer * edge_ + static_cast<std::size_t>(y & mask_)) * edge_ +
                   static_cast<std::size_t>(x & mask_)];
  }

  std::size_t edge_;
  int mask_;
  std::vector<glm::vec4> texels_;
};

}  // namespace skerry::reference
