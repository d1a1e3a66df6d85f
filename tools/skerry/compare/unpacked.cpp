#include "tools/skerry/compare/unpacked.h"

#include <fmt/format.h>

#include "engine/core/output.h"

namespace skerry::tools {

std::string known_as(const std::filesystem::path& file, const std::optional<Unpacked>& from) {
  if (!from) return quoted_path(file);
  return fmt::format("{} in the archive {}", quoted_path(file.lexically_relative(from->folder)),
                     quoted_path(from->archive));
}

}  // namespace skerry::tools
