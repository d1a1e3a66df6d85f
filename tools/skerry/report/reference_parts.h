// A reference whose batches of samples are drawn by several processes or machines.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "tools/reference/reference.h"
#include "tools/skerry/report/reference_store.h"

namespace skerry::tools {

/// Batches [first, first + count) of a reference.
struct BatchRange {
  std::uint32_t first = 0, count = 0;
  bool operator==(const BatchRange&) const = default;
};

/// `batches` split into `parts` that differ by one at most; no more parts than batches.
std::vector<BatchRange> split_batches(std::uint32_t batches, std::uint32_t parts);

/// Gets a reference from a store. One that is not there is drawn in parts: this process draws each
/// that no other one is drawing, waits for the rest, and merges all of them. Whoever draws, the
/// picture has the same bits. Parts are files beside the entry, of 24 bytes a pixel and batch, that
/// go when it is written; a part whose process ends early is drawn by the next one that needs it.
/// @param draw some batches. @param merge all of them, in their order, to an entry.
/// Errors: those of `draw`.
Result<KeptReference> get_in_parts(
    const ReferenceStore& store, const std::string& id, std::span<const BatchRange> parts,
    const std::function<Result<reference::ReferenceBatches>(const BatchRange&)>& draw,
    const std::function<KeptReference(std::span<const reference::ReferenceBatches>)>& merge);

}  // namespace skerry::tools
