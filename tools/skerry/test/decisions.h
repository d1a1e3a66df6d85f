// What a person decided about the failures on a page of `skerry test`, and its application.
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {

/// About one scene, as the page's script writes it.
struct Decision {
  std::string scene, driver;
  std::string picture;  ///< file_hash of the picture that was looked at
  bool approve = false;
  std::optional<std::string> png;  ///< the picture's file; none: it lies in the report's folder
};

/// Reads a file that a page wrote. Errors name it: it is none; a scene is there twice; a picture is
/// no base64 (RFC 4648).
Result<std::vector<Decision>> read_decisions(const std::filesystem::path& file);

/// A decision with all that it is about.
struct Approval {
  TestScene scene;
  std::string driver;
  platform::PngImage picture;
};

/// Checks decisions against the report that they are about and the scenes, before anything is
/// replaced. @param report folder of the page; none: the decisions have the pictures, and what the
/// page has buttons for was fit to be approved. @return what is to be approved, in their order.
/// Errors: a scene or a picture is not there or is another one since; the row of its scene did not
/// fail or cannot be approved; what would be replaced is no regular file, or no reference of
/// `skerry test`.
Result<std::vector<Approval>> check_decisions(std::span<const Decision> decisions,
                                              const std::optional<std::filesystem::path>& report,
                                              std::span<const TestScene> scenes);

/// Makes a picture the reference of its scene and its hash the approved one. @return what was done.
/// Errors: it is not finite or black without leave; of writing.
Result<std::string> apply(const Approval& approval);

}  // namespace skerry::tools
