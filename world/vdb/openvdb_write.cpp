#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <exception>

#include "world/vdb/openvdb_jobs.h"

namespace skerry::world {
namespace {

openvdb::math::Transform::Ptr transform_of(const glm::dmat4& m) {
  openvdb::Mat4d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = m[row][column];
  return openvdb::math::Transform::createLinearTransform(matrix);
}

template <class GridType>
openvdb::GridBase::Ptr grid_of(const VolumeGrid& volume) {
  using Value = typename GridType::ValueType;
  // By OpenVDB's registry: where a grid is constructed, the compiler needs all that grids can do.
  const auto grid =
      openvdb::gridPtrCast<GridType>(openvdb::GridBase::createGrid(GridType::gridType()));
  auto& tree = grid->tree();
  tree.root().setBackground(static_cast<Value>(volume.background), /*updateChildNodes=*/false);
  for (const VolumeTile& tile : volume.tiles) {
    const openvdb::Coord low(tile.origin.x, tile.origin.y, tile.origin.z);
    const openvdb::CoordBBox box = openvdb::CoordBBox::createCube(low, tile.edge);
    tree.sparseFill(box, static_cast<Value>(tile.value), true);
  }
  for (const VolumeBrick& brick : volume.bricks) {
    const openvdb::Coord low(brick.origin.x, brick.origin.y, brick.origin.z);
    auto* leaf = tree.touchLeaf(low);
    for (openvdb::Index i = 0; i < brick.values.size(); ++i)
      if (brick.values[i] != volume.background)
        leaf->setValueOn(i, static_cast<Value>(brick.values[i]));
  }
  tree.prune();
  return grid;
}

openvdb::GridBase::Ptr typed_grid_of(const VolumeGrid& volume) {
  openvdb::GridBase::Ptr grid;
  if (volume.kind == VolumeKind::kIds) {
    grid = grid_of<openvdb::Int32Grid>(volume);
  } else if (volume.kind == VolumeKind::kMask) {
    grid = grid_of<openvdb::BoolGrid>(volume);
  } else {
    grid = grid_of<openvdb::FloatGrid>(volume);
  }
  if (volume.kind == VolumeKind::kFog) grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  if (volume.kind == VolumeKind::kLevelSet) grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setName(volume.name);
  grid->setCreator("Skerry");
  grid->setTransform(transform_of(volume.world_from_index));
  return grid;
}

}  // namespace

Result<void> write_openvdb(const std::vector<VolumeGrid>& volumes,
                           const std::filesystem::path& path) {
  openvdb::initialize();
  openvdb::GridCPtrVec grids;
  for (const VolumeGrid& volume : volumes) grids.push_back(typed_grid_of(volume));
  openvdb::io::File file(path.string());
  file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
  file.write(grids);
  file.close();
  return {};
}

}  // namespace skerry::world
