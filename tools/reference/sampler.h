#pragma once
#include <cstdint>
#include <glm/vec2.hpp>

namespace skerry::reference {

/// The numbers one sample of one pixel draws, pair by pair. Over the samples of a batch each pair
/// runs through a two-dimensional Sobol sequence, shuffled and scrambled for every pixel, batch and
/// pair, so that an average converges faster than with random numbers, and batches are independent.
/// A function of its arguments alone. Source: B. Burley, Practical Hash-based Owen Scrambling, JCGT
/// 2020; hash by N. Vegdahl and S. Laine.
class Sampler {
 public:
  Sampler(std::uint32_t pixel, std::uint32_t batch, std::uint32_t sample);
  /// The next pair, in [0, 1)^2.
  glm::dvec2 next();

 private:
  std::uint32_t seed_, sample_;
  std::uint32_t pair_ = 0;
};

/// Point `index` of the first two dimensions of Sobol's sequence, in units of 2^-32.
glm::uvec2 sobol_point(std::uint32_t index);

}  // namespace skerry::reference
