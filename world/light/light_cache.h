#pragma once
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "world/light/lamp_reaches.h"
#include "world/light/sky_transfer.h"

namespace skerry::world {

/// Keeps the light that was found of islands, so that a process which loads the same islands again
/// and again, as one that draws scenes does, finds it once. What it returns is what was found of
/// chunks with the same contents: these are compared, not a hash of them. Any thread may call.
class LightCache {
 public:
  /// What is found beside the reach of lamps.
  enum class Kind : std::uint8_t {
    kSky,     ///< SkyTransfer without albedo
    kBounces  ///< and with it; the same albedo for all
  };
  struct Light {
    LampReaches reaches;       ///< reaches_of() the chunks
    SkyTransfer::Skies skies;  ///< SkyTransfer::make_faces()
  };
  struct Stats {
    std::size_t found = 0, missed = 0;  ///< calls of find()
    std::size_t entries = 0, bytes = 0;
  };

  /// @param most_bytes that all entries take, what they were found from included. Beyond it the
  /// least recently used are evicted; one that alone takes more is not kept.
  explicit LightCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}
  LightCache(const LightCache&) = delete;
  LightCache& operator=(const LightCache&) = delete;

  /// @return null: nothing is known of such chunks.
  /// @param keys see SkyTransfer: other directions are other light.
  std::shared_ptr<const Light> find(const LightChunks& chunks, Kind kind,
                                    const KeyDirections& keys = {});
  /// @param light all of what was found of these chunks.
  void keep(const LightChunks& chunks, Kind kind, const KeyDirections& keys, Light light);
  Stats stats() const;

 private:
  struct Entry {
    std::uint64_t fingerprint = 0;
    Kind kind = Kind::kSky;
    KeyDirections keys{};
    LightChunks chunks;
    std::shared_ptr<const Light> light;
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;
  Entries::iterator place_of(std::uint64_t fingerprint, const LightChunks& chunks, Kind kind,
                             const KeyDirections& keys);
  void evict();

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;  // guards all below
  Entries entries_;           // the most recently used first
  std::unordered_multimap<std::uint64_t, Entries::iterator> by_fingerprint_;
  Stats stats_;
};

}  // namespace skerry::world
