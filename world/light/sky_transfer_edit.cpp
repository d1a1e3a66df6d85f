// SkyTransfer after edits: what they change is followed from the voxels to the records.
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>
#include <utility>

#include "engine/core/check.h"
#include "world/light/base/face_changes.h"
#include "world/light/sky_transfer.h"
#include "world/voxel/blocks.h"
#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

// Beyond, an island is looked at as a whole.
constexpr std::size_t kMostVoxels = 2048;

bool same_lamp(const WeakLamp& a, const WeakLamp& b) {
  return a.place == b.place && a.intensity == b.intensity && a.range == b.range;
}

/// Of a lamp whose light reaches a voxel: whether the line between them can touch another voxel.
bool may_touch(IVec3 from, const glm::vec3& to, IVec3 other) {
  constexpr float kNear = 1.0f;  // more than half of a voxel's diagonal
  const auto middle = [](IVec3 v) {
    return glm::vec3(static_cast<float>(v.x) + 0.5f, static_cast<float>(v.y) + 0.5f,
                     static_cast<float>(v.z) + 0.5f);
  };
  const glm::vec3 a = middle(from), way = to - a, p = middle(other) - a;
  const float length2 = glm::dot(way, way);
  const float t = length2 > 0.0f ? glm::clamp(glm::dot(p, way) / length2, 0.0f, 1.0f) : 0.0f;
  const glm::vec3 off = p - t * way;
  return glm::dot(off, off) <= kNear * kNear;
}

}  // namespace

class SkyTransfer::Edit {
 public:
  Edit(SkyTransfer& of, LightChunks chunks)
      : of_(of), before_(std::exchange(of.chunks_, std::move(chunks))) {}

  bool run() {
    if (of_.bounces_ && of_.bounces_->is_worn()) return false;
    if (of_.seen_.empty()) return false;
    find_chunks();
    const bool had_glass = of_.tints_.any();
    if (!take_chunks() || !want_voxels()) return false;
    if (had_glass && !of_.tints_.any()) return false;  // records are of other sizes
    take_faces();
    look_again();
    look_through_openings();
    spread_again();
    if (of_.bounces_)
      for (const BounceLight::Changed& face :
           of_.bounces_->follow_changes(of_.seen_, of_.all_lamps_))
        redo_about(face.front, face.direction);
    redo_records();
    return true;
  }

 private:
  struct Face {
    IVec3 front{};
    DrawnFace drawn{};  // voxel from the lattice's origin
    std::uint16_t block = 0;
  };

  /// Voxels whose view is kept, each once, in the order of their coming.
  struct Kept {
    Marked numbers;
    std::vector<IVec3> voxels;
    bool add(const VoxelIndex& index, IVec3 voxel) {
      const bool is_new =
          index.has(voxel) && numbers.add(static_cast<std::uint32_t>(index.of(voxel)));
      if (is_new) voxels.push_back(voxel);
      return is_new;
    }
  };

  static const LightChunk& chunk_of(const LightChunks& chunks, IVec3 at) {
    static const LightChunk kEmpty{};
    const auto found = chunks.find(at);
    return found == chunks.end() ? kEmpty : *found->second;
  }

  /// Which chunks have changed, come or gone.
  void find_chunks() {
    for (const auto& [at, chunk] : of_.chunks_) {
      const auto old = before_.find(at);
      if (old == before_.end() || old->second != chunk) edited_.push_back(at);
    }
    for (const auto& [at, chunk] : before_)
      if (!of_.chunks_.contains(at)) edited_.push_back(at);
  }

