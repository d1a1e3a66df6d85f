#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/core/result.h"
#include "world/vdb/volume_grid.h"
#include "world/vdb_import/import_options.h"
#include "world/vdb_import/solid_rule.h"
#include "world/vdb_import/volume_field.h"
#include "world/voxel/coords.h"

namespace skerry::world {

/// An affine map.
struct Affine {
  glm::dmat3 linear{1.0};
  glm::dvec3 shift{};

  glm::dvec3 operator()(glm::dvec3 p) const { return linear * p + shift; }
  Affine inverse() const;
};

/// A box in double, both corners included.
struct Bounds {
  glm::dvec3 low, high;
  static Bounds none();
  void add(glm::dvec3 point);
  bool empty() const { return !(low.x <= high.x); }
};
/// The box around a box's image.
Bounds image_of(const Affine& map, const Bounds& box);

/// Blocks of the world from a grid's index space: scale and axes applied.
/// @param blocks_per_unit of the file's world space.
Affine blocks_from_index(const VolumeGrid& grid, double blocks_per_unit, UpAxis up);

/// The edge of the cube that has a voxel's volume, in the file's units.
double voxel_size(const VolumeGrid& grid);

/// The box around what is solid in a grid, in index space; empty if nothing is. Voxels that are
/// cubes count whole; of smooth ones, where the value crosses the threshold on its way out.
Bounds content_of(const VolumeField& field, const SolidRule& rule);

/// Where an island's lattice lies in a grid.
struct Placement {
  Affine index_from_lattice;
  Affine lattice_from_index;
  WorldPos origin;       ///< of the lattice
  double yaw_rad = 0.0;  ///< of the island: a turn about +y is kept, so that voxels stay whole
  bool exact = false;    ///< voxels are cubes of blocks, along the lattice's axes
};

/// The lattice's origin is the corner of a voxel near the middle of the content, so that voxels of
/// one block's size fall on blocks. Errors: beyond the world's edge.
Result<Placement> place(const VolumeGrid& grid, const Bounds& content, double blocks_per_unit,
                        UpAxis up);

}  // namespace skerry::world
