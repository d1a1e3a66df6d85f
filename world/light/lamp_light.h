#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "world/light/air_volume.h"

namespace skerry::world {

/// Rec. 709.
inline float luminance(const glm::vec3& c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

/// Irradiance of weak lamps in voxels, for each of the six face directions: the mean over the
/// voxel's side that lies behind it, where the face is that looks there.
struct LampLight {
  std::array<glm::vec3, 6> faces{};
  /// At that side's corners, b + 2 c (FaceAxes): luminance, such that what is interpolated between
  /// them is on average what the lamp gives there. Between means of voxels the light of a lamp a
  /// block away would come out twice as bright.
  std::array<std::array<float, 4>, 6> corners{};

  const glm::vec3& operator[](std::size_t face) const { return faces[face]; }
  glm::vec3& operator[](std::size_t face) { return faces[face]; }
  /// At a corner, in the colour of the mean.
  glm::vec3 at(std::size_t face, std::size_t corner) const;
  LampLight& operator+=(const LampLight& other);
  bool operator==(const LampLight&) const = default;
};

/// What a lamp gives a voxel: nothing unless the line to its middle is clear. A line that passes
/// where voxels meet at an edge or a corner needs all of them clear; leaves take half, plants a
/// quarter, stained glass what its colour does; the lamp's own voxel hides nothing. @param lamp
/// place from the lattice's origin.
/// @return zeros: none.
LampLight light_of_lamp(const AirVolume& air, const WeakLamp& lamp, IVec3 voxel);

inline bool is_dark(const LampLight& light) {
  return light == LampLight{};
}

/// Lamps' light in some of many voxels that have numbers. Most have none, and that is found out by
/// one load.
class LampLightMap {
 public:
  /// None: nothing but darkness was put there.
  const LampLight* find(std::size_t number) const {
    const std::uint32_t place = number < places_.size() ? places_[number] : 0;
    return place != 0 ? &lights_[place - 1] : nullptr;
  }
  void add(std::size_t number, const LampLight& light);
  /// @return whether it was other.
  bool set(std::size_t number, const LampLight& light);
  /// A voxel's number becomes another that no voxel has. @pre there is no light at that.
  void move(std::size_t from, std::size_t to);
  /// Calls fn(number, light) for each that is lit.
  template <class Fn>
  void for_each(const Fn& fn) const {
    for (std::size_t number = 0; number < places_.size(); ++number)
      if (const LampLight* light = find(number)) fn(number, *light);
  }
  std::size_t bytes() const;

 private:
  std::uint32_t& place_of(std::size_t number);

  std::vector<std::uint32_t> places_;  // by number: 1 + place in lights_; 0: none
  std::vector<LampLight> lights_;
  std::vector<std::uint32_t> free_;  // places
};

}  // namespace skerry::world
