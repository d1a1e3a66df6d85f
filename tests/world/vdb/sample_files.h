#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <test_paths.h>
#include "tests/folder.h"

namespace skerry::world {

/// The folder of what tests/world/vdb/samples.cpp writes, made when first asked for; empty in a
/// build without OpenVDB.
inline const std::filesystem::path& sample_files() {
  static const Folder folder;
  static const bool made = [] {
    const std::string program = SKERRY_BINARY_DIR "/skerry_vdb_samples";
    if (!std::filesystem::exists(program)) return false;
    return std::system((program + " " + folder.path().string()).c_str()) == 0;
  }();
  static const std::filesystem::path none;
  return made ? folder.path() : none;
}

}  // namespace skerry::world

/// For builds with -DSKERRY_OPENVDB=OFF.
#define SKIP_WITHOUT_OPENVDB() \
  if (skerry::world::sample_files().empty()) GTEST_SKIP() << "this build has no OpenVDB"
