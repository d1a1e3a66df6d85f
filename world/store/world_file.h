// One file a world: SQLite in WAL mode, chunks compressed by zstd. docs/saving.md.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "world/islands/world.h"
#include "world/store/world_contents.h"
#include "world/voxel/chunk.h"
#include "world/voxel/edits.h"
#include "world/voxel/island.h"

namespace skerry::world {

/// A saved world. One process at a time has it open for writing; any number read.
///
/// What is in the file is not trusted: lengths, indices, block ids, numbers and checksums are
/// looked at before use, and what is damaged is left out and reported while the rest is read. A
/// damaged file is never written: the rest moves into a new one, the damaged one stays beside it.
/// One thread at a time.
class WorldFile {
 public:
  enum class Mode : std::uint8_t { kRead, kWrite };
  /// Of the tables; older ones are brought up to it, newer ones are refused and left as they are,
  /// whatever their tables look like.
  static constexpr int kVersion = kWorldFileVersion;

  /// Makes a file where there is none, complete or not at all, and opens it for writing.
  static Result<std::unique_ptr<WorldFile>> create(const std::filesystem::path& path,
                                                   const WorldInfo& info);
  /// Errors, each one line: missing, no Skerry world, of a newer version, damaged beyond reading,
  /// not writable, open for writing in another process.
  static Result<std::unique_ptr<WorldFile>> open(const std::filesystem::path& path, Mode mode);
  /// Errors: another process has it open for writing. Not for a file that this process has open.
  static Result<void> check_free(const std::filesystem::path& path);
  ~WorldFile();
  WorldFile(const WorldFile&) = delete;
  WorldFile& operator=(const WorldFile&) = delete;

  const std::filesystem::path& path() const;
  const WorldInfo& info() const;
  Mode mode() const;

  /// Changes that come into the file all together or not at all. One at a time; gone without
  /// commit(), it changes nothing. Errors name the file and the reason: full disk, no permission,
  /// a damaged file. The first one is kept and commit() gives it, so that the others may be
  /// ignored.
  class Transaction {
   public:
    Transaction(Transaction&&) noexcept;
    ~Transaction();
    void put_island(const IslandRow& island);
    /// One that has come into being: what an earlier island of its id left in the file is gone.
    void put_new_island(const IslandRow& island);
    /// A chunk of a generated island: what differs from the seed. None: as generated.
    void put_edits(std::uint64_t island, IVec3 chunk, std::span<const VoxelEdit> edits);
    /// A chunk of an added island, whole.
    void put_chunk(std::uint64_t island, IVec3 chunk, const Chunk& voxels);
    /// Anything else, by name: player, time, settings. At most kMaxValueBytes.
    void put_value(std::string_view name, std::span<const std::byte> bytes);
    /// When it returns without an error, the changes outlive the process and the machine's power,
    /// and damage to them can be detected.
    Result<void> commit();

   private:
    friend class WorldFile;
    explicit Transaction(WorldFile& file);
    Result<void> end();
    WorldFile* file_;
    std::optional<Error> error_;
  };
  /// @pre mode() is kWrite and no other transaction is under way.
  Transaction begin();

  static constexpr std::size_t kMaxValueBytes = std::size_t{4} << 20;
  /// None: there is no such value, or it is damaged (damage() then says so).
  std::optional<std::vector<std::byte>> value(std::string_view name);

  struct Contents {
    std::vector<IslandRow> islands;  ///< ascending ids
    struct Edits {
      std::uint64_t island;
      IVec3 chunk;
      ChunkEdits edits;
    };
    struct Whole {
      std::uint64_t island;
      IVec3 chunk;
      Chunk voxels;
    };
    std::vector<Edits> edits;   ///< ascending islands, then chunks
    std::vector<Whole> chunks;  ///< likewise
  };
  /// All islands and chunks that can be read.
  Contents read();
  /// What could not be read so far, one line each.
  const std::vector<std::string>& damage() const;
  void note_damage(std::string line);

 private:
  struct State;
  explicit WorldFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A world as its file has it.
struct LoadedWorld {
  std::unique_ptr<World> world;
  /// Islands that left their course, ascending ids; for IslandMotion. They stand where they stood.
  std::vector<MovingIsland> moving;
};

/// Makes a world of everything a file holds. What does not fit the world (an island that its seed
/// does not make, or that another generator made) is added to the file's damage().
LoadedWorld load_world(WorldFile& file);

}  // namespace skerry::world
