#include "tools/reference/sampler.h"

namespace skerry::reference {
namespace {

std::uint32_t mix(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0x735a2d97u;
  return x ^ x >> 15;
}

std::uint32_t reversed(std::uint32_t x) {
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  return x << 24 | (x & 0xff00u) << 8 | (x >> 8 & 0xff00u) | x >> 24;
}

/// Owen's scrambling from the highest bit down: each bit is flipped by a hash of those above it.
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reversed(x);
}

double unit(std::uint32_t x) {
  return static_cast<double>(x) * 0x1p-32;
}

}  // namespace

glm::uvec2 sobol_point(std::uint32_t index) {
  glm::uvec2 point{reversed(index), 0u};
  // Direction numbers of x + 1: rows of Pascal's triangle modulo 2.
  for (std::uint32_t v = 0x80000000u; index != 0; index >>= 1, v ^= v >> 1)
    if ((index & 1u) != 0) point.y ^= v;
  return point;
}

Sampler::Sampler(std::uint32_t pixel, std::uint32_t batch, std::uint32_t sample)
    : seed_(mix(pixel ^ mix(batch + 0x9e3779b9u))), sample_(sample) {}

glm::dvec2 Sampler::next() {
  const std::uint32_t seed = mix(seed_ + 0x632be5abu * ++pair_);
  const glm::uvec2 point = sobol_point(scrambled(sample_, seed));
  return {unit(scrambled(point.x, mix(seed ^ 0x68bc21ebu))),
          unit(scrambled(point.y, mix(seed ^ 0x02e5be93u)))};
}

}  // namespace skerry::reference
