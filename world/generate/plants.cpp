#include "world/generate/plants.h"

#include <algorithm>
#include <set>

#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

bool is_glowing_plant(BlockId id) {
  return block_kind(id) == BlockKind::kPlant && block_types()[id].emission > 0.0f;
}

class GlowingPlants {
 public:
  GlowingPlants(const IslandPlan& plan, const Canvas& canvas)
      : plan_(plan), canvas_(canvas), many_(1 << 2 * canvas.level) {}

  void draw_stamps() {
    std::set<IVec3> taken;  // some stamps are at one place
    for (const Stamp& stamp : plan_.stamps) {
      const IVec3 at{stamp.x >> canvas_.level, stamp.y >> canvas_.level, stamp.z >> canvas_.level};
      if (is_glowing_plant(stamp.id) && is_inside(at) &&
          taken.insert({stamp.x, stamp.y, stamp.z}).second)
        add(at, stamp.id, 1);
    }
  }

  void draw_on_ground() {
    if (std::ranges::none_of(plan_.biome().plants, [](const PlantChance& plant) {
          return plant.of_256 != 0 && is_glowing_plant(plant.id);
        }))
      return;
    const int reach = ((plan_.columns.half - 1) >> canvas_.level) + 1;  // voxels
    const auto first = [reach](int from) { return std::max(from + 1, -reach); };
    const auto end = [reach](int from) { return std::min(from + 1 + kChunkEdge, reach); };
    for (int x = first(canvas_.x0); x < end(canvas_.x0); ++x)
      for (int z = first(canvas_.z0); z < end(canvas_.z0); ++z) look_at_columns(x, z);
  }

 private:
  /// Whether a voxel is the chunk's own.
  bool is_inside(IVec3 at) const {
    const auto inside = [](int v, int low) { return v > low && v <= low + kChunkEdge; };
    return inside(at.x, canvas_.x0) && inside(at.y, canvas_.y0) && inside(at.z, canvas_.z0);
  }

  /// Those on the blocks of a column of voxels.
  void look_at_columns(int x, int z) {
    const Columns& columns = plan_.columns;
    const int edge = 1 << canvas_.level;
    const int low = (canvas_.y0 + 1) * edge, end = low + kChunkEdge * edge;
    const auto block = [&](int voxel) {
      return std::clamp(voxel * edge, -columns.half, columns.half);
    };
    int count = 0;
    IVec3 last{};
    BlockId id = kAir;
    for (int bx = block(x); bx < block(x + 1); ++bx) {
      for (int bz = block(z); bz < block(z + 1); ++bz) {
        const std::size_t c = columns.index(bx, bz);
        const int top = columns.top[c];
        if (top < low || top >= end || columns.water[c] > top) continue;
        const auto skin = static_cast<std::size_t>(columns.skins[c]);
        const BlockId plant = plant_on(plan_, kSkins[skin].top, bx, bz);
        if (!is_glowing_plant(plant) || (columns.ragged[c] > 0 && !is_open_ground(bx, top, bz)))
          continue;
        ++count;
        last = {x, top >> canvas_.level, z};
        id = plant;
      }
    }
    if (count != 0) add(last, id, count);
  }
  /// Where rock is shifted sideways, ground may have moved away.
  bool is_open_ground(int x, int y, int z) const {
    return plan_.solid_at(x, y - 1, z) && !plan_.solid_at(x, y, z);
  }

  /// Shows one plant out of each `many_`, drawn by lot, so that there are no rows.
  void add(IVec3 at, BlockId id, int count) {
    seen_ += count;
    if (seen_ <= next_) return;
    BlockId* voxel = find_open(at);
    if (voxel == nullptr) return;
    *voxel = id;
    ++shown_;
    next_ = drawn_of_next();
  }

  int drawn_of_next() const {
    const std::uint32_t lot = hash3(plan_.shape.seed + 802, canvas_.x0, canvas_.y0, canvas_.z0);
    return shown_ * many_ + static_cast<int>(mix32(lot + static_cast<std::uint32_t>(shown_)) %
                                             static_cast<std::uint32_t>(many_));
  }

  /// Air on ground, at a place or close above or below it.
  BlockId* find_open(IVec3 at) const {
    constexpr int kSteps = 2;
    const auto is_ground = [this, at](int y) {
      const BlockId* voxel = canvas_.find(at.x, y, at.z);
      return voxel != nullptr && block_kind(*voxel) == BlockKind::kOpaque;
    };
    for (int step = 0; step <= kSteps; ++step)
      for (const int y : {at.y + step, at.y - step}) {
        BlockId* voxel = canvas_.find(at.x, y, at.z);
        if (voxel != nullptr && *voxel == kAir && is_inside({at.x, y, at.z}) && is_ground(y - 1))
          return voxel;
      }
    return nullptr;
  }

  const IslandPlan& plan_;
  const Canvas& canvas_;
  const int many_;  // plants that a voxel stands for
  int seen_ = 0, shown_ = 0;
  int next_ = drawn_of_next();  // how many are seen before the next one is shown
};

}  // namespace

BlockId plant_on(const IslandPlan& plan, BlockId ground, int x, int z) {
  if (ground != block::kGrass && ground != block::kDryGrass && ground != block::kMycelium &&
      ground != block::kRedSand)
    return kAir;
  int roll = static_cast<int>(hash2(plan.shape.seed + 801, x, z) >> 24);
  for (const PlantChance& plant : plan.biome().plants) {
    if (roll < plant.of_256) return plant.id;
    roll -= plant.of_256;
  }
  return kAir;
}

void draw_glowing_plants(const IslandPlan& plan, const Canvas& canvas) {
  GlowingPlants plants(plan, canvas);
  plants.draw_stamps();
  plants.draw_on_ground();
}

}  // namespace skerry::world
