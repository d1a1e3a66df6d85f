#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace skerry::game {

/// What room the listener is in.
struct ReverbAim {
  float decay_s = 0.5f;        ///< in which the tail falls by 60 dB, 0.1 .. 8
  float level = 0.0f;          ///< amplitude of what is sent, 0 .. 1
  float damping_hz = 6000.0f;  ///< above this the tail falls faster
};

/// A feedback delay network of eight lines with a Hadamard matrix (J.-M. Jot and A. Chaigne,
/// Digital delay networks for designing artificial reverberators, AES 90, 1991).
class Reverb {
 public:
  Reverb();
  /// Glides there over some 50 ms.
  void set(const ReverbAim& aim);
  /// Adds the tail of `send` to the channels; all of one size.
  void render(std::span<const float> send, std::span<float> left, std::span<float> right);

 private:
  static constexpr std::size_t kLines = 8;
  struct Line {
    std::vector<float> delay;
    std::size_t at = 0;
    float feedback = 0.0f, goal = 0.0f;  // gain of a turn through it
    float low = 0.0f;                    // what its low-pass remembers
  };
  std::array<Line, kLines> lines_;
  float level_ = 0.0f, level_goal_ = 0.0f;
  float pole_ = 1.0f;
  std::size_t quiet_ = 0;  // samples since anything above hearing was in it
};

}  // namespace skerry::game
