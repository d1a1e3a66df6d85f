#include "engine/platform/tar.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "tests/folder.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

using Files = std::map<std::string, std::string>;

const std::string kUtf8Name = "m\xc3\xb6wn \xe6\x98\x8e";

Files files_below(const fs::path& folder) {
  Files out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      out[entry.path().lexically_relative(folder).generic_string()] =
          *read_text(entry.path(), 1 << 20);
  return out;
}

/// Archives made and taken apart by the system's tar, which is other people's code.
class Tar : public testing::Test {
 protected:
  Tar() {
    const std::string long_part(90, 'x');
    files_ = {{"empty", ""},
              {"a", std::string(511, 'a')},
              {"b", std::string(512, 'b')},
              {"driver/hashes/mine.json", "{}"},
              {kUtf8Name, "."},
              {"driver/" + long_part + "/" + long_part, std::string(2000, '\0')}};
    for (const auto& [name, content] : files_) {
      fs::create_directories((from() / name).parent_path());
      EXPECT_TRUE(write_text(from() / name, content));
    }
    fs::create_directories(to());
  }
  fs::path from() const { return folder_ / "from"; }
  fs::path to() const { return folder_ / "to"; }
  fs::path archive() const { return folder_ / "archive.tar"; }
  bool run(const std::string& command) const {
    return std::system(("cd " + folder_.path().string() + " && " + command).c_str()) == 0;
  }
  void expect_refused(const std::string& why) const {
    const Result<void> done = unpack_tar(archive(), to());
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find(why), std::string::npos) << done.error().message;
    EXPECT_EQ(done.error().message.find('\n'), std::string::npos);
  }

  Folder folder_;
  Files files_;
};

TEST_F(Tar, OfTheSystemIsUnpacked) {
  for (const char* format : {"ustar", "pax", "gnu", "v7"}) {
    const bool old = std::string(format) == "v7";  // has no long names
    ASSERT_TRUE(run(std::string("tar -C from --format=") + format + " -cf archive.tar " +
                    (old ? "a b empty '" + kUtf8Name + "'" : ".")));
    fs::remove_all(to());
    fs::create_directories(to());
    const Result<void> done = unpack_tar(archive(), to());
    ASSERT_TRUE(done) << format << done.error().message;
    Files expected = files_;
    if (old)
      std::erase_if(expected,
                    [](const auto& file) { return file.first.find('/') != std::string::npos; });
    EXPECT_EQ(files_below(to()), expected) << format;
  }
}

TEST_F(Tar, IsUnpackedByTheSystem) {
  ASSERT_TRUE(pack_tar(from(), archive()));
  const std::string bytes = *read_text(archive(), 1 << 20);
  ASSERT_TRUE(run("tar -C to -xf archive.tar"));
  EXPECT_EQ(files_below(to()), files_);
  ASSERT_TRUE(pack_tar(to(), archive()));
  EXPECT_EQ(*read_text(archive(), 1 << 20), bytes) << "times are not in it";
}

TEST_F(Tar, NothingLeadsOutOfTheFolder) {
  ASSERT_TRUE(write_text(folder_ / "secret", "s"));
  ASSERT_TRUE(run("tar -C from -P -cf archive.tar ../secret"));
  expect_refused("leads elsewhere");
  ASSERT_TRUE(run("tar -P -cf archive.tar $PWD/secret"));
  expect_refused("leads elsewhere");
  fs::create_symlink("../secret", from() / "link");
  ASSERT_TRUE(run("tar -C from -cf archive.tar link"));
  expect_refused("link");
  EXPECT_TRUE(files_below(to()).empty());
}

TEST_F(Tar, SparseFilesAndDamagedLongNamesAreRefused) {
  ASSERT_TRUE(run("truncate -s 1M from/hole && printf x >> from/hole"));
  ASSERT_TRUE(run("tar -C from --format=pax --sparse -cf archive.tar hole"));
  expect_refused("sparse");
  ASSERT_TRUE(run("tar -C from --format=gnu --sparse -cf archive.tar hole"));
  expect_refused("sparse");
  ASSERT_TRUE(run("tar -C from --format=pax -cf archive.tar driver"));
  std::string bytes = *read_text(archive(), 1 << 20);
  const std::size_t path = bytes.find(" path=");
  ASSERT_NE(path, std::string::npos);
  bytes[path - 1] = 'z';  // of the record's length, which no sum covers
  ASSERT_TRUE(write_text(archive(), bytes));
  expect_refused("give a tar archive");
  EXPECT_TRUE(files_below(to()).empty());
}

TEST_F(Tar, NamesHeadersAndFilesBeyondReasonAreRefused) {
  const auto python = [&](const std::string& entry) {
    return run(
        "python3 -c \"import tarfile; tar = tarfile.open('archive.tar', 'w', "
        "format=tarfile.PAX_FORMAT); entry = tarfile.TarInfo('a'); " +
        entry + "; tar.addfile(entry); tar.close()\"");
  };
  ASSERT_TRUE(python("entry.name = 'x/' * 2100 + 'x'"));
  expect_refused("too long");
  ASSERT_TRUE(python("entry.pax_headers = {'comment': 'x' * 2000000}"));
  expect_refused("give a tar archive");
  ASSERT_TRUE(
      run("truncate -s 257M from/large && tar -C from -cf - large | head -c 1M > archive.tar"));
  expect_refused("more than 256 MiB");
  ASSERT_TRUE(run("tar -C from -czf archive.tar a"));
  expect_refused("give a tar archive");  // what is compressed may become anything
  EXPECT_TRUE(files_below(to()).empty());
}

TEST_F(Tar, DamageIsSaidAndNamesThatAreTooLongAsWell) {
  ASSERT_TRUE(pack_tar(from(), archive()));
  const std::string whole = *read_text(archive(), 1 << 20);
  for (std::size_t bytes = 0; bytes + 1024 <= whole.size(); bytes += bytes % 512 == 0 ? 97 : 415) {
    ASSERT_TRUE(write_text(archive(), whole.substr(0, bytes)));
    expect_refused("give a tar archive");
  }
  expect_refused("cut short");  // nothing is missing but the end, of which all is zero
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    std::string damaged = whole;
    const std::size_t byte = random() % 504;  // not of the sum, which may be written in other ways
    damaged[byte < 148 ? byte : byte + 8] ^=
        static_cast<char>(1 + random() % 255);  // of the first header
    ASSERT_TRUE(write_text(archive(), damaged));
    expect_refused("give a tar archive");
  }
  fs::remove(archive());
  expect_refused("No such file");
  ASSERT_TRUE(write_text(from() / std::string(150, 'y'), ""));
  EXPECT_FALSE(pack_tar(from(), archive()));
  EXPECT_FALSE(fs::exists(archive()));
}

}  // namespace
}  // namespace skerry::platform
