// The OpenVDB process: the program `skerry_openvdb` beside the one that runs. Whatever a damaged
// file makes OpenVDB do, it does there, within limits.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "world/vdb/volume_grid.h"

namespace skerry::world {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  int get() const { return fd_; }

 private:
  int fd_;
};

/// A file of no name in memory. What it holds can be looked at after seal(), when nobody can change
/// it any more.
class MemoryFile {
 public:
  static Result<MemoryFile> create();
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile& operator=(MemoryFile&&) = delete;
  ~MemoryFile();

  int descriptor() const { return file_.get(); }
  bool append(std::span<const std::byte> bytes);
  /// Lets no one write any more, and maps it. Errors: somebody still writes; no memory.
  Result<std::span<const std::byte>> seal();

 private:
  explicit MemoryFile(Descriptor file) : file_(std::move(file)) {}

  Descriptor file_;
  void* mapped_ = nullptr;
  std::size_t size_ = 0;
};

/// Whether this build has an OpenVDB process.
bool has_openvdb();

/// Where the OpenVDB process's program should be: beside the running executable.
std::filesystem::path worker_path();

/// Runs `skerry_openvdb arguments...` with these as its standard input and output and waits for it.
/// It is killed after limits.wall_s; the other limits are given to it as arguments, and it sets
/// them for itself before it touches a file.
/// @param progress called with the share of `input_bytes` that was read.
/// Errors: it cannot be started, crashed, or ran into a limit; one line without the file's name.
Result<void> run_worker(const std::vector<std::string>& arguments, int input, int output,
                        std::uint64_t input_bytes, const ReadLimits& limits,
                        const ReadProgress& progress);

}  // namespace skerry::world
