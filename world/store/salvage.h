// Rows of a world file whose pages no longer hang together. Private to world/store.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "world/store/database.h"

namespace skerry::world {

/// Looks through every page of a file, and of its log, for rows whose checksums fit what they hold
/// and their keys, however little of the rest can be read, and puts them into a database that has
/// the tables of this version and nothing in them. Source for the layout of pages and logs:
/// https://www.sqlite.org/fileformat2.html.
/// Of two rows that differ the one from the later commit is taken.
/// @param doubts reported: rows of which there are two that differ and are of one age; neither is
/// taken.
/// @return whether that makes a world: what it is called and what seed it has is there. Errors of
/// `into` count as nothing found.
bool salvage(const std::filesystem::path& path, Database& into, std::vector<std::string>& doubts);

}  // namespace skerry::world
