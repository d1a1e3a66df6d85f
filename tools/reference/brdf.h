// Surfaces and media as the program models them, written from the formulas.
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace skerry::reference {

/// Index of refraction of water, and of glass for want of another.
inline constexpr double kWaterIndex = 1.333;

/// Reflectance of the boundary to a medium of index n after Schlick (An Inexpensive BRDF Model for
/// Physically-based Rendering, 1994). @param cosine of the angle to the normal on the side the ray
/// is on; inside the medium (`leaving`) the angle is refracted first, and beyond the critical one
/// everything is reflected.
double fresnel(double cosine, bool leaving, double index);

/// Value of the Cook-Torrance lobe: D F G / (4 (n.l) (n.v)), with the distribution of GGX (Walter
/// et al. 2007, alpha = roughness^2), Smith's shadowing as Schlick fits it (k = alpha / 2), and
/// fresnel() above. All vectors unit. 0 where l or v is behind the surface.
double mirror_lobe(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye, double roughness,
                   double index);
/// The same without the Fresnel factor.
double mirror_lobe_lossless(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye,
                            double roughness);

/// The lobe of waves, whose slopes end where those of GGX do not: of slopes s by exp(-(s/alpha)^4),
/// flat in its middle and without a tail; else as mirror_lobe().
double wave_lobe(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye, double alpha,
                 double index);

/// What an opaque surface reflects of a light [1/sr]: a Cook-Torrance lobe, and a diffuse part that
/// gets what the lobe leaves. Reflectance from above is 0.04, a metal's is its albedo; after
/// Schlick it grows to 1 for grazing light. The diffuse part loses, once for the way in and once
/// for the way out, 0.04 and of grazing light 0.96 (1 - alpha)^6 more, so that a surface never
/// sends out more than it gets. All vectors unit. @param roughness perceptual, at least 0.06
/// counts.
glm::dvec3 surface_brdf(glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_eye,
                        glm::dvec3 albedo, double roughness, double metalness);

/// Orthonormal right, up about a unit axis, the third.
struct Frame {
  glm::dvec3 right, up, axis;
  explicit Frame(glm::dvec3 unit_axis);
  glm::dvec3 world(glm::dvec3 local) const {
    return right * local.x + up * local.y + axis * local.z;
  }
};

/// Directions about +z from a pair in [0, 1)^2: even in a cone about it; proportional to the cosine
/// over the half sphere.
glm::dvec3 in_cone(glm::dvec2 pair, double one_minus_cosine);
glm::dvec3 by_cosine(glm::dvec2 pair);

/// Corners of a face that block the light of an open half space: how much of it reaches a point of
/// the face, 0..1. At a corner 0 if both blocks beside it stand, else 1 less a third for each of
/// the two and the one across; between the corners bilinear.
/// @param place on the face, 0..1 along u and v. @param stands whether the eight blocks about the
/// one in front of the face are opaque: index 3 * (dv + 1) + (du + 1), the middle is not looked at.
double corner_ao(glm::dvec2 place, const bool (&stands)[9]);

}  // namespace skerry::reference
