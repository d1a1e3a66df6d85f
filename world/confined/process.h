// Programs of ours that run a library on files of strangers, as child processes beside the one that
// runs. Whatever a damaged file makes a library do, it does there, within limits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/result.h"

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

/// What reading one file may take at most.
struct ReadLimits {
  /// Address space of the child, beyond what it starts with.
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;
  std::uint64_t answer_bytes = std::uint64_t{1} << 30;
  int cpu_s = 60;
  double wall_s = 120.0;
};

/// Called some times a second with the share of the file that has been read, 0..1.
using ReadProgress = std::function<void(double share)>;

/// A program that child.h confines.
struct ConfinedProgram {
  const char* name;     ///< of the file, beside the running executable
  const char* library;  ///< that it runs, as messages name it
};

/// Where a program should be: beside the running executable.
std::filesystem::path path_of(const ConfinedProgram& program);

/// Runs `program LIMITS arguments...` with these as its standard input and output and waits for it.
/// It is killed after limits.wall_s; the other limits are given to it as arguments, and it sets
/// them for itself before it touches a file.
/// @param arguments the first is its job, `read` or `write`.
/// @param progress called with the share of `input_bytes` that was read.
/// Errors: it cannot be started, crashed, or ran into a limit; one line without the file's name.
Result<void> run_confined(const ConfinedProgram& program, const std::vector<std::string>& arguments,
                          int input, int output, std::uint64_t input_bytes,
                          const ReadLimits& limits, const ReadProgress& progress);

/// Has a program read a regular file. @param limits_for limits for a file of so many bytes.
/// @return what it answered, not yet sealed. Errors: no such file, not a regular one; those of
/// run_confined; without the file's name.
Result<MemoryFile> read_confined(const ConfinedProgram& program, const std::filesystem::path& path,
                                 const std::function<ReadLimits(std::uint64_t bytes)>& limits_for,
                                 const ReadProgress& progress = {});

}  // namespace skerry::world
