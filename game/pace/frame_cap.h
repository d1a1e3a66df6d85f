// When the next frame begins.
#pragma once

namespace skerry::game {

/// Frames a second that may be drawn, of what the player set and the display does; 0: no limit.
/// @param cap, unfocused see FrameSettings.
double capped_rate(double cap, double display_hz, bool focused, double unfocused);

/// Seconds on the caller's clock at which the next frame is due. Due times follow one another by a
/// period, so that rates hold on average; after a frame that was late by more than one they go on
/// from now, and no burst of frames catches up.
/// @param due_s of the frame before. @param rate frames a second; 0: at once.
double next_due(double due_s, double now_s, double rate);

}  // namespace skerry::game
