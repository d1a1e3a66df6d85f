// The program skerry_vdb_samples: writes small .vdb files as other programs would, for tests that
// must not link OpenVDB themselves.
//   skerry_vdb_samples FOLDER
#include <openvdb/io/File.h>
#include <openvdb/math/Maps.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::math::Transform;
using UInt8Grid = openvdb::Grid<openvdb::tree::Tree4<std::uint8_t, 5, 4, 3>::Type>;

template <class GridType>
typename GridType::Ptr named(const std::string& name,
                             typename GridType::ValueType background = {}) {
  const auto grid = GridType::create(background);
  grid->setName(name);
  return grid;
}

openvdb::FloatGrid::Ptr fog(const std::string& name) {
  const auto grid = named<openvdb::FloatGrid>(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

/// A ball about (2, -3, 5), its values distances in voxels.
openvdb::FloatGrid::Ptr ball(const std::string& name, double radius) {
  constexpr float kBand = 3.0f;
  const auto grid = named<openvdb::FloatGrid>(name, kBand);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  const int reach = static_cast<int>(radius) + 5;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double distance = std::sqrt(x * x + y * y + z * z) - radius;
        if (std::abs(distance) < kBand)
          grid->tree().setValueOn(Coord(x + 2, y - 3, z + 5), static_cast<float>(distance));
      }
    }
  }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

/// An island as a modeller would shape one, some 50 voxels wide: hills above, a ragged cone below.
/// The file tests/scenes/islet.vdb is this one.
openvdb::FloatGrid::Ptr islet() {
  constexpr float kBand = 1.5f;
  constexpr int kReach = 34, kDepth = 28;
  const auto grid = named<openvdb::FloatGrid>("islet", kBand);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setSaveFloatAsHalf(true);
  for (int x = -kReach; x <= kReach; ++x) {
    for (int z = -kReach; z <= kReach; ++z) {
      const double hill = std::exp(-((x - 7) * (x - 7) + (z + 5) * (z + 5)) / 70.0);
      const double top = 2.0 * std::sin(x * 0.16) + 2.0 * std::cos(z * 0.2) + 14.0 * hill;
      const double radius = std::sqrt(x * x + z * z), angle = std::atan2(z, x);
      for (int y = -kReach; y <= kReach; ++y) {
        const double cone = 23.0 * std::sqrt(std::clamp((y + kDepth) / double(kDepth), 0.0, 1.0));
        const double rags = 2.0 * std::sin(5.0 * angle + y * 0.25) + std::sin(11.0 * angle);
        // Hills and rags stretch distances by up to some 1.8.
        const double side = std::max(radius - cone - rags, double(-kDepth - y));
        const double distance = std::max(y - top, side) / 1.8;
        if (std::abs(distance) < kBand)
          grid->tree().setValueOn(Coord(x, y, z), static_cast<float>(distance));
      }
    }
  }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

/// A wavy cloud with a tile of 128 in it.
openvdb::FloatGrid::Ptr cloud(const std::string& name) {
  const auto grid = fog(name);
  for (int x = -40; x < 0; ++x)
    for (int y = -20; y < 20; ++y)
      for (int z = -30; z < 30; ++z)
        if (const double v = std::sin(x * 0.3) + std::cos(y * 0.2) + std::sin(z * 0.17); v > 0.0)
          grid->tree().setValueOn(Coord(x, y, z), static_cast<float>(v));
  grid->tree().sparseFill(CoordBBox(Coord(128), Coord(255)), 0.75f, true);
  grid->setTransform(Transform::createLinearTransform(0.25));
  return grid;
}

openvdb::GridPtrVec every_type() {
  openvdb::GridPtrVec grids;
  const auto mark = [&grids](const auto& grid, auto value) {
    grid->tree().setValueOn(Coord(1, 2, 3), value);
    grids.push_back(grid);
  };
  mark(named<openvdb::FloatGrid>("plain"), 0.5f);  // of class unknown
  mark(named<openvdb::DoubleGrid>("double"), 0.25);
  mark(named<openvdb::BoolGrid>("bool"), true);
  mark(named<openvdb::Int32Grid>("int32"), 7);
  mark(named<openvdb::Int64Grid>("int64"), std::int64_t{8});
  mark(named<UInt8Grid>("uint8"), std::uint8_t{9});
  mark(named<openvdb::Vec3SGrid>("Cd"), openvdb::Vec3s(1.0f, 0.0f, 0.0f));
  mark(named<openvdb::Vec3SGrid>("vel"), openvdb::Vec3s(1.0f, 2.0f, 3.0f));
  const auto mask = named<openvdb::MaskGrid>("mask");
  mask->tree().setValueOn(Coord(1, 2, 3));
  grids.push_back(mask);
  grids.push_back(openvdb::points::PointDataGrid::create());
  grids.back()->setName("points");
  const auto half = fog("half");
  half->setSaveFloatAsHalf(true);
  mark(half, 1.5f);
  const auto frustum = fog("frustum");
  frustum->setTransform(Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(9.0)), 0.5, 10.0));
  mark(frustum, 1.0f);
  for (int i = 0; i < 3; ++i) mark(fog("density"), 1.0f + static_cast<float>(i));
  return grids;
}

