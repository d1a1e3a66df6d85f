#include "world/light/lamp_reach.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "engine/core/check.h"
#include "world/light/base/face_records.h"

namespace skerry::world {
namespace {

using Word = std::uint64_t;

int floor_to_int(float v) {
  return static_cast<int>(std::floor(v));
}

/// Bits from a place on, to both ends of a word. @param bit may lie outside.
Word from_bit(int bit) {
  return bit <= 0 ? ~Word{0} : bit >= 64 ? 0 : ~Word{0} << bit;
}
Word to_bit(int bit) {
  return ~from_bit(bit + 1);
}

/// Spreads bits through the set bits of `open` towards higher places, 64 at a time (Kogge and
/// Stone's prefix network).
Word spread_up(Word bits, Word open) {
  for (int by = 1; by < 64; by *= 2) {
    bits |= open & bits << by;
    open &= open << by;
  }
  return bits;
}
Word spread_down(Word bits, Word open) {
  for (int by = 1; by < 64; by *= 2) {
    bits |= open & bits >> by;
    open &= open >> by;
  }
  return bits;
}

/// The rows of voxels within a lamp's range, and what its light may enter of them.
class Flood {
 public:
  /// @pre the lamp stands in the volume. @param place from its lowest voxel. @param low, high
  /// voxels to look at alone, if they are in the volume.
  Flood(const VoxelBits& opaque, glm::vec3 place, float range,
        const glm::ivec3& low = glm::ivec3(0), const glm::ivec3& high = glm::ivec3(INT32_MAX))
      : opaque_(opaque), place_(place), range_(range) {
    const glm::ivec3 last = vector_of(opaque.size()) - 1;
    for (int a = 0; a < 3; ++a) {
      lamp_[a] = floor_to_int(place[a]);
      first_[a] = std::max({floor_to_int(place[a] - range), 0, std::min(low[a], lamp_[a])});
      last_[a] = std::min({floor_to_int(place[a] + range), last[a], std::max(high[a], lamp_[a])});
    }
    word0_ = first_.z / 64, words_ = last_.z / 64 - word0_ + 1;
    rows_.assign(static_cast<std::size_t>(words_) *
                     static_cast<std::size_t>((last_.x - first_.x + 1) * (last_.y - first_.y + 1)),
                 0);
  }

  void run() {
    for (int y = lamp_.y; y <= last_.y; ++y) run_layer(y, y - 1);
    for (int y = lamp_.y - 1; y >= first_.y; --y) run_layer(y, y + 1);
  }

  const glm::ivec3& lamp() const { return lamp_; }
  bool entered(const glm::ivec3& v) const {
    if (glm::any(glm::lessThan(v, first_)) || glm::any(glm::greaterThan(v, last_))) return false;
    return (row(v.x, v.y)[v.z / 64 - word0_] >> v.z % 64 & 1u) != 0;
  }

  /// Calls fn(x, y, word, bits) for each word of a row of what was entered within the range, places
  /// from the volume's lowest voxel.
  template <class Fn>
  void for_each_word(const Fn& fn) const {
    for (int y = first_.y; y <= last_.y; ++y) {
      for (int x = first_.x; x <= last_.x; ++x) {
        const float aside2 = squared(x, 0) + squared(y, 1), left = range_ * range_ - aside2;
        if (left <= 0.0f) continue;
        const float reach = std::sqrt(left);
        const int z0 = floor_to_int(place_.z - reach), z1 = floor_to_int(place_.z + reach);
        for (int w = 0; w < words_; ++w) {
          const int base = (word0_ + w) * 64;
          const Word lit = row(x, y)[w] & from_bit(z0 - base) & to_bit(z1 - base);
          if (lit != 0) fn(x, y, word0_ + w, lit);
        }
      }
    }
  }

 private:
  Word* row(int x, int y) { return rows_.data() + index(x, y); }
  const Word* row(int x, int y) const { return rows_.data() + index(x, y); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>((y - first_.y) * (last_.x - first_.x + 1) + x - first_.x) *
           static_cast<std::size_t>(words_);
  }
  /// Squared distance of the lamp from a layer of voxels along an axis.
  float squared(int at, int axis) const {
    const auto low = static_cast<float>(at);
    const float off = std::max({low - place_[axis], place_[axis] - low - 1.0f, 0.0f});
    return off * off;
  }

