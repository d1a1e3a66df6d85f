// What world files hold besides chunks, as bytes. Each decoder takes any bytes and gives none for
// what no encoder wrote.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "world/store/world_contents.h"

namespace skerry::world {

/// Puts a checksum of the bytes and of where they belong in front of them.
std::vector<std::byte> sealed(std::string_view table, std::uint64_t key,
                              std::span<const std::byte> bytes);
/// The bytes behind the checksum. None: it does not fit them, or they belong elsewhere.
std::optional<std::span<const std::byte>> unsealed(std::string_view table, std::uint64_t key,
                                                   std::span<const std::byte> blob);

/// Whether there is no world without a value: it is kept twice.
bool is_vital(std::string_view name);
/// Whether its texts are no longer than a file keeps.
bool fits_file(const WorldInfo& info);
/// @pre fits_file(info)
std::vector<std::byte> encode_info(const WorldInfo& info);
std::optional<WorldInfo> decode_info(std::span<const std::byte> bytes);

/// Without the id, the box and the radius: the id is the row's key, the others follow from voxels.
std::vector<std::byte> encode_spec(const IslandSpec& spec);
std::optional<IslandSpec> decode_spec(std::uint64_t id, std::span<const std::byte> bytes);

/// Of a row's spare: the spec, and whether the island was added.
std::vector<std::byte> encode_spare(const IslandRow& row);
std::optional<IslandRow> decode_spare(std::uint64_t id, std::span<const std::byte> bytes);

std::vector<std::byte> encode_motion(const MotionState& motion);
std::optional<MotionState> decode_motion(std::span<const std::byte> bytes);

}  // namespace skerry::world
