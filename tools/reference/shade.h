#pragma once
#include <glm/vec3.hpp>
#include <vector>

#include "tools/reference/media.h"
#include "tools/reference/sampler.h"
#include "tools/reference/scene.h"
#include "tools/reference/tracer.h"

namespace skerry::reference {

/// What a ray brings to the eye.
struct Seen {
  glm::dvec3 radiance{0.0};  ///< of everything but stars
  glm::dvec3 open{0.0};      ///< share of the stars' light that comes through
};

/// The light of a scene, estimated by one sample of everything that must be averaged.
class Shader {
 public:
  Shader(const Scene& scene, const Tracer& tracer)
      : scene_(scene), tracer_(tracer), lights_(scene.lights) {}

  /// @param trace what the ray from the eye along `direction` meets.
  /// @param fine where in the pixel textures and discs are looked at; `direction`, unless geometry
  ///   is sampled more coarsely than they are.
  Seen look(const Trace& trace, glm::dvec3 direction, glm::dvec3 fine, Sampler& sampler) const;

  /// A place that light arrives at.
  struct Receiver {
    glm::dvec3 point, normal;        ///< unit; nothing comes from behind it
    const Meeting* plant = nullptr;  ///< the plant it is on: its two planes stand for loose leaves,
                                     ///< which do not shade each other
  };
  glm::dvec3 irradiance(const Receiver& at, Sampler& sampler) const;
  /// The part of it that comes neither from sun and moon nor from a lamp without being reflected,
  /// but for lamps of at most this range [blocks].
  glm::dvec3 soft_irradiance(const Receiver& at, double most_range, Sampler& sampler) const;

 private:
  /// One light as it arrives at a point.
  struct Arrival {
    glm::dvec3 to_light;
    glm::dvec3 irradiance;        ///< of a surface facing it
    const Light* lamp = nullptr;  ///< none: sun or moon
  };
  struct Reach;
  struct Passage;

  template <class Take>
  void arrive(const Receiver& at, Sampler& sampler, Take&& take) const;
  double cosine_of(const Arrival& light, glm::dvec3 normal) const;
  /// How light of a body comes to a place.
  struct Way {
    glm::dvec3 to_light{};  ///< unit, where the light comes from at the place
    glm::dvec3 share{0.0};  ///< of the irradiance that there would be without voxels; 0: hidden
  };
  Way way_of_body(const Receiver& at, glm::dvec3 to_light) const;
  glm::dvec3 left_of_body(const Receiver& at, glm::dvec3 to_light, world::BlockId medium) const;
  const Meeting* leaves_water(const Trace& trace, glm::dvec3 direction) const;
  /// What a ray goes on in behind a surface of water or glass.
  world::BlockId medium_behind(const Meeting& layer, glm::dvec3 direction) const;
  glm::dvec3 left_by_media(const Trace& trace, glm::dvec3 direction, double to,
                           world::BlockId medium) const;
  bool body_seen(const Receiver& at, glm::dvec3 to_light) const;
  /// What a ray from a surface meets past water and glass.
  struct Followed {
    std::optional<Meeting> hit;
    glm::dvec3 origin{}, direction{};  ///< of the ray's last part, along which `hit` lies
    glm::dvec3 share{1.0};             ///< of the radiance there that comes to the surface
  };
  Followed follow(const Receiver& at, glm::dvec3 direction, Sampler& sampler) const;
  /// Radiance from one direction, chosen by its cosine to the surface; and that.
  struct Around {
    glm::dvec3 to_light{}, radiance{};
  };
  Around from_around(const Receiver& at, int bounces, Sampler& sampler) const;
  glm::dvec3 beyond_voxels(glm::dvec3 direction) const;
  glm::dvec3 bounced(const Meeting& hit, glm::dvec3 point, int bounces, Sampler& sampler) const;
  bool is_in(glm::dvec3 point, const Meeting& hit) const;
  void trace_from(const Receiver& at, glm::dvec3 direction, Trace& out) const;
  glm::dvec3 behind_voxels(glm::dvec3 direction) const;

  glm::dvec3 surface(const Meeting& hit, glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 fine,
                     Sampler& sampler) const;
  double ao(const Meeting& hit) const;
  double extinction_of_air() const;
  glm::dvec3 through_air(glm::dvec3 radiance, glm::dvec3 origin, glm::dvec3 direction,
                         double distance, Sampler& sampler) const;

  double past_clouds(glm::dvec3 from, glm::dvec3 to_light, Sampler& sampler) const;
  glm::dvec3 lamps_in_cloud(glm::dvec3 p, glm::dvec3 direction, Sampler& sampler) const;
  glm::dvec3 lamps_along(const CloudMeeting& met, glm::dvec3 origin, glm::dvec3 direction,
                         double air, Sampler& sampler) const;
  Seen through_clouds(Seen behind, glm::dvec3 origin, glm::dvec3 direction, double begin,
                      double end, Sampler& sampler) const;
  Seen through_media(const Trace& trace, glm::dvec3 direction, glm::dvec3 fine, Seen behind,
                     Sampler& sampler) const;
  glm::dvec3 mirrored_outside(glm::dvec3 from, glm::dvec3 direction, Sampler& sampler) const;
  glm::dvec3 mirrored_inside(const Meeting& layer, glm::dvec3 from, glm::dvec3 direction,
                             glm::dvec3 light_in, Sampler& sampler) const;
  struct Ray {
    glm::dvec3 origin, direction;
  };
  Seen behind_media(const Trace& trace, const Ray& ray, glm::dvec3 fine, Sampler& sampler) const;
  Ray bent_ray(const Meeting& surface, glm::dvec3 direction) const;
  Seen behind_bent_ray(const Trace& trace, const Ray& ray, glm::dvec3 direction, double before,
                       Sampler& sampler) const;
  bool bends(const Trace& trace) const;
  void pass_surface(const Meeting& layer, const Ray& ray, glm::dvec3 fine, Passage& passage,
                    Sampler& sampler) const;
  Reach reach(const Receiver& at, glm::dvec3 shading_normal, glm::dvec3 to_eye, const Gloss& gloss,
              Sampler& sampler) const;
  glm::dvec3 rippled_normal(const Meeting& layer) const;

  const Scene& scene_;
  const Tracer& tracer_;
  const LightGrid lights_;
};

}  // namespace skerry::reference
