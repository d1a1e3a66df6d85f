// No command but play loads what makes sound: neither its time nor its messages.
#include "tests/cli/run_program.h"

namespace skerry {
namespace {

/// What the dynamic linker says of a run's libraries.
std::string libraries_of(const std::vector<std::string>& arguments) {
  const Outcome outcome = run(arguments, {"LD_DEBUG=files"});
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  return outcome.err;
}

TEST(Silence, OfCommandsThatDrawOrMeasure) {
  const Folder folder;
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"shot", "--seed", "1", "--size", "32x18", "--set",
                                              "world.islands=0", "--out", folder / "shot.png"},
                                             {"bench", "mesh", "--help"},
                                             {"devices"}}) {
    const std::string libraries = libraries_of(arguments);
    EXPECT_NE(libraries.find("libc.so"), std::string::npos) << "the linker says what it loads";
    EXPECT_EQ(libraries.find("libopenal"), std::string::npos) << arguments[0];
    EXPECT_EQ(libraries.find("libasound"), std::string::npos) << arguments[0];
  }
}

}  // namespace
}  // namespace skerry
