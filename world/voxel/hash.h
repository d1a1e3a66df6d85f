#pragma once
#include <cstdint>

namespace skerry::world {

/// Bijective mixers: every input bit reaches every output bit. Source: the finalisers of SplitMix64
/// (G. Steele et al., "Fast splittable pseudorandom number generators", 2014) and of "lowbias32"
/// (C. Wellons, "Prospecting for hash functions", 2018).
constexpr std::uint64_t mix64(std::uint64_t h) {
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}
constexpr std::uint32_t mix32(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

/// Hash of a lattice point.
constexpr std::uint32_t hash2(std::uint32_t seed, int x, int z) {
  return mix32(seed ^ (static_cast<std::uint32_t>(x) * 0x9e3779b1u) ^
               (static_cast<std::uint32_t>(z) * 0x85ebca77u));
}
constexpr std::uint32_t hash3(std::uint32_t seed, int x, int y, int z) {
  return mix32(seed ^ (static_cast<std::uint32_t>(x) * 0x9e3779b1u) ^
               (static_cast<std::uint32_t>(y) * 0xc2b2ae3du) ^
               (static_cast<std::uint32_t>(z) * 0x85ebca77u));
}

/// A stream of integers that depends on nothing but its seed.
class Rng {
 public:
  explicit constexpr Rng(std::uint64_t seed) : state_(seed) {}
  constexpr std::uint64_t next() { return mix64(state_ += 0x9e3779b97f4a7c15u); }
  /// Uniform in [low, high]. @pre high - low < 2^31.
  constexpr int in(int low, int high) {
    const auto count = static_cast<std::uint64_t>(static_cast<std::int64_t>(high) - low + 1);
    return low + static_cast<int>(((next() >> 32) * count) >> 32);
  }
  /// True in `of_256` cases out of 256.
  constexpr bool chance(int of_256) { return in(0, 255) < of_256; }

 private:
  std::uint64_t state_;
};

}  // namespace skerry::world