  /// @param before the layer towards the lamp.
  void run_layer(int y, int before) {
    for (int x = lamp_.x; x <= last_.x; ++x) run_row(x, y, x - 1, before);
    for (int x = lamp_.x - 1; x >= first_.x; --x) run_row(x, y, x + 1, before);
  }

  void run_row(int x, int y, int before_x, int before_y) {
    Word* into = row(x, y);
    if (x != lamp_.x) take(into, row(before_x, y));
    if (y != lamp_.y) take(into, row(x, before_y));
    if (x == lamp_.x && y == lamp_.y) into[lamp_.z / 64 - word0_] |= Word{1} << lamp_.z % 64;
    const Word* solid = opaque_.row(x, y) + word0_;
    const auto open = [&](int w) {
      Word air = ~solid[w];
      if (x == lamp_.x && y == lamp_.y && w == lamp_.z / 64 - word0_)
        air |= Word{1} << lamp_.z % 64;
      return air;
    };
    bool any = false, all = true;  // of what is open
    for (int w = 0; w < words_; ++w) {
      into[w] &= open(w);
      any |= into[w] != 0;
      all &= into[w] == open(w);
    }
    if (!any || all) return;
    // Away from the lamp to either side; what lies on the other side of it stays as it is.
    Word carry = 0;
    for (int w = 0; w < words_; ++w) {
      const Word side = from_bit(lamp_.z - (word0_ + w) * 64), air = open(w) & side;
      into[w] |= spread_up((into[w] & side) | (carry & air), air);
      carry = (into[w] & side) >> 63;
    }
    carry = 0;
    for (int w = words_ - 1; w >= 0; --w) {
      const Word side = to_bit(lamp_.z - (word0_ + w) * 64), air = open(w) & side;
      into[w] |= spread_down((into[w] & side) | (carry & air), air);
      carry = (into[w] & side) << 63;
    }
  }
  void take(Word* into, const Word* from) const {
    for (int w = 0; w < words_; ++w) into[w] |= from[w];
  }

  const VoxelBits& opaque_;
  glm::vec3 place_;
  float range_;
  glm::ivec3 lamp_{}, first_{}, last_{};  // from the volume's lowest voxel
  int word0_ = 0, words_ = 0;             // of a row
  std::vector<Word> rows_;                // what was entered
};

/// Voxels in words of rows, and their bounds.
class Places {
 public:
  explicit Places(IVec3 volume) : volume_(volume) {}

  /// @param word of a row, may be one off its ends where no voxel is.
  void add(int x, int y, int word, Word bits) {
    if (bits == 0) return;
    words_.push_back({x, y, word, bits});
    low_ = glm::min(low_, glm::ivec3(x, y, word * 64 + std::countr_zero(bits)));
    high_ = glm::max(high_, glm::ivec3(x, y, word * 64 + 63 - std::countl_zero(bits)));
  }

  LampReach::Bricks bricks() const {
    LampReach::Bricks out;
    if (words_.empty()) return out;
    const glm::ivec3 origin = vector_of(volume_);
    glm::ivec3 low, size;
    constexpr int kBits = 32 * static_cast<int>(shared::kReachWords);
    // The finest that has room for all.
    for (out.edge_log2 = 0;; ++out.edge_log2) {
      low = (low_ + origin) >> out.edge_log2;
      size = ((high_ + origin) >> out.edge_log2) - low + 1;
      if (std::int64_t{size.x} * size.y * size.z <= kBits) break;
    }
    out.low = {low.x, low.y, low.z};
    out.size = {size.x, size.y, size.z};
    // All rows of a row of bricks together.
    const int first = low_.z >> 6, words = (high_.z >> 6) - first + 1;
    std::vector<Word> rows(static_cast<std::size_t>(size.x * size.y * words), 0);
    for (const Part& part : words_) {
      const int x = ((part.x + origin.x) >> out.edge_log2) - low.x,
                y = ((part.y + origin.y) >> out.edge_log2) - low.y;
      rows[static_cast<std::size_t>((x + size.x * y) * words + part.word - first)] |= part.bits;
    }
    for (int row = 0; row < size.x * size.y; ++row)
      for (int w = 0; w < words; ++w) {
        const int from = (first + w) * 64 + origin.z;
        for (Word left = rows[static_cast<std::size_t>(row * words + w)]; left != 0;) {
          const int brick = (from + std::countr_zero(left)) >> out.edge_log2;
          const int bit = brick - low.z + size.z * row;
          out.bits[static_cast<std::size_t>(bit / 32)] |= 1u << bit % 32;
          left &= from_bit(((brick + 1) << out.edge_log2) - from);
        }
      }
    return out;
  }

