#include "world/light/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/core/check.h"
#include "world/light/glass_tints.h"

namespace skerry::world {
namespace {

constexpr float kWideWithin = 4.0f;  // voxels: from there on, a face is narrow (to 2% of its mean)
constexpr float kLeastDistance2 = 0.25f;  // voxels, from a lamp, that a corner counts for
constexpr double kTogether = 1e-6;        // of the way: crossings that count as one

int floor_to_int(double v) {
  return static_cast<int>(std::floor(v));
}

/// Mean over a voxel's face of what a point of intensity 1 gives it, which is the solid angle that
/// the face takes up. @param b, c from the lamp to the face's middle, along the face. @param height
/// of the lamp above it, positive.
float solid_angle_of_face(float b, float c, float height) {
  const auto corner = [height](float u, float v) {
    return std::atan2(u * v, height * std::sqrt(u * u + v * v + height * height));
  };
  return corner(b + 0.5f, c + 0.5f) - corner(b - 0.5f, c + 0.5f) - corner(b + 0.5f, c - 0.5f) +
         corner(b - 0.5f, c - 0.5f);
}

/// Light is interpolated between corners, which gives too much where it falls steeply: 26% to 42%
/// one to two voxels beside a lamp above level ground. What a point gives, less a twelfth of its
/// Laplacian along the face, is right on average where it is smooth, and is what the point would
/// give about this far away.
/// @param across2, along2 squared distance along the face, and from its plane.
/// @return squared distance.
float for_interpolation(float across2, float along2) {
  constexpr float kMostNearer = 0.8f;  // beside the lamp it is not smooth
  const float distance2 = across2 + along2;
  const float farther = (15.0f * across2 / distance2 - 6.0f) / 18.0f;
  return std::max({distance2 + farther, kMostNearer * distance2, kLeastDistance2});
}

/// What is left of the light between two points, 0..1 of each colour. Steps through the voxels that
/// the line touches.
class Line {
 public:
  Line(const AirVolume& air, glm::dvec3 from, glm::dvec3 to) : air_(air) {
    const glm::dvec3 way = to - from;
    length_ = glm::length(way);
    for (int a = 0; a < 3; ++a) {
      at_[a] = floor_to_int(from[a]);
      end_[a] = floor_to_int(to[a]);
      step_[a] = way[a] > 0.0 ? 1 : -1;
      const double border = way[a] > 0.0 ? at_[a] + 1.0 : at_[a];
      next_[a] = way[a] == 0.0 ? 2.0 : (border - from[a]) / way[a];
      every_[a] = way[a] == 0.0 ? 2.0 : 1.0 / std::abs(way[a]);
    }
  }

  glm::vec3 clear() {
    while (left_ > 0.0f && at_ != end_) {
      const double t = std::min({next_[0], next_[1], next_[2], 1.0});
      pass_glass(t);
      if (t >= 1.0) break;
      std::array<bool, 3> crosses{};
      for (std::size_t a = 0; a < 3; ++a) crosses[a] = next_[static_cast<int>(a)] <= t + kTogether;
      pass(crosses);
    }
    return left_ * tint_;
  }

 private:
  // A face before which there is glass lies at the far side of it, not in its middle.
  void pass_glass(double to) {
    const double from = std::exchange(passed_, to);
    if (air_.stained.empty()) return;
    const BlockId block = air_.stained.at({at_.x, at_.y, at_.z});
    if (block == kAir) return;
    const double voxels = (to - from) * length_ * (from == 0.0 ? 2.0 : 1.0);
    tint_ *= left_by_glass(block, static_cast<float>(voxels) * air_.stained.voxel_blocks());
  }

  // Where the line crosses several borders at once, all voxels about that point but the one it came
  // from are touched.
  void pass(const std::array<bool, 3>& crosses) {
    for (int corner = 1; corner < 8; ++corner) {
      glm::ivec3 v = at_;
      bool touched = true;
      for (int a = 0; a < 3; ++a) {
        if ((corner >> a & 1) == 0) continue;
        touched = touched && crosses[static_cast<std::size_t>(a)];
        v[a] += step_[a];
      }
      if (touched) meet(v);
    }
    for (int a = 0; a < 3; ++a) {
      if (!crosses[static_cast<std::size_t>(a)]) continue;
      at_[a] += step_[a];
      next_[a] += every_[a];
    }
  }
  void meet(glm::ivec3 v) {
    if (v == end_) return;
    const IVec3 voxel{v.x, v.y, v.z};
    if (air_.opaque.at(voxel)) left_ = 0.0f;
    if (!air_.has_leaves) return;
    if (air_.leaves.at(voxel)) left_ *= 0.5f;
    if (air_.plants.at(voxel)) left_ *= 0.75f;
  }

