// The bytes in which the program skerry_openexr hands over a panorama. Only one machine ever sees
// them, so numbers stand as in memory.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "engine/core/result.h"
#include "engine/render/sky/panorama.h"

namespace skerry::game {

/// Takes bytes in order; returns false when they could not be kept.
using AnswerSink = std::function<bool(std::span<const std::byte>)>;

/// Longest message of why there is no panorama.
inline constexpr std::size_t kMostRefusalText = 1024;

bool encode_panorama(const render::Panorama& panorama, const AnswerSink& sink);
/// An answer that says why there is no panorama; cut at kMostRefusalText.
bool encode_refusal(std::string_view why, const AnswerSink& sink);

/// Parses what a child that may be out of control has written: a panorama as panorama.h promises
/// it, of at most kKeptPanoramaColumns. Errors: the child's own message, or that the bytes are no
/// answer; one printable line without the file's name.
Result<render::Panorama> decode_panorama(std::span<const std::byte> bytes);

}  // namespace skerry::game