/// As simulations write it: fog, and where its obstacles were, as integers.
openvdb::GridPtrVec smoke_with_obstacles(bool some) {
  const auto obstacles = named<openvdb::Int32Grid>("obstacles");
  if (some) obstacles->tree().setValueOn(Coord(1, 2, 3), 1);
  if (some) obstacles->tree().setValueOn(Coord(1, 2, 4), 1);
  return {obstacles, cloud("density")};
}

openvdb::GridPtrVec wild_values() {
  const auto grid = fog("wild");
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float values[] = {std::nanf(""), kInfinity, -kInfinity, 1e30f, -5.0f, 1.0f};
  for (int i = 0; i < 6; ++i) grid->tree().setValueOn(Coord(i, 0, 0), values[i]);
  grid->tree().addTile(1, Coord(64, 0, 0), std::nanf(""), true);
  const auto doubles = named<openvdb::DoubleGrid>("too_large");
  doubles->tree().setValueOn(Coord(0), 1e300);
  return {grid, doubles};
}

openvdb::GridPtrVec transforms() {
  const auto box = [](const std::string& name) {
    const auto grid = fog(name);
    grid->tree().sparseFill(CoordBBox(Coord(-8, -4, -6), Coord(7, 3, 5)), 1.0f, true);
    return grid;
  };
  const auto stretched = box("stretched");
  stretched->setTransform(Transform::createLinearTransform(0.5));
  stretched->transform().postScale(openvdb::Vec3d(1.0, 2.0, 3.0));
  const auto turned = box("turned");
  turned->transform().postRotate(0.5, openvdb::math::Z_AXIS);
  turned->transform().postTranslate(openvdb::Vec3d(100.0, 200.0, 300.0));
  const auto sheared = box("sheared");
  sheared->transform().postShear(0.5, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
  const auto tiny = box("tiny");
  tiny->setTransform(Transform::createLinearTransform(1e-4));
  return {stretched, turned, sheared, tiny};
}

/// 16 root tiles of 4096^3: 1.1e12 active voxels in less than a kilobyte.
openvdb::GridPtrVec huge_tiles() {
  const auto grid = fog("density");
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 4; ++z)
        grid->tree().addTile(3, Coord(x * 4096, y * 4096, z * 4096), 1.0f, true);
  return {grid};
}

void write(const std::string& path, const openvdb::GridPtrVec& grids) {
  openvdb::io::File file(path);
  file.write(grids);
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "skerry_vdb_samples: use skerry_vdb_samples FOLDER\n");
    return 2;
  }
  openvdb::initialize();
  UInt8Grid::registerGrid();
  const std::string folder = std::string(words[1]) + "/";
  write(folder + "ball.vdb", {ball("ball", 20.0)});
  write(folder + "islet.vdb", {islet()});
  write(folder + "cloud.vdb", {cloud("density")});
  write(folder + "types.vdb", every_type());
  write(folder + "wild.vdb", wild_values());
  write(folder + "no_obstacles.vdb", smoke_with_obstacles(false));
  write(folder + "obstacles.vdb", smoke_with_obstacles(true));
  write(folder + "transforms.vdb", transforms());
  write(folder + "huge.vdb", huge_tiles());
  write(folder + "no_grids.vdb", {});
  write(folder + "empty.vdb", {fog("density")});
  const auto far = named<openvdb::Int32Grid>("ids");
  far->tree().setValueOn(Coord((1 << 30) + 8, 0, 0), 7);
  write(folder + "far.vdb", {far, fog("density")});
  const auto velocity = named<openvdb::Vec3SGrid>("vel");
  velocity->tree().setValueOn(Coord(0), openvdb::Vec3s(1.0f));
  write(folder + "vectors.vdb", {velocity});
  return 0;
}