  const AirVolume& air_;
  glm::ivec3 at_{}, end_{}, step_{};
  glm::dvec3 next_{}, every_{};
  double length_ = 0.0, passed_ = 0.0;  // of the whole way; share of it
  float left_ = 1.0f;
  glm::vec3 tint_{1.0f};
};

}  // namespace

glm::vec3 LampLight::at(std::size_t face, std::size_t corner) const {
  const float mean = luminance(faces[face]);
  return mean > 0.0f ? faces[face] * (corners[face][corner] / mean) : glm::vec3(0.0f);
}

LampLight& LampLight::operator+=(const LampLight& other) {
  for (std::size_t face = 0; face < faces.size(); ++face) {
    faces[face] += other.faces[face];
    for (std::size_t corner = 0; corner < 4; ++corner)
      corners[face][corner] += other.corners[face][corner];
  }
  return *this;
}

LampLight light_of_lamp(const AirVolume& air, const WeakLamp& lamp, IVec3 voxel) {
  LampLight out{};
  const glm::vec3 middle(static_cast<float>(voxel.x) + 0.5f, static_cast<float>(voxel.y) + 0.5f,
                         static_cast<float>(voxel.z) + 0.5f);
  const glm::vec3 from_middle = lamp.place - middle;
  if (glm::dot(from_middle, from_middle) >= lamp.range * lamp.range) return out;
  const glm::vec3 clear = Line(air, glm::dvec3(middle), glm::dvec3(lamp.place)).clear();
  if (clear == glm::vec3(0.0f)) return out;
  for (std::size_t face = 0; face < 6; ++face) {
    // What lies behind the voxel is half a voxel farther from the lamp than its middle.
    const auto axis = static_cast<int>(face / 2);
    const float sign = face % 2 == 0 ? 1.0f : -1.0f;
    glm::vec3 way = from_middle;
    way[axis] += 0.5f * sign;
    const float along = way[axis] * sign;
    const float distance2 = glm::dot(way, way), q = distance2 / (lamp.range * lamp.range);
    if (along <= 0.0f || q >= 1.0f) continue;
    const float window = (1.0f - q * q) * (1.0f - q * q);
    const float share = distance2 < kWideWithin * kWideWithin
                            ? solid_angle_of_face(way[(axis + 1) % 3], way[(axis + 2) % 3], along)
                            : along / (distance2 * std::sqrt(distance2));
    out[face] = lamp.intensity * (clear * window * share);
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const float all = luminance(lamp.intensity * clear) * window * along;
    for (int corner = 0; corner < 4; ++corner) {
      glm::vec3 from_corner = way;
      from_corner[b] -= (corner & 1) != 0 ? 0.5f : -0.5f;
      from_corner[c] -= (corner & 2) != 0 ? 0.5f : -0.5f;
      const float d2 = for_interpolation(
          from_corner[b] * from_corner[b] + from_corner[c] * from_corner[c], along * along);
      out.corners[face][static_cast<std::size_t>(corner)] = all / (d2 * std::sqrt(d2));
    }
  }
  return out;
}

void LampLightMap::add(std::size_t number, const LampLight& light) {
  LampLight sum = light;
  if (const LampLight* before = find(number)) (sum = *before) += light;
  set(number, sum);
}

bool LampLightMap::set(std::size_t number, const LampLight& light) {
  const LampLight* before = find(number);
  if (before != nullptr ? *before == light : is_dark(light)) return false;
  std::uint32_t& place = place_of(number);
  if (is_dark(light)) {
    free_.push_back(std::exchange(place, 0));
    return true;
  }
  if (place == 0 && !free_.empty()) {
    place = free_.back();
    free_.pop_back();
  } else if (place == 0) {
    lights_.emplace_back();
    place = static_cast<std::uint32_t>(lights_.size());
  }
  lights_[place - 1] = light;
  return true;
}

void LampLightMap::move(std::size_t from, std::size_t to) {
  if (find(from) == nullptr) return;
  const std::uint32_t place = std::exchange(place_of(from), 0);
  SKERRY_ASSERT(find(to) == nullptr);
  place_of(to) = place;
}

std::size_t LampLightMap::bytes() const {
  return (places_.size() + free_.size()) * sizeof(std::uint32_t) +
         lights_.size() * sizeof(LampLight);
}

std::uint32_t& LampLightMap::place_of(std::size_t number) {
  if (number >= places_.size()) places_.resize(number + 1, 0);
  return places_[number];
}

}  // namespace skerry::world
