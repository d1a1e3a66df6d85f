// A part of the machine's processors for each of several processes.
#pragma once
#include <cstddef>
#include <vector>

struct hwloc_topology;  // of <hwloc.h>

namespace skerry::tools {

/// Splits a machine's processors into equal parts of neighbours: cores stay whole and caches are
/// not shared between parts as long as there are enough of them (hwloc_distrib).
/// @param topology loaded. @return the processors of each part, ascending, as the system numbers
/// them; empty when there are fewer processors than shares. @pre shares > 0.
std::vector<std::vector<unsigned>> cpu_shares(hwloc_topology* topology, std::size_t shares);

/// Keeps this process, and all threads that it starts, on one of `shares` parts of the processors
/// that it may use. Without that, each of several processes starts threads for the whole machine,
/// and they move between caches. Where there are fewer processors than shares, or where the system
/// does not say what they are, nothing changes. @pre share < shares; no thread was started yet.
void stay_on_cpu_share(std::size_t share, std::size_t shares);

}  // namespace skerry::tools
