#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "engine/core/result.h"

namespace skerry::game {

/// The default device of OpenAL Soft, which is loaded here: the program runs without it. One
/// thread.
class OpenAlOut {
 public:
  static constexpr std::size_t kBlock = 480;  ///< samples a channel: 10 ms
  static constexpr int kBlocks = 4;           ///< that wait to be played

  /// Errors: there is no library, no device, or it takes no stereo stream.
  static Result<std::unique_ptr<OpenAlOut>> open();
  ~OpenAlOut();
  OpenAlOut(const OpenAlOut&) = delete;
  OpenAlOut& operator=(const OpenAlOut&) = delete;

  /// How many blocks there is room for now. 0 from a device that was unplugged.
  int room();
  /// @param stereo kBlock pairs. @pre room() was not 0.
  void play(std::span<const std::int16_t> stereo);

 private:
  struct Calls;
  OpenAlOut();
  std::unique_ptr<Calls> al_;
};

}  // namespace skerry::game