  /// Takes in the voxels of edited chunks, and which of their faces have come and gone.
  bool take_chunks() {
    std::set<IVec3> changed;
    for (const IVec3& at : edited_) {
      const LightChunk &before = chunk_of(before_, at), &now = chunk_of(of_.chunks_, at);
      const FaceChanges faces = face_changes(before.quads, now.quads);
      for (const auto& [from, to] :
           {std::pair{&faces.came, &came_}, {&faces.went, &went_}, {&faces.turned, &turned_}})
        for (const auto& [drawn, block] : *from) {
          DrawnFace face = drawn;
          face.voxel = corner_of(at) + face.voxel;
          to->push_back({face.voxel + to_front(face), face, block});
        }
      const std::optional<std::vector<IVec3>> voxels = take_chunk(of_.air_, at, before, now, faces);
      if (!voxels) return false;
      if (!faces.came.empty() || !faces.went.empty()) reshaped_.push_back(at);
      changed.insert(voxels->begin(), voxels->end());
      if (changed.size() > kMostVoxels) return false;
    }
    voxels_.assign(changed.begin(), changed.end());
    for (const IVec3& voxel : voxels_) of_.lines_.changed(voxel);
    return true;
  }

  /// Numbers the voxels that are air now and those about faces that have come.
  bool want_voxels() {
    for (const IVec3& voxel : voxels_) {
      const bool opaque = of_.air_.opaque.at(voxel);
      if (opaque && of_.wanted_.has(voxel)) let_go(voxel);
      if (!opaque && !want(voxel)) return false;
    }
    for (const Face& face : came_) {
      const FaceAxes axes(face.drawn.direction);
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c)
          if (!want(face.front + axis_vector(axes.b, b) + axis_vector(axes.c, c))) return false;
    }
    return true;
  }

  void move(std::span<const VoxelIndex::Moved> moved) {
    of_.seen_.resize(of_.wanted_.size());
    for (const VoxelIndex::Moved& m : moved) {
      of_.seen_.move(m.from, m.to);
      of_.lamp_light_.move(m.from, m.to);
      of_.all_lamps_.move(m.from, m.to);
      of_.tints_.move(m.from, m.to);
    }
    if (of_.bounces_) of_.bounces_->move_voxels(moved);
  }

  bool want(IVec3 voxel) {
    if (of_.wanted_.has(voxel) || of_.air_.opaque.at(voxel)) return true;
    if (!of_.lines_.inside(voxel)) return false;
    move(of_.wanted_.add(voxel));
    const std::size_t number = of_.wanted_.of(voxel);
    of_.seen_.forget(number);
    of_.tints_.forget(number);
    if (of_.bounces_) of_.bounces_->forget_voxel(number);
    wanted_.push_back(voxel);
    return of_.wanted_.size() <= of_.most_numbers_;
  }

  void let_go(IVec3 voxel) {
    const std::size_t number = of_.wanted_.of(voxel);
    of_.lamp_light_.set(number, {});
    of_.all_lamps_.set(number, {});
    of_.tints_.forget(number);
    of_.openings_.forget(voxel);
    gone_.push_back(voxel);
    if (of_.bounces_)
      for (int direction = 0; direction < 6; ++direction)
        for (const bool plant : {false, true}) of_.bounces_->remove_face(voxel, direction, plant);
    move(of_.wanted_.remove(voxel));
  }

  /// Where an edit may change how deep faces lie under water, and whether it surely does.
  void take_water() {
    bool surfaces = false;
    std::vector<IVec3> voxels = voxels_;
    for (const std::vector<Face>* faces : {&came_, &went_, &turned_})
      for (const Face& face : *faces) {
        if (face.drawn.direction / 2 != 1) continue;
        surfaces |= block_types()[face.block].liquid;
        if (faces == &turned_) voxels.push_back(face.drawn.voxel);
      }
    if (of_.bounces_->moves_water(voxels, surfaces)) of_.bounces_->take_water(of_.chunks_);
  }

  void take_faces() {
    if (of_.bounces_) take_water();
    if (of_.bounces_)
      for (const Face& face : went_)
        of_.bounces_->remove_face(face.front, face.drawn.direction, face.drawn.plant);
    if (of_.bounces_)
      for (const std::vector<Face>* faces : {&came_, &turned_})
        for (const Face& face : *faces)
          if (of_.bounces_->set_face(face.front, face.drawn.direction, face.block,
                                     face.drawn.plant))
            fronts_.add(of_.wanted_, face.front);
    for (const std::vector<Face>* faces : {&came_, &went_})
      for (const Face& face : *faces) redo_about(face.front, face.drawn.direction);
    // Lines end at faces: where one comes or goes and no voxel does, all those to its voxel.
    if (!of_.bounces_) return;
    const std::set<IVec3> changed(voxels_.begin(), voxels_.end());
    // Where a voxel comes before a face and hides it without stopping each line (leaves beside
    // leaves), those that begin in it still end there.
    for (const Face& face : went_)
      if (!face.drawn.plant && changed.contains(face.front)) fronts_.add(of_.wanted_, face.front);
    std::set<IVec3> behind;
    for (const std::vector<Face>* faces : {&came_, &went_})
      for (const Face& face : *faces)
        if (!face.drawn.plant && !changed.contains(face.drawn.voxel) &&
            !changed.contains(face.front))
          behind.insert(face.drawn.voxel);
    through_.assign(behind.begin(), behind.end());
  }

  /// Along all lines from new voxels, and along those from others that changed ones are on.
  void look_again() {
    for (const IVec3& voxel : wanted_) {
      if (!of_.wanted_.has(voxel)) continue;
      const std::size_t number = of_.wanted_.of(voxel);
      for (std::size_t way = 0; way < LatticeLines::kWays; ++way)
        if (!of_.lines_.end_of(voxel, way))
          of_.seen_.of(number, way / shared::kSkyPatternCount) |=
              static_cast<std::uint16_t>(1u << way % shared::kSkyPatternCount);
      tint_from(voxel);
      changed_at(voxel);
    }
    for (const IVec3& voxel : voxels_) {
      redo_around(voxel);  // whether it is air
      look_through(voxel);
      if (of_.wanted_.has(voxel)) tint_from(voxel);  // whether it is glass
    }
    for (const IVec3& voxel : through_) look_through(voxel);
    if (!of_.bounces_) return;
    for (const IVec3& voxel : voxels_) of_.bounces_->shade_behind(voxel);
    for (const IVec3& voxel : wanted_) fronts_.add(of_.wanted_, voxel);
    for (const IVec3& front : fronts_.voxels) of_.bounces_->look_from(front, of_.seen_);
  }

  /// All lines that pass a voxel, from there backwards: what lies beyond it has not changed by it,
  /// and whoever sees to the same place sees the same.
  void look_through(IVec3 voxel) {
    for (std::size_t number = 0; number < LatticeLines::kWays; ++number) {
      const LatticeLines::Way& way = of_.lines_.way(number);
      const IVec3 back{-way.vector.x, -way.vector.y, -way.vector.z};
      for (const LatticeLines::Passed& passed : way.passed) {
        IVec3 from{voxel.x - passed.offset.x, voxel.y - passed.offset.y, voxel.z - passed.offset.z};
        if (!of_.lines_.inside(from)) continue;
        std::optional<Ending> ending;
        std::optional<GlassTints::Depth> glass;
        do {
          if (glass) *glass += of_.tints_.depth_of_step(from, number);
          if (of_.wanted_.has(from)) {
            if (!ending) ending = ending_of(from, number);
            set_line(from, number, *ending);
            if (of_.tints_.any() && !glass) glass = of_.tints_.depth_from(from, number);
            if (glass) set_tint(from, number, *glass);
          }
          from = from + back;
        } while (of_.lines_.inside(from) && !of_.lines_.stopped(from, number));
      }
    }
  }

  /// Rays through openings, and where they are asked.
  void look_through_openings() {
    if (!of_.ways_.has_origins()) {
      of_.ways_.begin_origins();
      of_.openings_.add_origins();
      if (of_.bounces_) of_.bounces_->add_origins();
    }
    for (const IVec3& voxel : voxels_)
      if (!of_.air_.opaque.at(voxel)) of_.ways_.opened(voxel);
    for (const IVec3& voxel : voxels_) {
      of_.openings_.changed_from(voxel);
      of_.ways_.for_each_through(voxel, [&](IVec3 front, int face, std::size_t ray) {
        of_.openings_.changed(front, face, ray);
        if (of_.bounces_) of_.bounces_->follow_ray(front, face, ray);
      });
    }
    if (of_.bounces_) {
      for (const IVec3& voxel : lit_.voxels) of_.bounces_->choose_rays(voxel, of_.seen_);
      if (of_.tints_.any())  // glass where rays begin
        for (const IVec3& voxel : voxels_)
          if (of_.wanted_.has(voxel)) of_.bounces_->look_from(voxel, of_.seen_);
      for (const IVec3& voxel : through_)
        of_.ways_.for_each_through(voxel, [&](IVec3 front, int face, std::size_t ray) {
          of_.bounces_->follow_ray(front, face, ray);
        });
    }
    for (const OpeningRays::Face& face : of_.openings_.follow_changed())
      redo_about(face.front, face.face);
    Kept near;  // where rays may be asked from now on, or no longer
    const auto retake = [&](IVec3 voxel) {
      if (!of_.openings_.retake_lit(voxel)) return;
      for (int y = -OpeningRays::kNear; y <= OpeningRays::kNear; ++y)
        for (int x = -OpeningRays::kNear; x <= OpeningRays::kNear; ++x)
          for (int z = -OpeningRays::kNear; z <= OpeningRays::kNear; ++z)
            near.add(of_.wanted_, voxel + IVec3{x, y, z});
    };
    for (const IVec3& voxel : lit_.voxels) retake(voxel);
    for (const IVec3& voxel : gone_) retake(voxel);
    for (const IVec3& voxel : voxels_)
      for (int face = 0; face < 6; ++face) retake(voxel + to_front({{}, face, false}));
    for (const IVec3& voxel : near.voxels) redo_around(voxel);
  }

  struct Ending {
    bool sky = false;
    BounceLight::Source source = BounceLight::kNothing;
  };
  Ending ending_of(IVec3 from, std::size_t way) {
    const std::optional<IVec3> last = of_.lines_.end_of(from, way);
    if (!last) return {true, BounceLight::kNothing};
    return {false, of_.bounces_ ? of_.bounces_->source_at(*last, way) : BounceLight::kNothing};
  }

  void set_line(IVec3 voxel, std::size_t way, const Ending& ending) {
    std::uint16_t& seen = of_.seen_.of(of_.wanted_.of(voxel), way / shared::kSkyPatternCount);
    const auto bit = static_cast<std::uint16_t>(1u << way % shared::kSkyPatternCount);
    const std::uint16_t now = static_cast<std::uint16_t>(ending.sky ? seen | bit : seen & ~bit);
    if (std::exchange(seen, now) != now) changed_at(voxel);
    if (of_.bounces_) of_.bounces_->set_line(voxel, way, ending.source);
  }

  void set_tint(IVec3 voxel, std::size_t way, const GlassTints::Depth& depth) {
    if (!of_.tints_.set(voxel, way, depth)) return;
    changed_at(voxel);
    if (of_.bounces_) of_.bounces_->retint(voxel);
  }
  /// Along all lines of a voxel.
  void tint_from(IVec3 voxel) {
    if (!of_.tints_.any()) return;
    for (std::size_t way = 0; way < LatticeLines::kWays; ++way)
      set_tint(voxel, way, of_.tints_.depth_from(voxel, way));
  }

  /// A voxel's direct light, or what it sees of the sky, has changed.
  void changed_at(IVec3 voxel) {
    if (!lit_.add(of_.wanted_, voxel)) return;
    redo_around(voxel);
    if (of_.bounces_) of_.bounces_->relight(voxel);
  }

  /// Sums of lamps' light at the voxels where a lamp has come or gone, or an edit is on the way.
  void spread_again() {
    std::vector<Lamp> all;
    for (const auto& [at, chunk] : of_.chunks_)
      for (const Lamp& lamp : lamps_of(*chunk, at))
        if (lamp.weak || of_.bounces_) all.push_back(lamp);
    Kept relit;
    for (const IVec3& voxel : wanted_) relit.add(of_.wanted_, voxel);
    for (const IVec3& at : edited_) find_relit(at, relit);
    for (const Lamp& lamp : all) find_relit(lamp, relit);
    if (relit.voxels.empty()) return;
    glm::vec3 low(1e9f), high(-1e9f);  // of their middles
    for (const IVec3& voxel : relit.voxels) {
      const glm::vec3 middle = glm::vec3(vector_of(voxel)) + 0.5f;
      low = glm::min(low, middle), high = glm::max(high, middle);
    }
    std::erase_if(all, [&](const Lamp& lamp) {
      const glm::vec3 off = glm::clamp(lamp.lamp.place, low, high) - lamp.lamp.place;
      return glm::dot(off, off) >= lamp.within * lamp.within;
    });
    for (const IVec3& voxel : relit.voxels) {
      LampLight weak{}, strong{};
      for (const Lamp& lamp : all) {
        if (!lamp.reaches(voxel)) continue;
        (lamp.weak ? weak : strong) += light_of_lamp(of_.air_, lamp.lamp, voxel);
      }
      strong += weak;
      const std::size_t number = of_.wanted_.of(voxel);
      const bool is_new = of_.lamp_light_.set(number, weak);
      if ((of_.bounces_ && of_.all_lamps_.set(number, strong)) || is_new) changed_at(voxel);
    }
  }

  /// Where lamps of a chunk that have come, gone or another place in the order of sums reach.
  void find_relit(IVec3 at, Kept& relit) const {
    std::vector<Lamp> old = lamps_of(chunk_of(before_, at), at),
                      now = lamps_of(chunk_of(of_.chunks_, at), at);
    const auto same = [](const Lamp& a, const Lamp& b) {
      return a.weak == b.weak && same_lamp(a.lamp, b.lamp);
    };
    const auto start = std::ranges::mismatch(old, now, same);
    old.erase(old.begin(), start.in1);
    now.erase(now.begin(), start.in2);
    while (!old.empty() && !now.empty() && same(old.back(), now.back()))
      old.pop_back(), now.pop_back();
    for (const std::vector<Lamp>* lamps : {&old, &now})
      for (const Lamp& lamp : *lamps)
        if (lamp.weak || of_.bounces_)
          of_.for_each_reached(lamp, [&](IVec3 voxel) { relit.add(of_.wanted_, voxel); });
  }

  /// Where a lamp's light passes a voxel that has changed.
  void find_relit(const Lamp& lamp, Kept& relit) const {
    std::vector<IVec3> near;
    glm::vec3 low(1e9f), high(-1e9f);  // of all that lies behind them
    for (const IVec3& voxel : voxels_) {
      if (!Lamp{lamp.lamp, lamp.within + 1.0f, lamp.weak}.reaches(voxel)) continue;
      near.push_back(voxel);
      const Cone cone = behind(voxel, lamp);
      low = glm::min(low, cone.low);
      high = glm::max(high, cone.high);
    }
    if (near.empty()) return;
    of_.for_each_reached(
        lamp,
        [&](IVec3 voxel) {
          if (std::ranges::any_of(
                  near, [&](IVec3 other) { return may_touch(voxel, lamp.lamp.place, other); }))
            relit.add(of_.wanted_, voxel);
        },
        low, high);
  }

  /// A box about all middles of voxels within a lamp's reach from which the line to it comes within
  /// a block of a voxel's middle.
  struct Cone {
    glm::vec3 low, high;
  };
  static Cone behind(IVec3 voxel, const Lamp& lamp) {
    constexpr float kNear = 1.0f;
    const glm::vec3 way =
        glm::vec3(static_cast<float>(voxel.x) + 0.5f, static_cast<float>(voxel.y) + 0.5f,
                  static_cast<float>(voxel.z) + 0.5f) -
        lamp.lamp.place;
    const float distance = std::sqrt(glm::dot(way, way));
    if (distance < 2.0f * kNear)
      return {lamp.lamp.place - lamp.within, lamp.lamp.place + lamp.within};
    // Such a line passes lamp + way + off; its voxel lies there or up to so many times as far.
    const float times = lamp.within / (distance - kNear);
    const glm::vec3 from = way - kNear, to = way + kNear;
    return {lamp.lamp.place + glm::min(from, from * std::max(times, 1.0f)) - 1.0f,
            lamp.lamp.place + glm::max(to, to * std::max(times, 1.0f)) + 1.0f};
  }

  // --- Records ---

  /// The record of a face before a voxel whose view is kept.
  void redo(std::size_t number, IVec3 front, int direction) {
    if (redo_marks_.add(static_cast<std::uint32_t>(number * 6) +
                        static_cast<std::uint32_t>(direction)))
      redo_.push_back({front, direction});
  }
  std::uint32_t faces_before(std::size_t number) const {
    return of_.bounces_ ? of_.bounces_->faces_before(number) : 63u;
  }
  /// The records of faces whose corners a face of that direction is at.
  void redo_about(IVec3 front, int direction) {
    const FaceAxes axes(direction);
    for (int b = -1; b <= 1; ++b)
      for (int c = -1; c <= 1; ++c) {
        const IVec3 at = front + axis_vector(axes.b, b) + axis_vector(axes.c, c);
        if (!of_.wanted_.has(at)) continue;
        const std::size_t number = of_.wanted_.of(at);
        if ((faces_before(number) >> direction & 1u) != 0) redo(number, at, direction);
      }
  }
  /// Of all directions.
  void redo_around(IVec3 voxel) {
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        for (int z = -1; z <= 1; ++z) {
          const IVec3 at = voxel + IVec3{x, y, z};
          // A face's plane holds those that are not off along its axis.
          const std::uint32_t planes =
              (x == 0 ? 3u : 0u) | (y == 0 ? 12u : 0u) | (z == 0 ? 48u : 0u);
          if (planes == 0 || !of_.wanted_.has(at)) continue;
          const std::size_t number = of_.wanted_.of(at);
          const std::uint32_t faces = faces_before(number) & planes;
          for (std::uint32_t left = faces; left != 0; left &= left - 1)
            redo(number, at, std::countr_zero(left));
        }
  }

  void redo_records() {
    for (const IVec3& at : reshaped_) repack(at);
    std::map<IVec3, std::vector<std::pair<IVec3, int>>> by_chunk;  // voxel and direction
    const auto add = [&](IVec3 voxel, int direction) {
      const auto chunk = [](int v) { return static_cast<int>(floor_div(v, kChunkEdge)); };
      by_chunk[{chunk(voxel.x), chunk(voxel.y), chunk(voxel.z)}].emplace_back(voxel, direction);
    };
    for (const auto& [front, direction] : redo_) {
      const FaceAxes axes(direction);
      add(front + axis_vector(axes.own, -axes.sign), direction);
      if (direction == 2) add(front, direction);  // a plant
    }
    for (const auto& [at, faces] : by_chunk) {
      const auto known = of_.skies_.find(at);
      if (known == of_.skies_.end()) continue;
      std::shared_ptr<ChunkSky> sky = fresh_[at];  // else made when the first record differs
      for (const auto& [voxel, direction] : faces)
        redo_record(at, voxel, direction, *known->second, sky);
      if (sky) known->second = std::move(sky);
    }
    if (!of_.tints_.any()) return;
    for (const IVec3& at : reshaped_) by_chunk[at];
    for (const auto& [at, faces] : by_chunk) {
      const auto known = of_.skies_.find(at);
      if (known == of_.skies_.end() || !known->second->parts.tinted) continue;
      ChunkSky narrow = with_tints(*known->second);
      if (!narrow.parts.tinted) known->second = std::make_shared<const ChunkSky>(std::move(narrow));
    }
  }

  static std::span<const glm::uvec4> record_of(const ChunkSky& sky, std::size_t at,
                                               std::size_t texels) {
    return std::span(sky.texels).subspan(at, texels);
  }
  void redo_record(IVec3 at, IVec3 voxel, int direction, const ChunkSky& known,
                   std::shared_ptr<ChunkSky>& sky) {
    const IVec3 corner = corner_of(at);
    const IVec3 local{voxel.x - corner.x, voxel.y - corner.y, voxel.z - corner.z};
    std::optional<std::size_t> record = find_record(known, local, direction);
    if (!record) return;
    const bool plant = direction == 2 && of_.air_.has_leaves && of_.air_.plants.at(voxel);
    texels_.clear();
    of_.append_record(voxel + to_front({local, direction, plant}), direction, plant, texels_);
    const ChunkSky& now = sky ? *sky : known;
    if (texels_.size() > now.record_texels() && texels_.back() == white_tint()) texels_.pop_back();
    if (texels_.size() > now.record_texels())
      sky = std::make_shared<ChunkSky>(with_tints(now, true));
    if (sky) record = find_record(*sky, local, direction);
    if (std::ranges::equal(texels_, record_of(sky ? *sky : known, *record, texels_.size()))) return;
    if (!sky) sky = std::make_shared<ChunkSky>(known);
    std::ranges::copy(texels_, sky->texels.begin() + static_cast<std::ptrdiff_t>(*record));
  }

  /// Makes room for the faces of a chunk that has been edited; those that stay keep their records.
  void repack(IVec3 at) {
    const std::vector<shared::Quad>& quads = chunk_of(of_.chunks_, at).quads;
    if (quads.empty()) {
      of_.skies_.erase(at);
      return;
    }
    const auto append = [&, corner = corner_of(at)](const DrawnFace& face,
                                                    std::vector<glm::uvec4>& texels) {
      of_.append_record(corner + face.voxel + to_front(face), face.direction, face.plant, texels);
    };
    const auto known = of_.skies_.find(at);
    const auto make = [&] {
      if (known == of_.skies_.end()) return pack_faces(quads, append, of_.record_parts());
      if (!of_.tints_.any()) return repack_faces(*known->second, quads, append);
      return repack_faces(with_tints(*known->second, true), quads, append);
    };
    of_.skies_[at] = fresh_[at] = std::make_shared<ChunkSky>(make());
  }

  SkyTransfer& of_;
  const LightChunks before_;
  std::vector<IVec3> edited_;                         // chunks
  std::vector<IVec3> reshaped_;                       // those in which a face has come or gone
  std::vector<IVec3> voxels_;                         // whose bits have changed
  std::vector<Face> came_, went_, turned_;            // faces of edited chunks, see FaceChanges
  std::vector<IVec3> wanted_;                         // voxels whose view is kept from now on
  std::vector<IVec3> gone_;                           // those whose view is not
  std::vector<IVec3> through_;                        // more voxels to which lines may have changed
  Kept fronts_;                                       // before new faces
  Kept lit_;                                          // see changed_at()
  Marked redo_marks_;                                 // of redo_, by 6 * number + direction
  std::vector<std::pair<IVec3, int>> redo_;           // records: front and direction
  std::map<IVec3, std::shared_ptr<ChunkSky>> fresh_;  // of chunks in reshaped_
  std::vector<glm::uvec4> texels_;                    // of a record
};

bool SkyTransfer::edit(LightChunks chunks) {
  return Edit(*this, std::move(chunks)).run();
}

}  // namespace skerry::world
