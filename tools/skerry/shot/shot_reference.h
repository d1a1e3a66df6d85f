#pragma once
#include "tools/skerry/shot/shot.h"

namespace skerry::tools {

/// `skerry shot --renderer reference`: the same picture, exactly and on the CPU. Needs no device.
/// @return the exit status.
int shot_reference(const ShotOptions& options);

}  // namespace skerry::tools
