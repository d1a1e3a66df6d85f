// What tests hear, as files that people and other programs can listen to.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace skerry {

inline constexpr std::uint32_t kWavHeaderBytes = 44;

/// 16-bit stereo at 48 kHz. @param stereo left and right in turn, -1 .. 1.
/// Source: IBM and Microsoft, Multimedia Programming Interface and Data Specifications 1.0, "WAVE".
inline bool write_wav(const std::filesystem::path& path, std::span<const float> stereo) {
  std::string bytes;
  const auto number = [&bytes](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xff);
  };
  constexpr std::uint32_t kRate = 48000, kFrameBytes = 4;
  const auto data = static_cast<std::uint32_t>(stereo.size() * 2);
  bytes += "RIFF";
  number(kWavHeaderBytes - 8 + data, 4);
  bytes += "WAVEfmt ";
  number(16, 4);
  number(1, 2);  // PCM
  number(2, 2);  // channels
  number(kRate, 4);
  number(kRate * kFrameBytes, 4);
  number(kFrameBytes, 2);
  number(16, 2);
  bytes += "data";
  number(data, 4);
  for (const float sample : stereo) {
    const long level = std::lround(std::clamp(sample, -1.0f, 1.0f) * 32767.0f);
    number(static_cast<std::uint32_t>(level) & 0xffff, 2);
  }
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  return !file.fail();
}

/// Where recordings go, $SKERRY_LISTEN; none: nobody asked for any.
inline std::optional<std::filesystem::path> recordings_folder() {
  const char* folder = std::getenv("SKERRY_LISTEN");
  if (!folder || *folder == '\0') return std::nullopt;
  return folder;
}

}  // namespace skerry
