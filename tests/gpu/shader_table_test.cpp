// What shaders declare, what their SPIR-V holds and what passes bind are one set, whatever compiles
// and optimises them.
#include "engine/gpu/program/shader_table.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <test_paths.h>
#include "tests/folder.h"
#include "tests/gpu/compile_glsl.h"

namespace skerry::gpu {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint32_t> words_of(const unsigned char* begin, const unsigned char* end) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(end - begin) / sizeof(std::uint32_t));
  std::copy(begin, end, reinterpret_cast<unsigned char*>(words.data()));
  return words;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::uint32_t> unoptimised(const std::string& shader) {
  const std::string bytes =
      text_of(fs::path(SKERRY_BINARY_DIR) / "shaders" / (shader + ".full.spv"));
  const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
  return words_of(begin, begin + bytes.size());
}

TEST(ShaderTable, HoldsWhatUnoptimisedProgramsDeclareAndUse) {
  ASSERT_FALSE(embedded_shaders().empty());
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const Result<ShaderReflection> declared = reflect(unoptimised(shader.name));
    ASSERT_TRUE(declared) << shader.name << ": " << declared.error().message;
    EXPECT_EQ(declared->unused, std::vector<std::uint32_t>{}) << shader.name;
    EXPECT_TRUE(std::ranges::equal(declared->bindings, shader.bindings)) << shader.name;
    EXPECT_EQ(declared->push_bytes, shader.push_bytes) << shader.name;
  }
}

TEST(ShaderTable, OptimisedProgramsAskForNothingElse) {
  for (const EmbeddedShader& shader : embedded_shaders()) {
    const Result<ShaderReflection> kept = reflect(words_of(shader.begin, shader.end));
    ASSERT_TRUE(kept) << shader.name << ": " << kept.error().message;
    for (const ShaderReflection::Binding& binding : kept->bindings)
      EXPECT_EQ(std::ranges::count(shader.bindings, binding), 1)
          << shader.name << ", binding " << binding.binding;
    EXPECT_LE(kept->push_bytes, shader.push_bytes) << shader.name;
  }
}

/// Runs the build's tool on a shader of the test. @return its exit status; `said` is its stderr.
int tabulate(const TestShader& shader, std::string& said) {
  const Folder folder;
  const std::vector<std::uint32_t>& words = shader.words_with_names();
  std::ofstream(folder / "mine.comp.full.spv", std::ios::binary)
      .write(reinterpret_cast<const char*>(words.data()),
             static_cast<std::streamsize>(words.size() * sizeof(std::uint32_t)));
  const std::string command = SKERRY_BINARY_DIR "/skerry_shader_table " + folder.path().string() +
                              " " + folder.path().string() + " mine.comp 2> " +
                              (folder / "said").string();
  const int status = std::system(command.c_str());
  said = text_of(folder / "said");
  return WEXITSTATUS(status);
}

TEST(ShaderTable, ABindingThatIsDeclaredAndNotUsedEndsTheBuild) {
  std::string said;
  EXPECT_EQ(tabulate(TestShader("mine.comp", R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) buffer A { uint a; };
    layout(binding = 7) buffer B { uint b; };
    void main() { a = 1; })"),
                     said),
            1);
  EXPECT_EQ(said,
            "skerry_shader_table: mine.comp declares the binding 7 and does not use it: "
            "declare it beside its use (shaders/shared/bindings.h)\n");
}

TEST(ShaderTable, ABindingThatIsUsedInADeadBranchIsUsed) {
  std::string said;
  EXPECT_EQ(tabulate(TestShader("mine.comp", R"(
    layout(local_size_x = 1) in;
    layout(constant_id = 0) const bool kSecond = false;
    layout(binding = 0) buffer A { uint a; };
    layout(binding = 7) buffer B { uint b; };
    void main() { if (kSecond) b = 1; a = 1; })"),
                     said),
            0)
      << said;
}

/// Lines of the files under `folder` that match, as "path:line: text".
std::vector<std::string> lines_with(const char* folder, const std::regex& pattern) {
  std::vector<std::string> found;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(fs::path(SKERRY_SOURCE_DIR) / folder)) {
    if (!entry.is_regular_file()) continue;
    std::istringstream text(text_of(entry.path()));
    std::string line;
    for (int number = 1; std::getline(text, line); ++number)
      if (std::regex_search(line, pattern))
        found.push_back(entry.path().string() + ":" + std::to_string(number) + ": " + line);
  }
  return found;
}

TEST(ShaderTable, NobodyWritesABindingAsANumber) {
  const std::regex in_shaders(R"(binding\s*=\s*\d)"), in_code(R"(\.(storage|sampled)\(\s*\d)");
  EXPECT_EQ(lines_with("shaders", in_shaders), std::vector<std::string>{});
  for (const char* folder : {"engine", "game", "tools"})
    EXPECT_EQ(lines_with(folder, in_code), std::vector<std::string>{});
}

TEST(ShaderTable, ANameHasANumberOfItsOwn) {
  const std::string text = text_of(fs::path(SKERRY_SOURCE_DIR) / "shaders/shared/bindings.h");
  const std::regex constant(R"((k\w+Binding) = (\d+)u;)");
  std::vector<int> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), constant), end; at != end; ++at) {
    const int first = std::stoi((*at)[2]);
    // Each of the layers' has four.
    for (int k = 0; k < ((*at)[1].str().starts_with("kLayerSurfaces") ||
                                 (*at)[1].str().starts_with("kLayerDepths")
                             ? 4
                             : 1);
         ++k)
      numbers.push_back(first + k);
  }
  ASSERT_GT(numbers.size(), 60u);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], static_cast<int>(i));
}

}  // namespace
}  // namespace skerry::gpu