 private:
  struct Part {
    int x, y, word;
    Word bits;
  };
  IVec3 volume_;  // lowest voxel
  std::vector<Part> words_;
  glm::ivec3 low_{INT32_MAX}, high_{INT32_MIN};
};

/// Whether faces of a direction in front of which a voxel is can face the lamp, for the rows at x
/// and y; of z, which bits can. The plane of such a face is a side of the voxel; the lamp counts as
/// a little nearer than it is.
Word facing(int face, int x, int y, int base, glm::vec3 lamp) {
  constexpr float kRounding = 1e-2f;
  const FaceAxes axes(face);
  const float at = lamp[axes.own];
  if (axes.own != 2) {
    const auto voxel = static_cast<float>(axes.own == 0 ? x : y);
    const bool faces = axes.sign > 0 ? at > voxel - kRounding : at < voxel + 1.0f + kRounding;
    return faces ? ~Word{0} : 0;
  }
  return axes.sign > 0 ? to_bit(floor_to_int(at + kRounding) - base)
                       : from_bit(floor_to_int(at - kRounding) - base);
}

}  // namespace

bool LampReach::Bricks::at(IVec3 voxel) const {
  const glm::ivec3 v = (vector_of(voxel) >> edge_log2) - vector_of(low);
  if (empty() || glm::any(glm::lessThan(v, glm::ivec3(0))) ||
      glm::any(glm::greaterThanEqual(v, vector_of(size))))
    return false;
  return bit(v.z + size.z * (v.x + size.x * v.y));
}

bool LampReach::Bricks::any_within(IVec3 from, IVec3 to) const {
  if (empty()) return false;
  const glm::ivec3 origin = vector_of(low);
  const glm::ivec3 first = glm::max((vector_of(from) >> edge_log2) - origin, glm::ivec3(0)),
                   last = glm::min((vector_of(to) >> edge_log2) - origin, vector_of(size) - 1);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      for (int z = first.z; z <= last.z; ++z)
        if (bit(z + size.z * (x + size.x * y))) return true;
  return false;
}

LampReach::LampReach(const LightChunks& chunks) : opaque_(air_volume_of(chunks).opaque) {
  take_faces(chunks);
}

LampReach::LampReach(const LightChunks& chunks, IVec3 low, IVec3 high)
    : opaque_(opaque_within(chunks, low, high)) {
  take_faces(chunks);
}

void LampReach::take_faces(const LightChunks& chunks) {
  if (opaque_.size().x == 0) return;
  all_round_ = VoxelBits(opaque_.low(), opaque_.size(), false);
  plants_ = any_ = all_round_;
  fronts_.fill(all_round_);
  const glm::ivec3 low = vector_of(opaque_.low()), last = low + vector_of(opaque_.size()) - 1;
  const auto set = [&](VoxelBits& bits, IVec3 voxel) {
    const glm::ivec3 v = vector_of(voxel);
    if (glm::all(glm::greaterThanEqual(v, low)) && glm::all(glm::lessThanEqual(v, last)))
      bits.set(voxel), any_.set(voxel);
  };
  for (const auto& [at, chunk] : chunks) {
    const IVec3 corner = corner_of(at);
    for (const shared::Quad& quad : chunk->quads) {
      const glm::ivec3 first =
          vector_of(corner) +
          glm::ivec3(quad.geometry & 63u, quad.geometry >> 6 & 63u, quad.geometry >> 12 & 63u);
      const int most =
          static_cast<int>(1 + std::max(quad.geometry >> 18 & 63u, quad.geometry >> 24 & 63u));
      if (glm::any(glm::lessThan(first + most, low)) || glm::any(glm::greaterThan(first - 1, last)))
        continue;
      for_each_face(quad, [&](const DrawnFace& face) {
        const IVec3 voxel = corner + face.voxel;
        if (face.plant) return set(plants_, voxel);
        const FaceAxes axes(face.direction);
        const IVec3 front = voxel + axis_vector(axes.own, axes.sign);
        if (opaque_.at(voxel)) return set(fronts_[static_cast<std::size_t>(face.direction)], front);
        set(all_round_, voxel);
        set(all_round_, front);
      });
    }
  }
}

LampReach::Found LampReach::of(IVec3 chunk, const StrongLamp& lamp) const {
  if (opaque_.size().x == 0) return {};
  const glm::ivec3 corner = vector_of(corner_of(chunk)) - vector_of(opaque_.low());
  const glm::vec3 place = lamp.place + glm::vec3(corner);
  SKERRY_ASSERT(glm::all(glm::greaterThanEqual(place, glm::vec3(0.0f))) &&
                glm::all(glm::lessThan(place, glm::vec3(vector_of(opaque_.size())))));
  Flood flood(opaque_, place, lamp.range);
  flood.run();
  Places lit(opaque_.low()), air(opaque_.low());
  flood.for_each_word([&](int x, int y, int word, Word entered) {
    air.add(x, y, word, entered);
    if ((entered & any_.row(x, y)[word]) == 0) return;
    // A plant is lit as if it were level (docs/conventions.md).
    Word here = entered & (all_round_.row(x, y)[word] |
                           (plants_.row(x, y)[word] & facing(2, x, y, word * 64, place)));
    for (int face = 0; face < 6; ++face) {
      const Word front = entered & fronts_[static_cast<std::size_t>(face)].row(x, y)[word] &
                         facing(face, x, y, word * 64, place);
      if (front == 0) continue;
      here |= front;
      // The voxel whose face it is, behind.
      const FaceAxes axes(face);
      if (axes.own != 2) {
        lit.add(x - (axes.own == 0 ? axes.sign : 0), y - (axes.own == 1 ? axes.sign : 0), word,
                front);
      } else if (axes.sign > 0) {
        lit.add(x, y, word, front >> 1);
        lit.add(x, y, word - 1, front << 63);
      } else {
        lit.add(x, y, word, front << 1);
        lit.add(x, y, word + 1, front >> 63);
      }
    }
    lit.add(x, y, word, here);
  });
  return {lit.bricks(), air.bricks()};
}

bool LampReach::changes(const VoxelBits& opaque, IVec3 chunk, const StrongLamp& lamp,
                        std::span<const ReachFace> faces) {
  const glm::ivec3 origin = vector_of(opaque.low());
  const glm::vec3 place = lamp.place + glm::vec3(vector_of(corner_of(chunk)) - origin);
  glm::ivec3 low(INT32_MAX), high(INT32_MIN);
  for (const ReachFace& face : faces)
    for (const IVec3& side : {face.voxel, face.front}) {
      low = glm::min(low, vector_of(side) - origin);
      high = glm::max(high, vector_of(side) - origin);
    }
  Flood flood(opaque, place, lamp.range, low, high);
  flood.run();
  return std::ranges::any_of(faces, [&](const ReachFace& face) {
    const glm::ivec3 voxel = vector_of(face.voxel) - origin, front = vector_of(face.front) - origin;
    if (voxel == flood.lamp() || front == flood.lamp()) return true;
    if (!face.one_sided) return flood.entered(voxel) || flood.entered(front);
    return flood.entered(front) &&
           (facing(face.direction, front.x, front.y, front.z, place) & 1u) != 0;
  });
}

}  // namespace skerry::world
