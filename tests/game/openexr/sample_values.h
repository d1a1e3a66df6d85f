#pragma once

namespace skerry::game {

/// Of the pictures that skerry_exr_samples writes; half as many rows.
inline constexpr int kSampleColumns = 64;

/// Channel c of their texels: a half can hold it.
inline float sample_value(int x, int y, int c) {
  return static_cast<float>((x * 5 + y * 11 + c * 37) & 127) / 64.0f;
}

}  // namespace skerry::game
