#pragma once

namespace skerry::platform {

/// From now on memory that is freed stays with the process, up to 256 MiB at the end of each heap,
/// instead of going back to the kernel: a driver that rasterises on the CPU frees a frame's bins
/// after each frame and asks for as many again. Called once, before other threads start.
void keep_freed_memory();

}  // namespace skerry::platform
