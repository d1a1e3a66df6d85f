// Alone, so that the tests can link the program with the other answer.
#include "world/vdb/worker.h"

namespace skerry::world {

bool has_openvdb() {
#ifdef SKERRY_HAS_OPENVDB
  return true;
#else
  return false;
#endif
}

}  // namespace skerry::world
