#pragma once

namespace skerry::tools {

/// Prints every Vulkan device and whether Skerry can use it, as text or JSON. @return the exit
/// status: kNoDevice when none can be used.
int devices(bool json);

}  // namespace skerry::tools
