// The program skerry_without_openvdb: skerry as a build without OpenVDB makes it, at the price of
// one file. Linked before the library that says otherwise.
#include "world/vdb/worker.h"

namespace skerry::world {

bool has_openvdb() {
  return false;
}

}  // namespace skerry::world
