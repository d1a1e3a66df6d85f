#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <test_paths.h>
#include "engine/gpu/program/reflection.h"
#include "engine/gpu/program/shader_table.h"
#include "tests/folder.h"

namespace skerry::gpu {

/// A shader of a test's own, compiled as the build compiles those in shaders/: optimised and
/// without names.
class TestShader {
 public:
  /// @param name file name whose ending is the stage, e.g. "add.comp".
  TestShader(std::string name, const std::string& glsl) : name_(std::move(name)) {
    const Folder folder;
    const std::string source = (folder / name_).string(), full = source + ".full.spv",
                      small = source + ".spv";
    std::ofstream(source) << "#version 460\n#extension GL_EXT_scalar_block_layout : require\n"
                             "#extension GL_GOOGLE_include_directive : require\n"
                          << glsl;
    const std::string compile =
        "glslangValidator --target-env vulkan1.2 -g -Od --quiet -I" SKERRY_SOURCE_DIR
        "/shaders -I" SKERRY_SOURCE_DIR "/shaders/shared " +
        source + " -o " + full;
    const std::string optimise = "spirv-opt -O --strip-debug " + full + " -o " + small;
    if (std::system(compile.c_str()) != 0 || std::system(optimise.c_str()) != 0) {
      ADD_FAILURE() << "cannot compile " << name_;
    } else {
      words_ = read(small);
      words_with_names_ = read(full);
      if (const Result<ShaderReflection> declared = reflect(words_with_names_))
        declared_ = *declared;
    }
  }
  const std::vector<std::uint32_t>& words() const { return words_; }
  /// Before optimisation.
  const std::vector<std::uint32_t>& words_with_names() const { return words_with_names_; }
  EmbeddedShader embedded() const {
    const auto* begin = reinterpret_cast<const unsigned char*>(words_.data());
    return {name_.c_str(), begin, begin + words_.size() * sizeof(std::uint32_t), declared_.bindings,
            declared_.push_bytes};
  }

 private:
  static std::vector<std::uint32_t> read(const std::string& path) {
    std::vector<std::uint32_t> words(std::filesystem::file_size(path) / sizeof(std::uint32_t));
    std::ifstream(path, std::ios::binary)
        .read(reinterpret_cast<char*>(words.data()),
              static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
    return words;
  }
  std::string name_;
  std::vector<std::uint32_t> words_, words_with_names_;
  ShaderReflection declared_;
};

}  // namespace skerry::gpu
