// Clouds for the reference renderer: the same media as docs/clouds.md describes, looked up in
// double precision. Places are relative to the camera [blocks].
#pragma once
#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace skerry::reference {

/// The layer's noise: four values for each of 128^3 texels, in steps of 1/255, from formulas.
class CloudNoise {
 public:
  static const CloudNoise& shared();
  /// Trilinear between texels' centres; repeats with 1. @param channel 0..3
  double at(glm::dvec3 place, int channel) const;
  /// Channels 1 and 2.
  glm::dvec2 billows_at(glm::dvec3 place) const;
  /// No value in the place's cell is larger. 32 cells to the period, each way.
  double most_about(glm::dvec3 place, int channel) const;

 private:
  /// Texels about a place, and their shares.
  struct Corners {
    std::size_t index[8];
    double weight[8];
  };
  CloudNoise();
  static Corners corners_of(glm::dvec3 place);
  std::vector<std::array<std::uint8_t, 4>> texels_, most_;
};

struct CloudLayer {
  glm::dvec3 eye{0.0};  ///< in the noise (x, z), and over the layer's base (y)
  double thickness = 1.0, extinction = 0.0, coverage = 0.0;
  double extinction_at(glm::dvec3 p) const;
  /// A cube that holds a place.
  struct Cell {
    double way = 0.0;    ///< that a ray stays in it [blocks]
    bool empty = false;  ///< there is no cloud in it, for certain
  };
  Cell cell_at(glm::dvec3 p, glm::dvec3 direction) const;
};

/// A grid of samples at whole indices; 0 beyond it.
struct CloudGrid {
  glm::dmat4 index_from_world{1.0};
  glm::ivec3 low{0}, size{0};
  std::vector<float> samples;  ///< x fastest
  double extinction = 0.0;     ///< of value 1 [1/block]
  glm::dvec3 emission{0.0};    ///< of value 1 [radiance/block]
  double step = 1.0;           ///< of a march: half the distance of the nearest samples [blocks]
  double value_at(glm::dvec3 p) const;
};

/// A part of a ray that is in some cloud, and how finely it is marched [blocks].
struct Stretch {
  double from = 0.0, to = 0.0, step = 1.0;
};

struct Clouds {
  std::optional<CloudLayer> layer;
  std::vector<CloudGrid> grids;

  double extinction_at(glm::dvec3 p) const;
  glm::dvec3 emission_at(glm::dvec3 p) const;
  /// Where a ray may be in any cloud, near to far.
  std::vector<Stretch> stretches(glm::dvec3 origin, glm::dvec3 direction) const;
  /// Optical depth of a way. @param direction unit. @param offset 0..1: where in its steps a march
  /// looks; a mean over offsets is exact. @param distance how long the way is [blocks].
  double depth(glm::dvec3 origin, glm::dvec3 direction, double offset,
               double distance = 1e30) const;
};

/// What a ray through clouds meets.
struct CloudMeeting {
  /// A part of the ray in which the cloud counts as even.
  struct Step {
    double from = 0.0, length = 0.0;     ///< blocks
    double before = 0.0, through = 0.0;  ///< optical depth up to it, and of it
  };
  double clear = 1.0;       ///< what is left of what is behind
  glm::dvec3 emitted{0.0};  ///< radiance of what glows, past the air before it
  std::vector<Step> steps;  ///< those that hold something, near to far

  /// A place of scattering, as likely as light comes from there. @param share 0..1, even.
  /// @pre clear < 1
  double place(double share) const;
  /// Share of the light that the cloud scatters at a place that reaches the eye, times extinction
  /// [1/block].
  double weight_at(double t) const;
};
/// A stretch of a ray.
struct CloudWay {
  glm::dvec3 origin, direction;   ///< the eye, or where its view is mirrored; unit
  double begin = 0.0, end = 0.0;  ///< [blocks]
};
/// @param air extinction of clear air [1/block]. @param offset 0..1: where in its steps a march
/// looks.
CloudMeeting meet_clouds(const Clouds& clouds, const CloudWay& way, double air, double offset);

/// Share of irradiance that a cloud sends on in a direction, over extinction [1/sr], with light
/// scattered more than once. @param cosine of the angle that light is turned by. @param depth
/// optical, to the light.
double scattered_share(double cosine, double depth);
/// Share of the sky's mean radiance that reaches a place.
double sky_share(double depth);
inline constexpr double kCloudAlbedo = 0.99;

}  // namespace skerry::reference
